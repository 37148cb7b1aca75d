// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "output/material.h"

namespace tranos::output {

// By how much a face of this material is lighter or darker than its colour at a place: courses and
// joints, tiles in rows, grain, veins, weather. `size_m` is what a pixel shows there: what is
// smaller than that has no contrast. In metres of the world.
float TextureTone(Material material, const Eigen::Vector3f& place_m, const Eigen::Vector3f& normal,
                  float size_m);

}  // namespace tranos::output
