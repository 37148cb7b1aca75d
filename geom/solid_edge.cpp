// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/solid_edge.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "geom/mesh_edges.h"
#include "geom/skin.h"

namespace tranos::geom {
namespace {

// A surface is flat whose corners lie in a plane but for this part of their coordinates.
constexpr double kFlat = 1e-10;
// The sine of an angle that is none.
constexpr double kStraight = 1e-6;
// By how much a prism reaches beyond what it changes, where nothing else is.
constexpr double kHair_m = 1e-6;

using SurfacePair = std::pair<std::uint32_t, std::uint32_t>;

// A stretch of an edge between two triangles, that of `first` to its left, seen from outside.
struct Stretch {
  std::uint32_t from, to;
  std::uint32_t first, second;  // triangles
};

class EdgeFinder {
 public:
  explicit EdgeFinder(const TriangleMesh& mesh) : mesh_(mesh) {
    FindFlatSurfaces();
    FindStretches();
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      for (const std::uint32_t corner : mesh.triangles[i]) around_[corner].push_back(i);
    }
  }

  std::vector<SolidEdge> Edges() {
    std::vector<SolidEdge> edges;
    for (const auto& [surfaces, stretches] : candidates_) {
      for (const Stretch& run : Runs(stretches)) edges.push_back(EdgeOf(run));
    }
    return edges;
  }

 private:
  const Vec3& At(std::uint32_t corner) const { return mesh_.positions[corner]; }
  Vec3 AreaVector(std::uint32_t triangle) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    return (At(b) - At(a)).cross(At(c) - At(a));
  }
  Vec3 NormalOf(std::uint32_t triangle) const { return AreaVector(triangle).normalized(); }
  std::uint32_t SurfaceOf(std::uint32_t triangle) const { return mesh_.surfaces[triangle]; }
  bool IsFlat(std::uint32_t triangle) const { return flat_.at(SurfaceOf(triangle)); }

