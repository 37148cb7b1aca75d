// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/polygon_operation.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_set_2.h>

#include <algorithm>
#include <iterator>

#include "geom/triangulate.h"

namespace tranos::geom {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Polygon = CGAL::Polygon_2<Kernel>;
using PolygonWithHoles = CGAL::Polygon_with_holes_2<Kernel>;
using PolygonSet = CGAL::Polygon_set_2<Kernel>;

// What the engine takes for granted: sides that neither cross nor lie on one another.
tl::expected<void, Error> CheckSides(const PlaneFigure& figure, std::size_t index) {
  for (const PlanePolygon& polygon : figure) {
    std::vector<std::vector<Vec2>> loops = {polygon.outer};
    loops.insert(loops.end(), polygon.holes.begin(), polygon.holes.end());
    if (auto triangles = TriangulatePolygon(loops); !triangles) {
      triangles.error().part = static_cast<int>(index);
      return tl::unexpected(triangles.error());
    }
  }
  return {};
}

Polygon Exact(const std::vector<Vec2>& loop) {
  Polygon polygon;
  for (const Vec2& p : loop) polygon.push_back({p.x(), p.y()});
  return polygon;
}

std::vector<PolygonWithHoles> Exact(const PlaneFigure& figure) {
  std::vector<PolygonWithHoles> polygons;
  for (const PlanePolygon& polygon : figure) {
    std::vector<Polygon> holes;
    for (const std::vector<Vec2>& hole : polygon.holes) holes.push_back(Exact(hole));
    polygons.emplace_back(Exact(polygon.outer), holes.begin(), holes.end());
  }
  return polygons;
}

PolygonSet UnionOf(const std::vector<PlaneFigure>& figures) {
  std::vector<PolygonWithHoles> all;
  for (const PlaneFigure& figure : figures) {
    for (PolygonWithHoles& polygon : Exact(figure)) all.push_back(std::move(polygon));
  }
  PolygonSet set;
  set.join(all.begin(), all.end());
  return set;
}

PolygonSet IntersectionOf(const std::vector<PlaneFigure>& figures) {
  PolygonSet set = UnionOf({figures[0]});
  for (std::size_t i = 1; i < figures.size(); ++i) set.intersection(UnionOf({figures[i]}));
  return set;
}

std::vector<PolygonWithHoles> Combined(const std::vector<PlaneFigure>& of,
                                       const std::vector<PlaneFigure>& by, SetOperation operation) {
  PolygonSet set = operation == SetOperation::kIntersection ? IntersectionOf(of) : UnionOf(of);
  if (operation == SetOperation::kDifference) set.difference(UnionOf(by));
  std::vector<PolygonWithHoles> polygons;
  set.polygons_with_holes(std::back_inserter(polygons));
  return polygons;
}

bool IsBefore(const Vec2& a, const Vec2& b) {
  return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
}

// Empty if rounding leaves fewer than three corners.
std::vector<Vec2> Rounded(const Polygon& polygon) {
  std::vector<Vec2> loop;
  const std::size_t count = polygon.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto &before = polygon[(i + count - 1) % count], &at = polygon[i],
               &next = polygon[(i + 1) % count];
    if (CGAL::collinear(before, at, next)) continue;
    const Vec2 corner(CGAL::to_double(at.x().exact()), CGAL::to_double(at.y().exact()));
    if (loop.empty() || loop.back() != corner) loop.push_back(corner);
  }
  while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
  if (loop.size() < 3) return {};
  std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end(), IsBefore), loop.end());
  return loop;
}

PlanePolygon Rounded(const PolygonWithHoles& exact) {
  PlanePolygon polygon{Rounded(exact.outer_boundary()), {}};
  for (auto hole = exact.holes_begin(); hole != exact.holes_end(); ++hole) {
    if (std::vector<Vec2> loop = Rounded(*hole); !loop.empty()) {
      polygon.holes.push_back(std::move(loop));
    }
  }
  std::sort(polygon.holes.begin(), polygon.holes.end(),
            [](const auto& p, const auto& q) { return IsBefore(p[0], q[0]); });
  return polygon;
}

}  // namespace

Result<PlaneFigure> CombineFigures(const std::vector<PlaneFigure>& of,
                                   const std::vector<PlaneFigure>& by, SetOperation operation) {
  std::size_t index = 0;
  for (const auto* figures : {&of, &by}) {
    for (const PlaneFigure& figure : *figures) {
      if (auto checked = CheckSides(figure, index++); !checked) {
        return tl::unexpected(checked.error());
      }
    }
  }
  PlaneFigure result;
  if (of.empty()) return result;
  try {
    for (const PolygonWithHoles& polygon : Combined(of, by, operation)) {
      PlanePolygon rounded = Rounded(polygon);
      if (!rounded.outer.empty()) result.push_back(std::move(rounded));
    }
  } catch (const CGAL::Failure_exception&) {
    // The engine's own checks, in builds that have them: loops that touch themselves are none.
    return tl::unexpected(Error{ErrorCode::kDegenerate, "an outline touches itself"});
  }
  std::sort(result.begin(), result.end(), [](const PlanePolygon& p, const PlanePolygon& q) {
    return IsBefore(p.outer[0], q.outer[0]);
  });
  return result;
}

}  // namespace tranos::geom
