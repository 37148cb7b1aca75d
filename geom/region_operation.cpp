// SPDX-License-Identifier: GPL-3.0-or-later
// Regions as polygons in the first one's plane, welded where rounding in the way there has moved
// apart what was drawn as one.
#include <algorithm>
#include <cmath>

#include "geom/region.h"

namespace tranos::geom {
namespace {

using Loop = std::vector<Vec2>;

// A point that stands for all points within kCoincident_m of it.
class Welder {
 public:
  Vec2 Welded(const Vec2& p) {
    const auto near = std::lower_bound(points_.begin(), points_.end(), p.x() - kCoincident_m,
                                       [](const Vec2& known, double x) { return known.x() < x; });
    for (auto known = near; known != points_.end() && known->x() <= p.x() + kCoincident_m;
         ++known) {
      if ((*known - p).norm() <= kCoincident_m) return *known;
    }
    points_.insert(std::upper_bound(near, points_.end(), p,
                                    [](const Vec2& a, const Vec2& b) { return a.x() < b.x(); }),
                   p);
    return p;
  }
  const std::vector<Vec2>& points() const { return points_; }  // by x

 private:
  std::vector<Vec2> points_;
};

Loop Welded(const Loop& loop, Welder* welder) {
  Loop welded;
  for (const Vec2& p : loop) {
    const Vec2 q = welder->Welded(p);
    if (welded.empty() || welded.back() != q) welded.push_back(q);
  }
  while (welded.size() > 1 && welded.front() == welded.back()) welded.pop_back();
  return welded;
}

// The corners of any loop that lie on the side within kCoincident_m, from its start to its end.
std::vector<Vec2> CornersOn(const Vec2& start, const Vec2& end, const std::vector<Vec2>& by_x) {
  std::vector<std::pair<double, Vec2>> found;
  const Vec2 along = end - start;
  const double length = along.norm();
  const double low = std::min(start.x(), end.x()) - kCoincident_m;
  const double high = std::max(start.x(), end.x()) + kCoincident_m;
  auto p = std::lower_bound(by_x.begin(), by_x.end(), low,
                            [](const Vec2& known, double x) { return known.x() < x; });
  for (; p != by_x.end() && p->x() <= high; ++p) {
    const Vec2 off = *p - start;
    const double at = off.dot(along) / length;
    const double aside = (off.x() * along.y() - off.y() * along.x()) / length;
    if (at > kCoincident_m && at < length - kCoincident_m && std::abs(aside) <= kCoincident_m) {
      found.emplace_back(at, *p);
    }
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Vec2> corners;
  for (const auto& [at, corner] : found) corners.push_back(corner);
  return corners;
}

Loop Broken(const Loop& loop, const std::vector<Vec2>& by_x) {
  Loop broken;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    broken.push_back(loop[i]);
    const std::vector<Vec2> corners = CornersOn(loop[i], loop[(i + 1) % loop.size()], by_x);
    broken.insert(broken.end(), corners.begin(), corners.end());
  }
  return broken;
}

template <class F>
void ForEachLoop(std::vector<PlaneFigure>& figures, const F& f) {
  for (PlaneFigure& figure : figures) {
    for (PlanePolygon& polygon : figure) {
      f(polygon.outer);
      for (Loop& hole : polygon.holes) f(hole);
    }
  }
}

Result<PlaneFigure> FigureOf(const Region& region, const Frame& plane, const Tolerance& tolerance) {
  const Result<RegionFacets> facets = Triangulate(region, tolerance);
  if (!facets) return tl::unexpected(facets.error());
  // Seen from the other side, loops run the other way.
  const bool turned = region.plane.z().dot(plane.z()) < 0;
  PlaneFigure polygons;
  for (const RegionFacets::Loop& loop : facets->loops) {
    Loop points;
    for (std::uint32_t i = loop.begin; i < loop.end; ++i) {
      points.push_back(plane.ToLocal(facets->positions[i]).head<2>());
    }
    if (turned) std::reverse(points.begin(), points.end());
    if (loop.is_hole) {
      polygons.back().holes.push_back(std::move(points));
    } else {
      polygons.push_back({std::move(points), {}});
    }
  }
  return polygons;
}

bool LiesIn(const Region& region, const Frame& plane) {
  const Box box = BoundingBox(region);
  const double size = std::max(1.0, (box.max - box.min).norm() + (box.min - plane.origin).norm());
  if (region.plane.z().cross(plane.z()).norm() > 1e-9) return false;
  return std::abs(plane.ToLocal(region.plane.origin).z()) <= 1e-9 * size;
}

Curve OutlineOf(const Loop& loop, const Frame& plane) {
  Polyline outline{{}, true};
  for (const Vec2& p : loop) outline.vertices.push_back(plane.ToWorld({p.x(), p.y(), 0}));
  return outline;
}

}  // namespace

Result<Region> Combine(const std::vector<Region>& of, const std::vector<Region>& by,
                       SetOperation operation, const Tolerance& tolerance) {
  if (of.empty()) return Region{};
  const Frame& plane = of[0].plane;
  std::vector<PlaneFigure> figures;
  for (const auto* regions : {&of, &by}) {
    for (const Region& region : *regions) {
      const int index = static_cast<int>(figures.size());
      if (!LiesIn(region, plane)) {
        return tl::unexpected(
            Error{ErrorCode::kNotPlanar, "the regions do not lie in one plane", index});
      }
      auto figure = FigureOf(region, plane, tolerance);
      if (!figure) return tl::unexpected(figure.error());
      figures.push_back(*std::move(figure));
    }
  }
  Welder welder;
  ForEachLoop(figures, [&](Loop& loop) { loop = Welded(loop, &welder); });
  ForEachLoop(figures, [&](Loop& loop) { loop = Broken(loop, welder.points()); });
  const auto first_by = figures.begin() + static_cast<std::ptrdiff_t>(of.size());
  const auto combined =
      CombineFigures({figures.begin(), first_by}, {first_by, figures.end()}, operation);
  if (!combined) return tl::unexpected(combined.error());
  Region region{plane, {}};
  for (const PlanePolygon& polygon : *combined) {
    Region::Part& part =
        region.parts.emplace_back(Region::Part{OutlineOf(polygon.outer, plane), {}});
    for (const Loop& hole : polygon.holes) part.holes.push_back(OutlineOf(hole, plane));
  }
  return region;
}

}  // namespace tranos::geom
