// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/mesh_edges.h"

#include <algorithm>

namespace tranos::geom {

std::vector<HalfEdge> SortedHalfEdges(std::span<const std::array<std::uint32_t, 3>> triangles) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = triangles[t][k], to = triangles[t][(k + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), t, from < to});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace tranos::geom
