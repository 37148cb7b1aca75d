// SPDX-License-Identifier: GPL-3.0-or-later
// `prior default`: what is assumed of a camera of which nothing is known.
#pragma once

#include <array>

#include "camera/traces.h"

namespace tranos::camera {

// Aspect 1 ± 3 %, principal point in the centre ± 5 % of width and height, skew 90° ± 1°; nothing
// of the focal length, and the same for every photograph.
inline std::array<Prior, kIntrinsics> DefaultPriors(const Frame& frame) {
  std::array<Prior, kIntrinsics> priors;
  priors[kAspect] = {1, 0.03};
  priors[kPrincipalX] = {0, 0.05 * frame.size_mm.x()};
  priors[kPrincipalY] = {0, 0.05 * frame.size_mm.y()};
  priors[kSkew] = {kPi / 2, kPi / 180};
  return priors;
}

}  // namespace tranos::camera
