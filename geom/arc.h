// SPDX-License-Identifier: GPL-3.0-or-later
// Circular arcs in closed form. Internal to geom.
#pragma once

#include "geom/curve.h"

namespace tranos::geom {

struct CosSin {
  double cos, sin;
};
// Cosine and sine, exact at multiples of a right angle (to which rounded angles snap).
CosSin ExactCosSin(double angle_rad);

// The number of equal parts, at least one, none larger than `part`; ratios within rounding
// of a whole number count as whole.
double PartsOf(double whole, double part);

Vec3 PointAtAngle(const Arc&, double angle_rad);
Box BoxOfArc(const Arc&);
Nearest NearestOnArc(const Arc&, const Vec3& p);
// The angle about the centre from the frame's x axis, in [0, 2π).
double AngleOf(const Frame&, const Vec3& p);
Arc ReversedArc(const Arc&);
inline Arc FullTurn(const Circle& c) { return {c.frame, c.radius, 2 * kPi}; }

}  // namespace tranos::geom
