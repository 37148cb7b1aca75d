// SPDX-License-Identifier: GPL-3.0-or-later
// Differences of cameras in the benchmark's units, and words in what is told.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

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

// Whether one of the sentences has these words.
inline bool Mentions(const std::vector<std::string>& sentences, const char* words) {
  return std::ranges::any_of(
      sentences, [&](const std::string& s) { return s.find(words) != std::string::npos; });
}

}  // namespace tranos::camera::benchmark
