// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/visibility.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "output/parallel.h"

namespace tranos::output {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

// A line that lies on a surface may be behind its facets by a little; so much, in pixels as they
// are at that depth, does not hide it.
constexpr float kClearance_px = 1;
constexpr float kStep_px = 1;
constexpr int kHalvings = 5;  // of a step, where a line disappears

struct Interval {
  float from, to;  // arc length along the projected stroke, in pixels
};

// A stroke with the arc length of its projection up to each vertex.
class MeasuredStroke {
 public:
  MeasuredStroke(const Stroke& stroke, const Scene& scene)
      : stroke_(stroke), scene_(scene), at_vertex_{0} {
    for (std::size_t i = 1; i < stroke.vertices.size(); ++i) {
      const Vector3f step = stroke.vertices[i] - stroke.vertices[i - 1];
      at_vertex_.push_back(at_vertex_.back() + step.head<2>().norm());
    }
  }
  float length() const { return at_vertex_.back(); }
  std::size_t segment_count() const { return at_vertex_.size() - 1; }
  Interval Segment(std::size_t i) const { return {at_vertex_[i], at_vertex_[i + 1]}; }

  // Seen from the front at this arc length on segment i; the nearer end where the segment is seen
  // end-on.
  bool Visible(const RayScene& rays, std::size_t i, float at) const {
    const Vector3f &a = stroke_.vertices[i], &b = stroke_.vertices[i + 1];
    const Interval segment = Segment(i);
    const float extent = segment.to - segment.from;
    Vector3f p = a.z() > b.z() ? a : b;
    if (extent > 1e-4f) p = a + (b - a) * ((at - segment.from) / extent);
    if (!stroke_.outward.empty()) p.head<2>() += stroke_.outward[i];
    p.z() += kClearance_px * scene_.PixelOfDepth(p.z());
    return !rays.Occluded(p, Vector3f::UnitZ());
  }

  // Where the stroke turns from visible to hidden or back, between two places of segment i that
  // differ.
  float Boundary(const RayScene& rays, std::size_t i, Interval between,
                 bool visible_at_from) const {
    for (int k = 0; k < kHalvings; ++k) {
      const float middle = 0.5f * (between.from + between.to);
      (Visible(rays, i, middle) == visible_at_from ? between.from : between.to) = middle;
    }
    return 0.5f * (between.from + between.to);
  }

  // The piece between two arc lengths, in pixels from the upper left corner.
  std::vector<Vector2f> Piece(const Interval& piece) const {
    const Camera& camera = scene_.camera;
    const auto on_paper = [&](const Vector3f& p) {
      return Vector2f(p.x() + 0.5f * static_cast<float>(camera.width_px),
                      0.5f * static_cast<float>(camera.height_px) - p.y());
    };
    std::vector<Vector2f> vertices;
    for (std::size_t i = 0; i < segment_count(); ++i) {
      const Interval segment = Segment(i);
      if (segment.to < piece.from || segment.from > piece.to) continue;
      const Vector3f &a = stroke_.vertices[i], &b = stroke_.vertices[i + 1];
      const float extent = std::max(segment.to - segment.from, 1e-12f);
      const float begin = (std::max(piece.from, segment.from) - segment.from) / extent;
      const float end = (std::min(piece.to, segment.to) - segment.from) / extent;
      if (vertices.empty()) vertices.push_back(on_paper(a + (b - a) * begin));
      vertices.push_back(on_paper(a + (b - a) * end));
    }
    return vertices;
  }

 private:
  const Stroke& stroke_;
  const Scene& scene_;
  std::vector<float> at_vertex_;
};

std::vector<Interval> VisibleIntervals(const MeasuredStroke& stroke, const RayScene* rays) {
  if (!rays) return {{0, stroke.length()}};
  std::vector<Interval> intervals;
  bool visible = false;
  float open_from = 0;
  const auto turn = [&](float at) {
    visible = !visible;
    if (visible) {
      open_from = at;
    } else {
      intervals.push_back({open_from, at});
    }
  };
  for (std::size_t i = 0; i < stroke.segment_count(); ++i) {
    const Interval segment = stroke.Segment(i);
    const float extent = segment.to - segment.from;
    const int steps = std::max(1, static_cast<int>(std::ceil(extent / kStep_px)));
    float before = segment.from;
    for (int k = 0; k < steps; ++k) {
      const float at =
          segment.from + extent * (static_cast<float>(k) + 0.5f) / static_cast<float>(steps);
      if (stroke.Visible(*rays, i, at) != visible) {
        turn(k == 0 ? segment.from : stroke.Boundary(*rays, i, {before, at}, visible));
      }
      before = at;
    }
  }
  if (visible) turn(stroke.length());
  return intervals;
}

// The dashes within an interval; the pattern starts at the stroke's own start, hidden or not.
std::vector<Interval> Dashes(const Interval& whole, std::vector<float> pattern, float scale) {
  if (pattern.empty()) return {whole};
  float period = 0;
  for (float& length : pattern) period += (length *= scale);
  std::vector<Interval> dashes;
  float at = period * std::floor(whole.from / period);
  for (std::size_t i = 0; at < whole.to; ++i) {
    const float end = at + pattern[i % pattern.size()];
    const Interval dash = {std::max(at, whole.from), std::min(end, whole.to)};
    if (i % 2 == 0 && dash.from < dash.to) dashes.push_back(dash);
    at = end;
  }
  return dashes;
}

std::vector<InkLine> InkOfStroke(const Stroke& stroke, const Scene& scene, const RayScene* rays) {
  const MeasuredStroke measured(stroke, scene);
  std::vector<InkLine> ink;
  for (const Interval& interval : VisibleIntervals(measured, rays)) {
    for (const Interval& dash : Dashes(interval, DashesOf(stroke.linestyle), stroke.width_px)) {
      InkLine line{measured.Piece(dash), stroke.colour, stroke.opacity, stroke.width_px};
      if (line.vertices.size() >= 2) ink.push_back(std::move(line));
    }
  }
  return ink;
}

}  // namespace

std::vector<float> DashesOf(int linestyle) {
  switch (linestyle) {
    case 1:
      return {1, 4};  // dotted
    case 2:
      return {8, 5};  // medium dashes
    case 3:
      return {16, 6};  // long dashes
    case 4:
      return {12, 4, 1, 4};  // dash, dot
    case 5:
      return {4, 3};  // short dashes
    case 6:
      return {12, 4, 1, 4, 1, 4};  // dash, dot, dot
    case 7:
      return {16, 4, 6, 4};  // long dash, short dash
    default:
      return {};
  }
}

std::vector<InkLine> InkOf(const Scene& scene, const RayScene* rays, int threads) {
  std::vector<std::vector<InkLine>> by_stroke(scene.strokes.size());
  ParallelFor(scene.strokes.size(), threads,
              [&](std::size_t i) { by_stroke[i] = InkOfStroke(scene.strokes[i], scene, rays); });
  std::vector<InkLine> ink;
  for (auto& lines : by_stroke) {
    std::move(lines.begin(), lines.end(), std::back_inserter(ink));
  }
  return ink;
}

}  // namespace tranos::output
