// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces that all but lie in one another. Internal to geom.
#pragma once

#include "geom/triangle_mesh.h"

namespace tranos::geom {

// By no more than this corners are moved. Many times kCoincident_m, which is what counts as
// meeting: of three corners of a triangle that small each lies on the edge of the other two.
inline constexpr double kConformed_m = 16 * kCoincident_m;

// The same surface, in which what meets is one: corners nearer than kConformed_m are merged, facets
// are divided where corners and edges of others lie in them, nearer than kCoincident_m and three
// times that, until facets that lie in one another have the same corners. What is thinner than
// kConformed_m may be gone. A closed surface stays closed.
TriangleMesh Conformed(TriangleMesh mesh);

}  // namespace tranos::geom
