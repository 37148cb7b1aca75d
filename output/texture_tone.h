// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "geom/primitives.h"
#include "output/material.h"

namespace tranos::output {

// Where patterns of a world begin that lies about a place: the same for all that is near to it, so
// that a model's patterns do not move as it grows, and so near that single precision tells
// millimetres apart, be the coordinates those of a country's survey.
geom::Vec3 PatternOrigin(const geom::Vec3& middle_m);

// By how much a face of this material is lighter or darker than its colour at a place: courses and
// joints, tiles in rows, grain, veins, weather. `size_m` is what a pixel shows there: what is
// smaller than that has no contrast. In metres from the patterns' origin.
float TextureTone(Material material, const Eigen::Vector3f& place_m, const Eigen::Vector3f& normal,
                  float size_m);

}  // namespace tranos::output
