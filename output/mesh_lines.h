// SPDX-License-Identifier: GPL-3.0-or-later
// The lines by which a drawing shows a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/surface.h"

namespace tranos::output {

// The edges of a mesh whose doubled vertices count as one. Edges of more than two triangles appear
// once for each further pair.
struct MeshEdge {
  std::array<std::uint32_t, 2> ends;       // positions' indices, the first of equal ones
  std::array<std::uint32_t, 2> triangles;  // on either side; kNoTriangle at a border
  bool feature = false;                    // a border or crease
};
inline constexpr std::uint32_t kNoTriangle = 0xffffffff;
std::vector<MeshEdge> EdgesOf(const geom::Mesh& mesh);

// Edges joined to lines as long as possible, broken where more or fewer than two of them meet.
// `vertices` has one item more than `edges`, which are indices into the list given.
struct EdgeLine {
  std::vector<std::uint32_t> vertices;
  std::vector<std::uint32_t> edges;
};
std::vector<EdgeLine> JoinEdges(const std::vector<MeshEdge>& edges);

// Those that are borders or creases.
std::vector<MeshEdge> FeatureEdges(const std::vector<MeshEdge>& edges);
// Those, no features, where the facets' planes differ by more than half a degree.
std::vector<MeshEdge> FacetEdges(const geom::Mesh& mesh, const std::vector<MeshEdge>& edges);
// Those, no features, where the surface turns away from the viewer: one facet is seen from its
// front and the other from its back, or edge-on, after `picture_from_mesh`.
std::vector<MeshEdge> OutlineEdges(const geom::Mesh& mesh, const std::vector<MeshEdge>& edges,
                                   const geom::Affine& picture_from_mesh);

}  // namespace tranos::output
