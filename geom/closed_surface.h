// SPDX-License-Identifier: GPL-3.0-or-later
// Solids from surfaces: thickened ones, and those that surfaces enclose.
#pragma once

#include "geom/surface.h"
#include "geom/triangle_mesh.h"

namespace tranos::geom {

// A plane face, by the closed curves that bound it: those inside others are holes.
using Face = std::vector<Curve>;

// The surfaces and faces, in that order, that together enclose a volume.
// Borders meet within the chord tolerance, or a micrometre if that is larger. kNotClosed where a
// border is left open, with one of its points in the detail.
Result<TriangleMesh> EnclosedMesh(const std::vector<Surface>& surfaces,
                                  const std::vector<Face>& faces, const Tolerance&);

// What lies between the surfaces and faces moved outward by `outward_m` and inward by `inward_m`,
// their sum above zero, closed along the borders. Outward is away from the middle of their box, or
// where they are flat the way that the largest coordinate of the normal grows. Surfaces that meet
// are thickened as one, mitred where they meet at an angle. kOutOfRange where they bend more
// tightly than they are moved.
Result<TriangleMesh> ThickenedMesh(const std::vector<Surface>& surfaces,
                                   const std::vector<Face>& faces, double outward_m,
                                   double inward_m, const Tolerance&);

}  // namespace tranos::geom
