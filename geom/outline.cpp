// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/outline.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "geom/faceted_curve.h"
#include "geom/triangulate.h"

namespace tranos::geom {
namespace {

tl::unexpected<Error> At(std::size_t loop, ErrorCode code, std::string detail) {
  return tl::unexpected(Error{code, std::move(detail), static_cast<int>(loop)});
}

struct Loop {
  std::vector<Vec3> points;
  SmoothRuns runs;
};

Result<Loop> LoopOf(const Curve& curve, const Tolerance& tolerance, std::size_t index) {
  if (!IsClosed(curve)) return At(index, ErrorCode::kNotClosed, "the outline is open");
  Result<FacetedCurve> facets = FacetsOf(curve, tolerance);
  if (!facets) return At(index, facets.error().code, facets.error().detail);
  if (facets->corners.size() > kMostOutlinePoints) {
    return At(index, ErrorCode::kTooLarge, "the outline has more than 100 000 corners");
  }
  Loop loop;
  loop.runs = SmoothRunsOf(*facets);
  for (const FacetCorner& corner : facets->corners) loop.points.push_back(corner.point);
  return loop;
}

// Border sides of the triangles: those run along once, the face to their left.
void AddSides(const std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>& surfaces,
              Outline* outline) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> directed;
  for (const auto& t : outline->triangles) {
    for (std::size_t k = 0; k < 3; ++k) directed.emplace(t[k], t[(k + 1) % 3]);
  }
  for (const auto& [from, to] : directed) {
    if (directed.contains({to, from})) continue;
    outline->sides.push_back({from, to, surfaces.at(std::minmax(from, to))});
  }
}

}  // namespace

bool IsRound(const Outline& outline) { return outline.sides.size() > outline.surface_count; }

Result<Outline> OutlineOf(const std::vector<Curve>& loops, const Tolerance& tolerance) {
  Outline outline;
  std::vector<std::vector<Vec2>> flat;
  std::map<std::pair<double, double>, std::uint32_t> first_at;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> surfaces;
  for (std::size_t l = 0; l < loops.size(); ++l) {
    const Result<Loop> loop = LoopOf(loops[l], tolerance, l);
    if (!loop) return tl::unexpected(loop.error());
    const std::optional<Frame> plane = PlaneOf(loops[l]);
    if (!plane) return At(l, ErrorCode::kNotPlanar, "the outline lies in no one plane");
    if (l == 0) outline.plane = *plane;
    std::vector<std::uint32_t> named;  // each point by the first one in its place
    flat.emplace_back();
    for (const Vec3& point : loop->points) {
      const Vec3 local = outline.plane.ToLocal(point);
      if (std::abs(local.z()) > kOffPlane_m) {
        return At(l, ErrorCode::kNotPlanar, "the outlines do not lie in one plane");
      }
      flat.back().emplace_back(local.x() + 0.0, local.y() + 0.0);
      const auto index = static_cast<std::uint32_t>(outline.points.size());
      named.push_back(
          first_at.try_emplace({local.x() + 0.0, local.y() + 0.0}, index).first->second);
      outline.points.push_back(point);
    }
    for (std::size_t i = 0; i < named.size(); ++i) {
      surfaces[std::minmax(named[i], named[(i + 1) % named.size()])] =
          outline.surface_count + loop->runs.of_facet[i];
    }
    outline.surface_count += loop->runs.count;
  }
  auto triangles = TriangulatePolygon(flat);
  if (!triangles) return tl::unexpected(triangles.error());
  outline.triangles = *std::move(triangles);
  AddSides(surfaces, &outline);
  return outline;
}

}  // namespace tranos::geom
