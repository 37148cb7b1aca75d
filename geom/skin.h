// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of what an outline covers when it is carried from station to station. Internal to
// geom.
#pragma once

#include "geom/outline.h"
#include "geom/triangle_mesh.h"

namespace tranos::geom {

struct Stations {
  std::vector<std::vector<Vec3>> points;  // of each station, in the order of the outline's
  std::vector<std::uint32_t> runs;        // the smooth run that each span between stations is of
  std::uint32_t run_count = 1;
  bool closed = false;  // the last station is joined to the first, and there are no caps
  // What fills the last station, where that is not the outline's own figure.
  std::vector<std::array<std::uint32_t, 3>> last_triangles = {};
};
// Facing outward. kDegenerate if it encloses nothing.
Result<TriangleMesh> SkinOf(const Outline&, const Stations&);

// Positions that are equal to the bit as one, without triangles that have lost a corner by it.
TriangleMesh Welded(const TriangleMesh&);
// The mesh turned inside out where its volume is negative; kDegenerate where that is nothing.
Result<TriangleMesh> FacingOutward(TriangleMesh mesh);

}  // namespace tranos::geom
