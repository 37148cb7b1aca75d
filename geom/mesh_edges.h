// SPDX-License-Identifier: GPL-3.0-or-later
// The sides of triangles, so ordered that those on one edge stand together. Internal to
// geom.
#pragma once

#include <span>
#include <tuple>

#include "geom/triangle_mesh.h"

namespace tranos::geom {

struct HalfEdge {
  std::uint32_t low, high;  // positions' indices
  std::uint32_t triangle;
  bool rises;  // the triangle runs from `low` to `high`
  bool SameEdge(const HalfEdge& other) const { return low == other.low && high == other.high; }
  bool operator<(const HalfEdge& other) const {
    return std::tie(low, high, triangle) < std::tie(other.low, other.high, other.triangle);
  }
};
// Of triangles by their corners' indices; the sides on one edge are in the triangles' order.
std::vector<HalfEdge> SortedHalfEdges(std::span<const std::array<std::uint32_t, 3>> triangles);
inline std::vector<HalfEdge> SortedHalfEdges(const TriangleMesh& mesh) {
  return SortedHalfEdges(mesh.triangles);
}

// Calls visit(sides) with the sides on each edge.
template <class Visit>
void ForEachEdge(const std::vector<HalfEdge>& sides, Visit&& visit) {
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].SameEdge(sides[i])) ++end;
    visit(std::span(sides).subspan(i, end - i));
    i = end;
  }
}

}  // namespace tranos::geom
