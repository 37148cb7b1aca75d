// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes joined along their borders. Internal to geom.
#pragma once

#include "geom/surface.h"
#include "geom/triangle_mesh.h"

namespace tranos::geom {

struct Stitched {
  TriangleMesh mesh;                       // all triangles of a connected part facing one way
  std::vector<std::vector<Vec3>> normals;  // at each position, one for each smooth part that meets
};
// Borders within the tolerance of one another are one: the corners of each are put into the other.
// Parts of a mesh between its creases are surfaces of their own.
Stitched Stitch(const std::vector<Mesh>& meshes, double tolerance_m);

}  // namespace tranos::geom
