// SPDX-License-Identifier: GPL-3.0-or-later
// The method `sweep`: four linear constraints and each skew angle of a range, solved jointly.
#pragma once

#include "camera/conic_rows.h"
#include "camera/estimate.h"

namespace tranos::camera {

struct SkewRange {
  double from_rad = 88 * kPi / 180;
  double step_rad = 0.01 * kPi / 180;
  int count = 401;
  double at(int index) const { return from_rad + index * step_rad; }
};

struct SweepResult {
  Camera camera;
  double penalty;  // Σ of squared whitened residuals of edges and points
  bool at_end;     // the least penalty is at an end of the range
  // χ² over α, a profile over the family that the constraints leave: infinite where no real camera
  // with the traces before it fulfils them.
  std::vector<ProfilePoint> curve;
};

// All eleven parameters. The conic fulfils the three orthogonality constraints of the vanishing
// points and one known ratio (in this order what is independent), and the skew's, s = f_x cot α,
// which is quadratic; the rotation follows from the vanishing points, the position linearly from
// edges and points in space; their penalty chooses α, refined between the steps. The true α is a
// root, unlike in the paper's procedure (the paper's Section 3.2.4 and Fig. 4). Errors kDegenerate:
// constraints of a rank below 4, no edges or points that give the position, or no real camera for
// any angle; kOutOfRange: an empty range or angles outside (0°, 180°).
geom::Result<SweepResult> CalibrateSweep(const Photograph& photograph, const Numbers& numbers,
                                         const SkewRange& range = {});

}  // namespace tranos::camera
