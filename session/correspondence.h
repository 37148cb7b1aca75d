// SPDX-License-Identifier: GPL-3.0-or-later
// How the shapes of two elements relate.
#pragma once

#include <optional>

#include "model/element.h"

namespace tranos::session {

// The same shape in another place.
struct Displacement {
  double largest_m = 0;            // of corresponding points
  std::optional<geom::Vec3> by_m;  // of all points alike; nothing if it is turned, too
};
std::optional<Displacement> RigidDisplacement(const model::Element& a, const model::Element& b);

// Equal for elements that can be moved onto one another, and seldom otherwise: over type, sizes,
// structure, and of a group the members' settings and names; never place.
model::Hash128 ShapeHash(const model::Element& element);
// How many points the shape's place is told by.
std::size_t ShapePoints(const model::Element& element);
// Over the geometry alone: neither settings nor name.
model::Hash128 GeometryHash(const model::Element& element);

// The largest distance of points that correspond: vertices and poles where both have the same, the
// same parameters otherwise. Nothing where the elements are of different kinds.
std::optional<double> LargestDistance(const model::Element& a, const model::Element& b);

}  // namespace tranos::session
