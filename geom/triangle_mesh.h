// SPDX-License-Identifier: GPL-3.0-or-later
// Closed triangle meshes: what a solid is made of, and what is measured on one.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/surface.h"

namespace tranos::geom {

// Triangles run anticlockwise seen from outside. `surfaces` has an entry for each triangle: the
// number of the smooth surface (a plane, a cylinder's side, a dome) that it is a facet of; facets
// of one surface are shaded as one, and an edge between two surfaces is a line in drawings.
struct TriangleMesh {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> surfaces;
  bool may_cross = false;  // it was made in a way that does not keep it from crossing itself
};
// The mesh, of which that is so.
inline Result<TriangleMesh> MayCross(Result<TriangleMesh> mesh) {
  if (mesh) mesh->may_cross = true;
  return mesh;
}

// Every edge is run along as often in one direction as in the other: nothing is open. Edges where
// parts of a solid touch have more than two triangles.
bool IsClosed(std::span<const std::array<std::uint32_t, 3>> triangles);
inline bool IsClosed(const TriangleMesh& mesh) { return IsClosed(mesh.triangles); }
// m³, positive for a mesh whose triangles look outward.
double Volume(const TriangleMesh&);
double Area(const TriangleMesh&);    // m²
Vec3 Centroid(const TriangleMesh&);  // of the enclosed volume; the box's centre where that is zero
Box BoundingBox(const TriangleMesh&);
// Handles through the surface, summed over its parts: 0 for a ball, 1 for a ring. Of meshes whose
// edges have two triangles each; parts may touch in corners.
int Genus(const TriangleMesh&);
// The number of separate surfaces: parts that share no edge.
int ShellCount(const TriangleMesh&);
// Whether two triangles meet anywhere but in a common corner or edge; exact.
bool HasSelfIntersection(const TriangleMesh&);
Nearest NearestPoint(const TriangleMesh&, const Vec3& p);

// A reflection turns the triangles round, so that they look outward still.
TriangleMesh Transformed(TriangleMesh mesh, const Affine& target_from_source);

// Positions with normals for output: doubled along edges between surfaces, and within a surface
// where facets meet at more than a crease's angle.
Mesh FacetsOf(const TriangleMesh&);

}  // namespace tranos::geom
