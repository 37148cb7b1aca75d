// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles that fill plane polygons with holes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/primitives.h"

namespace tranos::geom {

// The triangles of the constrained Delaunay triangulation that lie inside an odd number of the
// loops, each counter-clockwise. Indices run through the loops' points in order; no point is added.
// Loops may run either way, lie in one another and touch in corners (where they do, triangles name
// the corner that comes first). Exact for whatever is told apart by doubles. kDegenerate with the
// loop's index: fewer than three corners, two neighbouring corners in one place, sides that cross
// or lie on one another, a number that is not finite.
Result<std::vector<std::array<std::uint32_t, 3>>> TriangulatePolygon(
    const std::vector<std::vector<Vec2>>& loops);

}  // namespace tranos::geom
