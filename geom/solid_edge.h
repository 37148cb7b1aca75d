// SPDX-License-Identifier: GPL-3.0-or-later
// Straight edges of solids, and what is cut away or filled in where they are cut off or rounded.
#pragma once

#include <array>
#include <vector>

#include "geom/triangle_mesh.h"

namespace tranos::geom {

// A straight edge between two flat surfaces of a mesh. The first of its faces is the one that looks
// further up; of two upright ones, the one that looks further along y, then x.
struct SolidEdge {
  Vec3 start, end;
  bool is_convex;              // it stands out; else it runs in
  std::array<Vec3, 2> across;  // in each face, away from the edge: unit, square to it
  // How far each face goes on beside the edge, until a corner or a border of it is reached; and
  // how much of that is this edge's where what is reached is another such edge, worked on, too.
  std::array<double, 2> room_m, shared_room_m;
  // Outward normals of the other faces that meet at the start, and at the end.
  std::array<std::vector<Vec3>, 2> end_normals;
};
std::vector<SolidEdge> SolidEdgesOf(const TriangleMesh&);
double Distance(const SolidEdge&, const Vec3& p);

// The largest radius that fits, alone or where all edges are rounded.
double LargestRadius(const SolidEdge&, bool shared);

// The prism that is taken away from a solid along a convex edge, or added to it along another, so
// that the edge is cut off at these distances across its faces. A hair larger than what it changes,
// but where that would change more.
Result<TriangleMesh> ChamferPrism(const SolidEdge&, double first_m, double second_m);
// … so that it is rounded by a cylinder that touches both faces.
Result<TriangleMesh> FilletPrism(const SolidEdge&, double radius_m, const Tolerance&);

}  // namespace tranos::geom
