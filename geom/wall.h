// SPDX-License-Identifier: GPL-3.0-or-later
// Upright walls along a line, with openings.
#pragma once

#include "geom/curve.h"
#include "geom/triangle_mesh.h"

namespace tranos::geom {

// A wall stands on the plane of `base`, up its z axis, from `right_m` to the right of its line to
// `left_m` to the left (their sum is its thickness), mitred at the line's corners.
struct WallShape {
  Frame base;
  std::vector<Vec3> line;  // in the world, in the base's plane
  bool closed = false;     // the last point is joined to the first, which is not repeated
  double left_m = 0, right_m = 0, height_m = 0;
  std::size_t PartCount() const { return closed ? line.size() : line.size() - 1; }
};
// A hole through one straight part: its outline by the distance along the line from the part's
// start and by the height.
struct WallOpening {
  std::size_t part = 0;
  std::vector<Vec2> outline;
};

// One side of one straight part, seen from outside: origin at its lower left, x along the line, y
// up, z outward.
struct WallFace {
  Frame frame;
  double length_m;
};
// The faces on the right of the line, in its order, then those on the left. kOutOfRange with the
// part's index where the wall is too thick for its line.
Result<std::vector<WallFace>> FacesOf(const WallShape&);

// The wall; its openings are holes in the faces of its parts, cut in two dimensions. kOutOfRange as
// FacesOf; kDoNotMeet with the opening's index where one does not lie wholly within both faces of
// its part (a door that begins at the floor, say), or openings touch.
Result<TriangleMesh> WallMesh(const WallShape&, const std::vector<WallOpening>&);

}  // namespace tranos::geom