  void FindFlatSurfaces() {
    std::map<std::uint32_t, std::uint32_t> largest;
    for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
      const auto [at, is_new] = largest.try_emplace(SurfaceOf(i), i);
      if (!is_new && AreaVector(i).norm() > AreaVector(at->second).norm()) at->second = i;
    }
    for (const auto& [surface, triangle] : largest) flat_[surface] = true;
    for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
      const std::uint32_t triangle = largest[SurfaceOf(i)];
      const Vec3 normal = NormalOf(triangle), &origin = At(mesh_.triangles[triangle][0]);
      for (const std::uint32_t corner : mesh_.triangles[i]) {
        const double reach = 1 + At(corner).cwiseAbs().maxCoeff();
        if (std::abs(normal.dot(At(corner) - origin)) > kFlat * reach) flat_[SurfaceOf(i)] = false;
      }
    }
  }

  void FindStretches() {
    const std::vector<HalfEdge> sides = SortedHalfEdges(mesh_);
    for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
      while (end < sides.size() && sides[end].SameEdge(sides[i])) ++end;
      if (end != i + 2 || sides[i].rises == sides[i + 1].rises) continue;
      const HalfEdge &rising = sides[i].rises ? sides[i] : sides[i + 1],
                     &falling = sides[i].rises ? sides[i + 1] : sides[i];
      AddStretch({rising.low, rising.high, rising.triangle, falling.triangle});
    }
  }

  void AddStretch(const Stretch& stretch) {
    const std::uint32_t first = SurfaceOf(stretch.first), second = SurfaceOf(stretch.second);
    if (first == second) return;
    borders_[first].push_back(stretch);
    borders_[second].push_back(stretch);
    const bool turns = NormalOf(stretch.first).cross(NormalOf(stretch.second)).norm() > kStraight;
    if (!turns || !IsFlat(stretch.first) || !IsFlat(stretch.second)) return;
    candidates_[std::minmax(first, second)].push_back(stretch);
  }

  // Stretches that follow one another, between faces that look the same ways, joined.
  std::vector<Stretch> Runs(std::vector<Stretch> stretches) const {
    const SurfacePair surfaces =
        std::minmax(SurfaceOf(stretches[0].first), SurfaceOf(stretches[0].second));
    std::map<std::uint32_t, Stretch> from;
    std::set<std::uint32_t> ends;
    for (Stretch& s : stretches) {
      if (SurfaceOf(s.first) != surfaces.first) {
        std::swap(s.from, s.to);
        std::swap(s.first, s.second);
      }
      from[s.from] = s;
      ends.insert(s.to);
    }
    std::vector<Stretch> runs;
    for (const Stretch& s : stretches) {
      if (ends.contains(s.from)) continue;
      Stretch run = s;
      const Vec3 along = At(s.to) - At(s.from);
      const auto goes_on = [&](const auto& next) {
        return next != from.end() && (At(next->second.to) - At(next->second.from)).dot(along) > 0;
      };
      for (auto next = from.find(run.to); goes_on(next); next = from.find(run.to)) {
        run.to = next->second.to;
      }
      runs.push_back(run);
    }
    return runs;
  }

  SolidEdge EdgeOf(const Stretch& run) const {
    SolidEdge edge;
    edge.start = At(run.from), edge.end = At(run.to);
    const Vec3 along = (edge.end - edge.start).normalized();
    std::array<std::uint32_t, 2> triangles = {run.first, run.second};
    edge.across = {NormalOf(run.first).cross(along), -NormalOf(run.second).cross(along)};
    edge.is_convex = NormalOf(run.first).dot(edge.across[1]) < 0;
    if (LooksFurtherUp(NormalOf(run.second), NormalOf(run.first))) {
      std::swap(triangles[0], triangles[1]);
      std::swap(edge.across[0], edge.across[1]);
    }
    for (std::size_t k = 0; k < 2; ++k) FindRoom(SurfaceOf(triangles[k]), k, &edge);
    edge.end_normals = {EndNormals(run.from, run), EndNormals(run.to, run)};
    return edge;
  }

  static bool LooksFurtherUp(const Vec3& a, const Vec3& b) {
    for (const Eigen::Index axis : {2, 1, 0}) {
      if (std::abs(a[axis] - b[axis]) > 1e-9) return a[axis] > b[axis];
    }
    return false;
  }

  std::vector<Vec3> EndNormals(std::uint32_t corner, const Stretch& run) const {
    std::vector<Vec3> normals;
    for (const std::uint32_t triangle : around_.at(corner)) {
      const std::uint32_t surface = SurfaceOf(triangle);
      if (surface == SurfaceOf(run.first) || surface == SurfaceOf(run.second)) continue;
      normals.push_back(NormalOf(triangle));
    }
    return normals;
  }

  // The nearest of the face's borders that stand beside the edge.
  void FindRoom(std::uint32_t surface, std::size_t side, SolidEdge* edge) const {
    edge->room_m[side] = edge->shared_room_m[side] = std::numeric_limits<double>::infinity();
    for (const Stretch& border : borders_.at(surface)) {
      const double room_m = RoomBefore(border, *edge, edge->across[side]);
      const bool is_shared =
          candidates_.contains(std::minmax(SurfaceOf(border.first), SurfaceOf(border.second)));
      edge->room_m[side] = std::min(edge->room_m[side], room_m);
      edge->shared_room_m[side] =
          std::min(edge->shared_room_m[side], is_shared ? 0.5 * room_m : room_m);
    }
  }

  double RoomBefore(const Stretch& border, const SolidEdge& edge, const Vec3& across) const {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    const Vec3 along = edge.end - edge.start;
    struct Place {
      double along, across;  // the first in lengths of the edge
    };
    const auto place = [&](std::uint32_t corner) {
      const Vec3 d = At(corner) - edge.start;
      return Place{d.dot(along) / along.squaredNorm(), d.dot(across)};
    };
    Place low = place(border.from), high = place(border.to);
    const double rounding_m = kFlat * (1 + edge.start.cwiseAbs().maxCoeff());
    if (low.along > high.along) std::swap(low, high);
    // A border that begins at the edge itself reaches its own end at the earliest.
    if (std::min(low.across, high.across) < rounding_m) {
      const double reach_m = std::max(low.across, high.across);
      return reach_m > rounding_m ? reach_m : kNone;
    }
    if (high.along < kFlat || low.along > 1 - kFlat) return kNone;
    const auto at = [&](double share) {
      if (high.along - low.along < kFlat) return std::min(low.across, high.across);
      const double part = std::clamp((share - low.along) / (high.along - low.along), 0.0, 1.0);
      return low.across + part * (high.across - low.across);
    };
    return std::min(at(0), at(1));
  }

  const TriangleMesh& mesh_;
  std::map<std::uint32_t, bool> flat_;                          // by surface
  std::map<std::uint32_t, std::vector<Stretch>> borders_;       // of each surface
  std::map<SurfacePair, std::vector<Stretch>> candidates_;      // between flat surfaces
  std::map<std::uint32_t, std::vector<std::uint32_t>> around_;  // triangles at each corner
};

