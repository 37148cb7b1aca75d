// SPDX-License-Identifier: GPL-3.0-or-later
// Curves made from what a drafter gives: half axes, corners, poles, points to run through.
#pragma once

#include "geom/curve.h"

namespace tranos::geom {

// The ellipse with half axes along the frame's x and y, counter-clockwise from the end of the one
// along x: the exact rational quadratic, which every function of a B-spline serves.
BsplineCurve Ellipse(const Frame& frame, double half_axis_x, double half_axis_y);
// The corners of a regular polygon about the frame's origin, counter-clockwise, the first on x.
Polyline RegularPolygon(const Frame& frame, double radius, int sides);

// The cubic B-spline that runs through the points with continuous curvature, each interval in
// proportion to its chord. An open one ends without curvature, a closed one runs smoothly from the
// last point on to the first (which is not repeated). kDegenerate with the index of a point that
// lies on the one before, or for fewer than two points (three, of a closed one).
Result<BsplineCurve> CurveThrough(const std::vector<Vec3>& points, bool closed);
// The same through points of any dimension, a row each: `chords` from each to the next one.
struct CubicRow {
  std::vector<double> knots;
  Eigen::MatrixXd poles;
};
CubicRow CubicThrough(const Eigen::MatrixXd& points, const std::vector<double>& chords,
                      bool closed);
// The B-spline with these poles and uniform knots, from the first pole to the last, or closed
// (smooth all round). The degree is lowered to one less than the number of poles. kDegenerate for
// fewer than two poles (three, of a closed one); kOutOfRange for a degree below 1 or above 24.
Result<BsplineCurve> CurveByPoles(const std::vector<Vec3>& poles, int degree, bool closed);

// The arc that leaves `start` along the unit `tangent` and ends at `end`; a line where `end` lies
// straight ahead. kDegenerate if it lies straight behind, or at the start.
Result<Curve> TangentArc(const Vec3& start, const Vec3& tangent, const Vec3& end);

}  // namespace tranos::geom
