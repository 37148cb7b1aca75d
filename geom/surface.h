// SPDX-License-Identifier: GPL-3.0-or-later
// Exact surfaces over (u, v) in [0, 1]², their measures and their facets.
#pragma once

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

#include "geom/curve.h"

namespace tranos::geom {

// A rational tensor-product B-spline; pole (i, j) at poles[i·count_v + j], i along u.
struct BsplineSurface {
  int degree_u = 1, degree_v = 1;
  std::vector<double> knots_u, knots_v;
  int count_u = 0, count_v = 0;
  std::vector<Vec3> poles;
  std::vector<double> weights;  // empty for a polynomial one
};

// The bilinearly blended patch through four boundary curves (S. A. Coons, 1967).
// South and north run with u at v=0 and v=1, west and east with v at u=0 and u=1; corners coincide.
struct CoonsPatch {
  BsplineCurve south, north, west, east;
};

using Surface = std::variant<BsplineSurface, CoonsPatch>;

// The patch through 3 or 4 boundary curves given in any order and direction. Where opposite
// edges are translates of one another the patch is a surface of translation and is returned as
// the exact B-spline P_ij = P_i + Q_j − P_0, w_ij = w_i·w_j; otherwise as a CoonsPatch. Of three
// edges the shared end of the first two becomes a degenerate fourth. kDoNotMeet with the index of a
// curve whose end is free.
Result<Surface> EdgeSurface(const std::vector<Curve>& boundary, double tolerance_m = 1e-6);
Result<Surface> Extrusion(const Curve& profile, const Vec3& direction);
Result<Surface> Revolution(const Curve& profile, const Vec3& axis_point, const Vec3& axis_direction,
                           double angle_rad);
Result<Surface> Ruled(const Curve& from, const Curve& to);
// Smoothly through all the profiles, two or more, in their order: of second degree continuity, and
// straight between two. Each is turned round where it then lies nearer to the one before; an error
// has its index.
Result<Surface> LoftSurface(const std::vector<Curve>& profiles);
// Round the path, u round it from its right, seen along it with `up` above. Exact on lines, mitred
// where they meet, and on arcs that go on smoothly; other paths are followed by chords of the
// tolerance. kOutOfRange where the path turns too tightly.
Result<Surface> Tube(const Curve& path, double radius_m, const Vec3& up, const Tolerance&);

// Whether the surface is sound: numbers finite, counts, degrees and knots fitting, weights
// positive, a patch's corners meeting. Of a surface that is not, measures are zero and boxes empty.
tl::expected<void, Error> Check(const Surface&);
Vec3 PointAt(const Surface&, double u, double v);
Vec3 NormalAt(const Surface&, double u, double v);  // unit; zero where the surface is singular
bool IsClosed(const Surface&);                      // encloses a volume by itself (a torus, say)
double Area(const Surface&);                        // m²; 1e-9 relative
// The integral of the height above z over the plan, for a surface with one height over each
// point of its plan; otherwise kNotAGraph.
Result<double> VolumeUnder(const Surface&, double z);
Box BoundingBox(const Surface&);
Nearest NearestPoint(const Surface&, const Vec3& p);
Surface Transformed(const Surface&, const Affine& target_from_source);
bool HasExactBspline(const Surface&);

// Facets for output. Vertices on a crease are doubled, so that normals stay sharp; positions of
// doubled vertices are equal to the bit, so there are no cracks. `edges` are the borders and
// creases, as pairs of positions' indices, for wireframe and hidden-line pictures. kTooLarge above
// ten million triangles.
struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<std::uint32_t, 2>> edges;
};
Result<Mesh> Tessellate(const Surface&, const Tolerance&);

}  // namespace tranos::geom
