// SPDX-License-Identifier: GPL-3.0-or-later
// Street fronts whose windows are labelled: once a front is seen squarely, they are boxes.
#pragma once

#include "tests/camera/real/detected.h"

namespace tranos::camera::real {

// A photograph of one front, and of each of its windows the dots that are labelled as of it.
struct Front {
  Known photograph;  // its name, file and frame; of its camera nothing is known
  std::vector<std::vector<Eigen::Vector2i>> windows;
};

// Those of the folder facade/. Windows that are cut off by the border, or have less than 100 dots,
// are left out.
std::vector<Front> Fronts(const std::filesystem::path& data);

// From homogeneous dots to the plane of the front, up to a scale of each of its axes: Z, and that
// horizontal one along which more of the lines' length points. A focal length is not needed for it.
Mat3 FrontFromDot(const Known&, const Found&, std::span<const ImageLine>,
                  std::span<const int> axis);

// The share of its bounding box on the front that a window fills.
double BoxFilled(const std::vector<Eigen::Vector2i>& window, const Mat3& front_from_dot);

}  // namespace tranos::camera::real
