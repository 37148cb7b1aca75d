// SPDX-License-Identifier: GPL-3.0-or-later
// Where a plane cuts facets.
#pragma once

#include "geom/curve.h"
#include "geom/triangle_mesh.h"

namespace tranos::geom {

// The lines in which the plane cuts the mesh, joined to polylines as long as possible, those of a
// closed mesh closed. Corners on the plane count as above it, so that a face that lies in the plane
// is cut round its border or not at all.
std::vector<Polyline> SectionOf(const TriangleMesh&, const Frame& plane);
// Of a surface's facets.
Result<std::vector<Polyline>> SectionOf(const Surface&, const Frame& plane, const Tolerance&);

}  // namespace tranos::geom