// How far beyond an end of the edge the point `off` it, square to it, is carried. Where the prism
// would change more than it is to, it ends on the faces that meet there, else just beyond them.
double Overshoot(const SolidEdge& edge, std::size_t end, const Vec3& off, double hair_m) {
  const Vec3 outward = (end == 1 ? 1 : -1) * (edge.end - edge.start).normalized();
  double exact_m = std::numeric_limits<double>::infinity(), beyond_m = -exact_m;
  for (const Vec3& normal : edge.end_normals[end]) {
    const double facing = normal.dot(outward);
    if (std::abs(facing) <= kStraight) continue;
    const double to_face_m = -normal.dot(off) / facing;
    if ((facing > 0) == edge.is_convex) {
      beyond_m = std::max(beyond_m, to_face_m);
    } else {
      exact_m = std::min(exact_m, to_face_m);
    }
  }
  if (std::isfinite(exact_m)) return exact_m;
  return std::isfinite(beyond_m) ? beyond_m + hair_m : 0;
}

// The prism along the edge with this profile, whose plane passes through the edge's start.
Result<TriangleMesh> PrismOf(const SolidEdge& edge, const Curve& profile, double hair_m,
                             const Tolerance& tolerance) {
  const Result<Outline> outline = OutlineOf({profile}, tolerance);
  if (!outline) return tl::unexpected(outline.error());
  const Vec3 along = (edge.end - edge.start).normalized();
  Stations stations;
  stations.points.resize(2);
  stations.runs = {0};
  for (const Vec3& point : outline->points) {
    const Vec3 d = point - edge.start, off = d - d.dot(along) * along;
    const Vec3 start = edge.start + off - Overshoot(edge, 0, off, hair_m) * along;
    const Vec3 end = edge.end + off + Overshoot(edge, 1, off, hair_m) * along;
    if (!((end - start).dot(along) > kCoincident_m)) {
      return tl::unexpected(
          Error{ErrorCode::kOutOfRange, "the edge is too short for what meets it at its ends"});
    }
    stations.points[0].push_back(start);
    stations.points[1].push_back(end);
  }
  return SkinOf(*outline, stations);
}

double HairFor(double size_m) { return std::min(kHair_m, 0.01 * size_m); }

// The edge, a hair off both faces.
Vec3 Apex(const SolidEdge& edge, double hair_m) {
  return edge.start - hair_m * (edge.across[0] + edge.across[1]).normalized();
}

double HalfAngle(const SolidEdge& edge) {
  return 0.5 * std::acos(std::clamp(edge.across[0].dot(edge.across[1]), -1.0, 1.0));
}

}  // namespace

std::vector<SolidEdge> SolidEdgesOf(const TriangleMesh& mesh) { return EdgeFinder(mesh).Edges(); }

double Distance(const SolidEdge& edge, const Vec3& p) {
  return NearestPoint(Curve(Line{edge.start, edge.end}), p).distance_m;
}

double LargestRadius(const SolidEdge& edge, bool shared) {
  const std::array<double, 2>& room_m = shared ? edge.shared_room_m : edge.room_m;
  return std::min(room_m[0], room_m[1]) * std::tan(HalfAngle(edge));
}

Result<TriangleMesh> ChamferPrism(const SolidEdge& edge, double first_m, double second_m) {
  const double hair_m = HairFor(std::min(first_m, second_m));
  const Polyline profile{{Apex(edge, hair_m), edge.start + first_m * edge.across[0],
                          edge.start + second_m * edge.across[1]},
                         true};
  return PrismOf(edge, profile, hair_m, {});
}

Result<TriangleMesh> FilletPrism(const SolidEdge& edge, double radius_m,
                                 const Tolerance& tolerance) {
  const double half_rad = HalfAngle(edge), hair_m = HairFor(radius_m);
  const double touch_m = radius_m / std::tan(half_rad);
  const Vec3 centre =
      edge.start + radius_m / std::sin(half_rad) * (edge.across[0] + edge.across[1]).normalized();
  const Vec3 first = edge.start + touch_m * edge.across[0],
             second = edge.start + touch_m * edge.across[1];
  const Vec3 out = (first - centre).normalized(), rest = second - centre;
  const Frame frame{centre, out, (rest - rest.dot(out) * out).normalized()};
  const Vec3 apex = Apex(edge, hair_m);
  const Chain profile{
      {Line{apex, first}, Arc{frame, radius_m, kPi - 2 * half_rad}, Line{second, apex}}, true};
  return PrismOf(edge, profile, hair_m, tolerance);
}

}  // namespace tranos::geom
