// SPDX-License-Identifier: GPL-3.0-or-later
// The simple solids as closed meshes that look outward. Sizes are above kCoincident_m, else
// kDegenerate; round ones have their first vertex at angle 0, on the frame's x axis, and all
// vertices on the surface that they stand for.
#pragma once

#include "geom/triangle_mesh.h"

namespace tranos::geom {

// From the frame's origin along its axes; a size may be negative, and then goes the other way.
Result<TriangleMesh> SlabMesh(const Frame&, const Vec3& size);
// The half of a slab below the plane that rises along x, from nothing at its start.
Result<TriangleMesh> WedgeMesh(const Frame&, const Vec3& size);
// About the frame's z axis from its origin, by a height that may be negative.
Result<TriangleMesh> CylinderMesh(const Frame&, double radius_m, double height_m, const Tolerance&);
// As a cylinder, with another radius at the top, which may be zero.
Result<TriangleMesh> ConeMesh(const Frame&, double radius_m, double top_radius_m, double height_m,
                              const Tolerance&);
// About the origin; poles on the z axis are vertices.
Result<TriangleMesh> SphereMesh(const Frame&, double radius_m, const Tolerance&);
// About the z axis, the tube's centre at radius_m, through an angle in (0, 2π] from the x axis.
// kOutOfRange for a tube that reaches the axis.
Result<TriangleMesh> TorusMesh(const Frame&, double radius_m, double tube_radius_m,
                               double angle_rad, const Tolerance&);

}  // namespace tranos::geom
