// SPDX-License-Identifier: GPL-3.0-or-later
// Differences of cameras in the benchmark's units.
#pragma once

#include "camera/camera.h"

namespace tranos::camera::benchmark {

// mm, degrees, metres.
inline ParameterVector Difference(const Camera& camera, const Camera& truth) {
  ParameterVector difference = camera.parameters - truth.parameters;
  difference.segment<4>(kSkew) *= 180 / kPi;
  return difference;
}

inline double LargestDifference(const Camera& camera, const Camera& truth) {
  return Difference(camera, truth).cwiseAbs().maxCoeff();
}

}  // namespace tranos::camera::benchmark
