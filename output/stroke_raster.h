// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "output/visibility.h"

namespace tranos::output {

inline constexpr int kTile_px = 32;

// A square of a picture as samples, `per_pixel` in each direction of a pixel.
struct Tile {
  int left_px = 0, top_px = 0;
  int per_pixel = 1;
  std::vector<Shade> samples;  // row by row

  int side() const { return kTile_px * per_pixel; }
};

// Which lines come near which tile.
class InkIndex {
 public:
  InkIndex(const std::vector<InkLine>& ink, int width_px, int height_px);

  // Draws what reaches the tile over its samples: each line at once, so that it does not darken
  // where it touches itself. Its edge is as soft as a sample is wide.
  void Draw(Tile& tile) const;

 private:
  struct Entry {
    std::uint32_t line, segment;
  };
  void Add(std::uint32_t line, std::uint32_t segment);

  const std::vector<InkLine>& ink_;
  int columns_, rows_;
  std::vector<std::vector<Entry>> by_tile_;
};

}  // namespace tranos::output
