// SPDX-License-Identifier: GPL-3.0-or-later
// Motions, and the elements that they make or change.
#pragma once

#include "interp/command.h"

namespace tranos::interp {

geom::Affine Translation(const geom::Vec3& offset);
// About the line through `pivot` along the unit `axis`, anticlockwise; quarter turns are exact.
geom::Affine Rotation(const geom::Vec3& pivot, const geom::Vec3& axis, double angle_rad);
// In the plane through `on` with this unit normal.
geom::Affine Reflection(const geom::Vec3& on, const geom::Vec3& normal);
// By a factor along each axis of the frame, its origin staying where it is.
geom::Affine Scaling(const geom::Frame& frame, const geom::Vec3& factors);

// A copy with an id to come and, since a name names one thing, without its name.
model::ElementPtr FreshCopy(const model::Element& element, const geom::Affine& target_from_source);

// The chosen themselves moved, and left chosen.
Fired MoveChosen(const Answers& answers, const geom::Affine& target_from_source);
// Copies of the chosen, left chosen in their place.
Fired CopyChosen(const Answers& answers, const geom::Affine& target_from_source);

}  // namespace tranos::interp
