// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces that all but lie in one another. Internal to geom.
#pragma once

#include "geom/triangle_mesh.h"

namespace tranos::geom {

// The same surface, in which what is nearer than about kCoincident_m is one: facets are divided,
// and so bent by no more than that, where corners and edges of others lie in them, until facets
// that lie in one another have the same corners. A closed surface stays closed.
TriangleMesh Conformed(TriangleMesh mesh);

}  // namespace tranos::geom
