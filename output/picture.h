// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "model/edit.h"
#include "output/result.h"

namespace tranos::output {

// Rows from the top, three bytes a pixel: red, green, blue of sRGB. `alpha` is empty, or a byte a
// pixel: 0 where nothing is.
struct Picture {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> rgb;
  std::vector<std::uint8_t> alpha = {};
};
using Shade = Eigen::Vector3f;  // red, green, blue of the screen, 0 to 1

// The largest side of a picture.
inline constexpr int kMaxSide_px = 16384;

// The model in the view that was asked for: wireframe shows every line, hidden only what is not
// behind a surface, phong shaded surfaces with curves and points over them; 4×4 samples a pixel if
// antialiased. The bytes do not depend on the number of threads.
Result<Picture> Render(const model::RenderRequest& request, int threads);

}  // namespace tranos::output
