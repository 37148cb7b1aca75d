// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/stroke_raster.h"

#include <algorithm>
#include <cmath>

namespace tranos::output {
namespace {

using Eigen::Vector2f;

float DistanceToSegment(const Vector2f& p, const Vector2f& a, const Vector2f& b) {
  const Vector2f along = b - a;
  const float squared = along.squaredNorm();
  const float t = squared > 0 ? std::clamp((p - a).dot(along) / squared, 0.0f, 1.0f) : 0.0f;
  return (p - a - t * along).norm();
}

// How much of each sample of a tile a line covers.
class Coverage {
 public:
  explicit Coverage(const Tile& tile)
      : tile_(tile), share_(static_cast<std::size_t>(tile.side()) * tile.side()) {
    Clear();
  }

  void Add(const Vector2f& a, const Vector2f& b, float width_px) {
    const float sample_px = 1.0f / static_cast<float>(tile_.per_pixel);
    const float reach = 0.5f * (width_px + sample_px);
    const Vector2f origin(static_cast<float>(tile_.left_px), static_cast<float>(tile_.top_px));
    const Vector2f low = (a.cwiseMin(b).array() - reach).matrix() - origin;
    const Vector2f high = (a.cwiseMax(b).array() + reach).matrix() - origin;
    const int x0 = Index(low.x()), x1 = Index(high.x()), y1 = Index(high.y());
    for (int y = Index(low.y()); y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const Vector2f centre = origin + sample_px * Vector2f(static_cast<float>(x) + 0.5f,
                                                              static_cast<float>(y) + 0.5f);
        const float distance = DistanceToSegment(centre, a, b);
        if (distance >= reach) continue;
        float& share = share_[At(x, y)];
        share = std::max(share, std::min(1.0f, (reach - distance) / sample_px));
      }
    }
    x0_ = std::min(x0_, x0), x1_ = std::max(x1_, x1);
    y0_ = std::min(y0_, Index(low.y())), y1_ = std::max(y1_, y1);
  }

  void BlendInto(Tile& tile, const InkLine& line) {
    for (int y = y0_; y <= y1_; ++y) {
      for (int x = x0_; x <= x1_; ++x) {
        float& share = share_[At(x, y)];
        if (share == 0) continue;
        Shade& sample = tile.samples[At(x, y)];
        sample += share * line.opacity * (line.colour - sample);
        share = 0;
      }
    }
    Clear();
  }

 private:
  std::size_t At(int x, int y) const { return static_cast<std::size_t>(y) * tile_.side() + x; }
  // The sample at a distance from the tile's edge, one of the tile's.
  int Index(float offset_px) const {
    const float index = std::floor(offset_px * static_cast<float>(tile_.per_pixel));
    return static_cast<int>(std::clamp(index, 0.0f, static_cast<float>(tile_.side() - 1)));
  }
  void Clear() { x0_ = y0_ = tile_.side(), x1_ = y1_ = -1; }

  const Tile& tile_;
  std::vector<float> share_;
  int x0_, x1_, y0_, y1_;  // what has been touched
};

}  // namespace

InkIndex::InkIndex(const std::vector<InkLine>& ink, int width_px, int height_px)
    : ink_(ink),
      columns_((width_px + kTile_px - 1) / kTile_px),
      rows_((height_px + kTile_px - 1) / kTile_px),
      by_tile_(static_cast<std::size_t>(columns_) * rows_) {
  for (std::uint32_t line = 0; line < ink.size(); ++line) {
    for (std::uint32_t i = 0; i + 1 < ink[line].vertices.size(); ++i) Add(line, i);
  }
}

void InkIndex::Add(std::uint32_t line, std::uint32_t segment) {
  const InkLine& ink = ink_[line];
  const Vector2f &a = ink.vertices[segment], &b = ink.vertices[segment + 1];
  const float reach = 0.5f * ink.width_px + 1;
  const auto tile_at = [&](float at, int count) {
    return std::clamp(static_cast<int>(std::floor(at / kTile_px)), 0, count - 1);
  };
  const Vector2f low = a.cwiseMin(b).array() - reach, high = a.cwiseMax(b).array() + reach;
  const float half_diagonal = 0.70711f * kTile_px;
  for (int row = tile_at(low.y(), rows_); row <= tile_at(high.y(), rows_); ++row) {
    for (int column = tile_at(low.x(), columns_); column <= tile_at(high.x(), columns_); ++column) {
      const Vector2f centre((static_cast<float>(column) + 0.5f) * kTile_px,
                            (static_cast<float>(row) + 0.5f) * kTile_px);
      if (DistanceToSegment(centre, a, b) > half_diagonal + reach) continue;
      by_tile_[static_cast<std::size_t>(row) * columns_ + column].push_back({line, segment});
    }
  }
}

void InkIndex::Draw(Tile& tile) const {
  const std::size_t index =
      static_cast<std::size_t>(tile.top_px / kTile_px) * columns_ + tile.left_px / kTile_px;
  const std::vector<Entry>& entries = by_tile_[index];
  if (entries.empty()) return;
  Coverage coverage(tile);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const InkLine& line = ink_[entries[i].line];
    const std::uint32_t segment = entries[i].segment;
    coverage.Add(line.vertices[segment], line.vertices[segment + 1], line.width_px);
    const bool last = i + 1 == entries.size() || entries[i + 1].line != entries[i].line;
    if (last) coverage.BlendInto(tile, line);
  }
}

}  // namespace tranos::output
