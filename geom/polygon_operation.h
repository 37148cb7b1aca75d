// SPDX-License-Identifier: GPL-3.0-or-later
// Union, difference and intersection of plane polygons.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/primitives.h"

namespace tranos::geom {

enum class SetOperation : std::uint8_t { kUnion, kDifference, kIntersection };

struct PlanePolygon {
  std::vector<Vec2> outer;               // counter-clockwise
  std::vector<std::vector<Vec2>> holes;  // clockwise
};

// Operands of a set operation: plane figures of polygons that are apart.
using PlaneFigure = std::vector<PlanePolygon>;

// The union of the figures `of`; what all of them have in common; or their union less that of the
// figures `by`. Computed exactly, rounded once. Corners in line with both neighbours are left out;
// each loop begins at its leftmost, lowest corner, and loops are in the order of these. Loops may
// touch in corners. kDegenerate, with the index of the figure in `of` and then `by`, where a
// figure's sides cross or lie on one another.
Result<PlaneFigure> CombineFigures(const std::vector<PlaneFigure>& of,
                                   const std::vector<PlaneFigure>& by, SetOperation operation);

}  // namespace tranos::geom
