// SPDX-License-Identifier: GPL-3.0-or-later
// Solids that outlines cover when they are carried along, as closed meshes that look outward.
// An outline is closed curves of one plane: those inside others are holes. Errors name the curve at
// fault by its index: kNotClosed, kNotPlanar, kDegenerate (it crosses itself or another).
#pragma once

#include "geom/solid.h"

namespace tranos::geom {

// kDegenerate for a vector that runs within the outline's plane.
Result<TriangleMesh> ProjectionMesh(const std::vector<Curve>& outline, const Vec3& vector,
                                    const Tolerance&);

// Anticlockwise about the axis by an angle in (0, 2π]; a full turn has no caps. The axis lies in
// the outline's plane (kNotPlanar) and does not cross the outline (kOutOfRange); along it the solid
// is closed up.
Result<TriangleMesh> RevolutionMesh(const std::vector<Curve>& outline, const Vec3& axis_point,
                                    const Vec3& axis_direction, double angle_rad, const Tolerance&);

// The outline's points (x, y) stand x to the right of the path's start, seen along it, and y above;
// `up` says where that is. The outline is carried without twist and mitred at the path's corners;
// along a closed path in space what twist closes it is shared out evenly. kOutOfRange where the
// path turns too tightly for the outline, or turns back.
Result<TriangleMesh> SweepMesh(const std::vector<Curve>& outline_at_origin, const Curve& path,
                               const Vec3& up, const Tolerance&);
// As SweepMesh, with the outline standing where it is drawn: in a plane through the path's start
// that crosses the path there.
Result<TriangleMesh> SweepMeshInPlace(const std::vector<Curve>& outline, const Curve& path,
                                      const Tolerance&);
// Whether the outline's plane passes squarely through the path's start.
bool StandsAtStart(const Curve& outline, const Curve& path);

// Through two outlines or more, one curve each, in their order, capped at the ends. Corners are
// matched where the outlines have equally many, else points at equal shares of the length, from
// those that lie nearest to one another.
Result<TriangleMesh> LoftMesh(const std::vector<Curve>& outlines, const Tolerance&);
// The same through faces of one outline each, which comes first, and equally many holes: the loft
// of the outlines less those of the holes. A hole goes on into the one that is nearest, each seen
// from the middle of its outline.
Result<Solid> LoftSolid(const std::vector<std::vector<Curve>>& faces, const Tolerance&);

}  // namespace tranos::geom
