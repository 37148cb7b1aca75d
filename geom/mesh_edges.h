// SPDX-License-Identifier: GPL-3.0-or-later
// The sides of a mesh's triangles, so ordered that those on one edge stand together. Internal to
// geom.
#pragma once

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
std::vector<HalfEdge> SortedHalfEdges(const TriangleMesh&);

}  // namespace tranos::geom
