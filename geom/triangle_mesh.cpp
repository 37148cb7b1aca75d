// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "geom/arrangement.h"
#include "geom/mesh_edges.h"
#include "geom/solid_rounding.h"
#include "geom/union_find.h"

namespace tranos::geom {
namespace {

Vec3 DoubledNormal(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Vec3& p = mesh.positions[a];
  return (mesh.positions[b] - p).cross(mesh.positions[c] - p);
}

// Sums over the tetrahedra between the triangles and a point amid them, where products of
// coordinates lose least.
struct Moments {
  double sixfold_volume = 0;
  Vec3 weighted = Vec3::Zero();  // centroid from `origin`, times 24 times the volume
  Vec3 origin;
};
Moments MomentsOf(const TriangleMesh& mesh) {
  Moments sum;
  sum.origin = BoundingBox(mesh).centre();
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 a = mesh.positions[i] - sum.origin, b = mesh.positions[j] - sum.origin,
               c = mesh.positions[k] - sum.origin;
    const double sixfold = a.dot(b.cross(c));
    sum.sixfold_volume += sixfold;
    sum.weighted += sixfold * (a + b + c);
  }
  return sum;
}

// The point of the triangle abc that is nearest to p: Ericson, Real-Time Collision Detection
// (2005), 5.1.5, by the Voronoi regions of corners, edges and the face.
Vec3 NearestInTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const double d1 = ab.dot(p - a), d2 = ac.dot(p - a);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = ab.dot(p - b), d4 = ac.dot(p - b);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const double d5 = ab.dot(p - c), d6 = ac.dot(p - c);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  }
  const double whole = va + vb + vc;
  return a + vb / whole * ab + vc / whole * ac;
}

double DistanceToBox(const Vec3& p, const Box& box) {
  return (p - p.cwiseMax(box.min).cwiseMin(box.max)).norm();
}

}  // namespace

bool IsClosed(std::span<const std::array<std::uint32_t, 3>> triangles) {
  bool is_closed = true;
  ForEachEdge(SortedHalfEdges(triangles), [&](std::span<const HalfEdge> sides) {
    int balance = 0;
    for (const HalfEdge& side : sides) balance += side.rises ? 1 : -1;
    is_closed &= balance == 0;
  });
  return is_closed;
}

TriangleMesh Transformed(TriangleMesh mesh, const Affine& target_from_source) {
  for (Vec3& p : mesh.positions) p = target_from_source * p;
  if (target_from_source.linear().determinant() < 0) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  return mesh;
}

double Volume(const TriangleMesh& mesh) { return MomentsOf(mesh).sixfold_volume / 6; }

double Area(const TriangleMesh& mesh) {
  double doubled = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) doubled += DoubledNormal(mesh, i).norm();
  return doubled / 2;
}

Vec3 Centroid(const TriangleMesh& mesh) {
  const Moments sum = MomentsOf(mesh);
  if (sum.sixfold_volume == 0) return sum.origin;
  return sum.origin + sum.weighted / (4 * sum.sixfold_volume);
}

Box BoundingBox(const TriangleMesh& mesh) {
  Box box;
  for (const Vec3& p : mesh.positions) box.Add(p);
  return box;
}

int Genus(const TriangleMesh& mesh) {
  // A position where parts touch is a corner of each: there are as many as fans of triangles.
  UnionFind fans(3 * mesh.triangles.size());
  const auto corner_at = [&](std::uint32_t triangle, std::uint32_t position) {
    const auto& t = mesh.triangles[triangle];
    return 3 * triangle +
           static_cast<std::uint32_t>(std::find(t.begin(), t.end(), position) - t.begin());
  };
  ForEachEdge(SortedHalfEdges(mesh), [&](std::span<const HalfEdge> sides) {
    for (const HalfEdge& side : sides) {
      for (const std::uint32_t end : {side.low, side.high}) {
        fans.Unite(corner_at(sides[0].triangle, end), corner_at(side.triangle, end));
      }
    }
  });
  std::ptrdiff_t vertices = 0;
  for (std::uint32_t i = 0; i < 3 * mesh.triangles.size(); ++i) vertices += fans.Root(i) == i;
  const auto triangles = static_cast<std::ptrdiff_t>(mesh.triangles.size());
  // Of a closed mesh there are three edges to two triangles.
  const std::ptrdiff_t characteristic = vertices - 3 * triangles / 2 + triangles;
  return ShellCount(mesh) - static_cast<int>(characteristic / 2);
}

int ShellCount(const TriangleMesh& mesh) {
  UnionFind shells(mesh.triangles.size());
  ForEachEdge(SortedHalfEdges(mesh), [&](std::span<const HalfEdge> sides) {
    for (const HalfEdge& side : sides) shells.Unite(sides[0].triangle, side.triangle);
  });
  int count = 0;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) count += shells.Root(i) == i;
  return count;
}

bool HasSelfIntersection(const TriangleMesh& mesh) {
  Soup soup;
  PositionIndex index;
  std::vector<std::uint32_t> corner_of;
  for (const Vec3& p : mesh.positions) corner_of.push_back(index.Of(p, &soup.positions));
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<std::uint32_t, 3> corners = {corner_of[a], corner_of[b], corner_of[c]};
    if (!HasTwice(corners)) soup.facets.push_back({corners, 0});
  }
  return HasCrossing(soup);
}

