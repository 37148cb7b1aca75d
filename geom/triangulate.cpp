// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/triangulate.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace tranos::geom {
namespace {

constexpr int kUnvisited = -1;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<
    Kernel, CGAL::Triangulation_face_base_with_info_2<int, Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Crossing = CGAL::No_constraint_intersection_requiring_constructions_tag;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, Crossing>;
using VertexHandle = Triangulation::Vertex_handle;
using FaceHandle = Triangulation::Face_handle;

tl::unexpected<Error> Refuse(const char* detail, std::size_t loop) {
  return tl::unexpected(Error{ErrorCode::kDegenerate, detail, static_cast<int>(loop)});
}

tl::expected<void, Error> CheckLoops(const std::vector<std::vector<Vec2>>& loops) {
  for (std::size_t l = 0; l < loops.size(); ++l) {
    const std::vector<Vec2>& loop = loops[l];
    if (loop.size() < 3) return Refuse("an outline has fewer than three corners", l);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      if (!loop[i].allFinite()) return Refuse("a coordinate is not a number", l);
      if (loop[i] == loop[(i + 1) % loop.size()]) {
        return Refuse("two neighbouring corners lie in one place", l);
      }
    }
  }
  return {};
}

// Vertices of all points, those in one place shared and named after the first.
std::vector<VertexHandle> Insert(const std::vector<std::vector<Vec2>>& loops,
                                 Triangulation* triangulation) {
  std::vector<std::pair<Kernel::Point_2, std::uint32_t>> points;
  for (const std::vector<Vec2>& loop : loops) {
    for (const Vec2& p : loop) {
      // Zero has one sign, so that equal points are equal to the bit.
      points.emplace_back(Kernel::Point_2(p.x() + 0.0, p.y() + 0.0),
                          static_cast<std::uint32_t>(points.size()));
    }
  }
  triangulation->insert(points.begin(), points.end());
  std::map<std::pair<double, double>, VertexHandle> at;
  for (const VertexHandle vertex : triangulation->finite_vertex_handles()) {
    at[{vertex->point().x(), vertex->point().y()}] = vertex;
  }
  std::vector<VertexHandle> vertices;
  for (auto point = points.rbegin(); point != points.rend(); ++point) {
    const VertexHandle vertex = at.at({point->first.x(), point->first.y()});
    vertex->info() = point->second;  // the first one's comes last
    vertices.push_back(vertex);
  }
  std::reverse(vertices.begin(), vertices.end());
  return vertices;
}

using Side = std::pair<VertexHandle, VertexHandle>;

// The loop at which a side crosses one of another, or lies on it; nothing if all is well.
std::optional<std::size_t> Constrain(const std::vector<std::vector<Vec2>>& loops,
                                     const std::vector<VertexHandle>& vertices,
                                     Triangulation* triangulation) {
  std::set<Side> sides;
  std::size_t first = 0;
  for (std::size_t l = 0; l < loops.size(); ++l) {
    const std::size_t count = loops[l].size();
    for (std::size_t i = 0; i < count; ++i) {
      const VertexHandle a = vertices[first + i], b = vertices[first + (i + 1) % count];
      if (!sides.insert(std::minmax(a, b)).second) return l;
      try {
        triangulation->insert_constraint(a, b);
      } catch (const Triangulation::Intersection_of_constraints_exception&) {
        return l;
      }
      // A side through another's corner is broken there: that corner touches a side.
      if (!triangulation->is_edge(a, b)) return l;
    }
    first += count;
  }
  return std::nullopt;
}

// Marks each face with the number of sides that must be crossed to reach it from outside.
void CountNesting(Triangulation* triangulation) {
  for (const FaceHandle face : triangulation->all_face_handles()) face->info() = kUnvisited;
  std::vector<FaceHandle> level = {triangulation->infinite_face()};
  for (int depth = 0; !level.empty(); ++depth) {
    std::vector<FaceHandle> next;
    while (!level.empty()) {
      const FaceHandle face = level.back();
      level.pop_back();
      if (face->info() != kUnvisited) continue;
      face->info() = depth;
      for (int i = 0; i < 3; ++i) {
        if (face->neighbor(i)->info() != kUnvisited) continue;
        (face->is_constrained(i) ? next : level).push_back(face->neighbor(i));
      }
    }
    level = std::move(next);
  }
}

}  // namespace

Result<std::vector<std::array<std::uint32_t, 3>>> TriangulatePolygon(
    const std::vector<std::vector<Vec2>>& loops) {
  if (auto checked = CheckLoops(loops); !checked) return tl::unexpected(checked.error());
  Triangulation triangulation;
  const std::vector<VertexHandle> vertices = Insert(loops, &triangulation);
  if (const auto loop = Constrain(loops, vertices, &triangulation)) {
    return Refuse("the sides of an outline cross or touch", *loop);
  }
  CountNesting(&triangulation);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const FaceHandle face : triangulation.finite_face_handles()) {
    if (face->info() % 2 == 0) continue;
    triangles.push_back(
        {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  }
  return triangles;
}

}  // namespace tranos::geom
