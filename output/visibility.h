// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "output/scene.h"

namespace tranos::output {

// A line as it is put on paper: in pixels from the picture's upper left corner, y downward.
struct InkLine {
  std::vector<Eigen::Vector2f> vertices;
  Shade colour = Shade::Zero();
  float opacity = 1;
  float width_px = 1;
};

// The strokes' visible pieces (all of them, with `rays` null), cut into dashes by their line style,
// in the strokes' order.
std::vector<InkLine> InkOf(const Scene& scene, const RayScene* rays, int threads);

// The lengths of dash, gap, dash, gap … of line styles 1–7, in pixels for lines one pixel wide;
// thicker ones are longer in proportion. Empty for style 0 and all others, which are solid.
std::vector<float> DashesOf(int linestyle);

}  // namespace tranos::output
