// SPDX-License-Identifier: GPL-3.0-or-later
// Text as strokes, as a drawing office letters it.
#pragma once

#include <string_view>
#include <vector>

#include "geom/primitives.h"

namespace tranos::geom {

// Text in the plane of `frame`, its base line's start at the origin, capital letters height_m high.
struct Text {
  std::string content;
  Frame frame;
  double height_m = 1;
};

// The strokes of a text in the world; characters without a glyph are drawn as a box.
std::vector<std::vector<Vec3>> Strokes(const Text&);
// Around the strokes; for a text without strokes, its origin alone.
Box BoundingBox(const Text&);
// Under a similarity the text is carried along; its height scales with the length of frame.y.
Text Transformed(const Text&, const Affine& target_from_source);

}  // namespace tranos::geom
