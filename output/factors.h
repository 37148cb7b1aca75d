// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geom/primitives.h"

namespace tranos::output {

// A linear map as rotations and scales, which is all that a node of a file may hold:
// rotation · scale · before, each of rotation and before a rotation; `before` is the identity where
// there is no shear.
struct Factors {
  Eigen::Matrix3d rotation, before;
  geom::Vec3 scale;
};
Factors FactorsOf(const Eigen::Matrix3d& linear);

}  // namespace tranos::output