Nearest NearestPoint(const TriangleMesh& mesh, const Vec3& p) {
  Nearest best;
  best.distance_m = std::numeric_limits<double>::infinity();
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 &a = mesh.positions[i], &b = mesh.positions[j], &c = mesh.positions[k];
    Box box;
    for (const Vec3* corner : {&a, &b, &c}) box.Add(*corner);
    if (DistanceToBox(p, box) >= best.distance_m) continue;
    const Vec3 point = NearestInTriangle(p, a, b, c);
    const double distance_m = (point - p).norm();
    if (distance_m < best.distance_m) best = {point, distance_m, 0};
  }
  return best;
}

namespace {

// Facets of one surface that meet at a larger angle than this are no facets of a round: those of a
// twelfth of a turn still are.
const double kCosCrease = std::cos(40 * kPi / 180);

// A corner of a triangle, where it is to be seen which normal it has.
struct Corner {
  std::uint32_t position, surface, triangle, index;
  bool operator<(const Corner& other) const {
    return std::tie(position, surface, triangle) <
           std::tie(other.position, other.surface, other.triangle);
  }
  bool MaySmooth(const Corner& other) const {
    return position == other.position && surface == other.surface;
  }
};

std::vector<Corner> SortedCorners(const TriangleMesh& mesh) {
  std::vector<Corner> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      corners.push_back({mesh.triangles[t][k], mesh.surfaces[t], t, k});
    }
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

double AngleAt(const TriangleMesh& mesh, const Corner& corner) {
  const auto& triangle = mesh.triangles[corner.triangle];
  const Vec3& p = mesh.positions[corner.position];
  const Vec3 u = mesh.positions[triangle[(corner.index + 1) % 3]] - p,
             v = mesh.positions[triangle[(corner.index + 2) % 3]] - p;
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

class FacetMaker {
 public:
  explicit FacetMaker(const TriangleMesh& mesh) : mesh_(mesh) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      unit_normals_.push_back(DoubledNormal(mesh, i).normalized());
    }
    facets_.triangles.resize(mesh.triangles.size());
  }

  Mesh Make() {
    const std::vector<Corner> corners = SortedCorners(mesh_);
    for (std::size_t begin = 0; begin < corners.size();) {
      std::size_t end = begin + 1;
      while (end < corners.size() && corners[end].MaySmooth(corners[begin])) ++end;
      AddVertices(corners.data() + begin, corners.data() + end);
      begin = end;
    }
    AddEdges();
    return std::move(facets_);
  }

 private:
  // Corners at one position on one surface. Each has the mean normal of the facets that are smooth
  // with its own, so that round a cone's tip they differ; those with the same share a vertex.
  void AddVertices(const Corner* begin, const Corner* end) {
    const std::size_t first_vertex = facets_.positions.size();
    for (const Corner* corner = begin; corner != end; ++corner) {
      Vec3 sum = Vec3::Zero();
      for (const Corner* other = begin; other != end; ++other) {
        if (!AreSmooth(corner->triangle, other->triangle)) continue;
        sum += AngleAt(mesh_, *other) * unit_normals_[other->triangle];
      }
      const double length = sum.norm();
      const Vec3 normal = length > 0 ? Vec3(sum / length) : Vec3::UnitZ();
      std::size_t vertex = first_vertex;
      while (vertex < facets_.positions.size() && facets_.normals[vertex] != normal) ++vertex;
      if (vertex == facets_.positions.size()) {
        facets_.positions.push_back(mesh_.positions[corner->position]);
        facets_.normals.push_back(normal);
      }
      facets_.triangles[corner->triangle][corner->index] = static_cast<std::uint32_t>(vertex);
    }
  }

  bool AreSmooth(std::uint32_t a, std::uint32_t b) const {
    return a == b || unit_normals_[a].dot(unit_normals_[b]) >= kCosCrease;
  }

  // Where two surfaces meet, or one has a crease.
  void AddEdges() {
    const std::vector<HalfEdge> edges = SortedHalfEdges(mesh_);
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
      if (!edges[i].SameEdge(edges[i + 1])) continue;
      const std::uint32_t a = edges[i].triangle, b = edges[i + 1].triangle;
      if (mesh_.surfaces[a] == mesh_.surfaces[b] && AreSmooth(a, b)) continue;
      facets_.edges.push_back({VertexOf(a, edges[i].low), VertexOf(a, edges[i].high)});
    }
  }
  std::uint32_t VertexOf(std::uint32_t triangle, std::uint32_t position) const {
    const auto& corners = mesh_.triangles[triangle];
    const auto found = std::find(corners.begin(), corners.end(), position);
    return facets_.triangles[triangle][static_cast<std::size_t>(found - corners.begin())];
  }

  const TriangleMesh& mesh_;
  std::vector<Vec3> unit_normals_;
  Mesh facets_;
};

}  // namespace

Mesh FacetsOf(const TriangleMesh& mesh) { return FacetMaker(mesh).Make(); }

}  // namespace tranos::geom
