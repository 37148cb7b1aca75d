// SPDX-License-Identifier: GPL-3.0-or-later
// Where curves meet.
#pragma once

#include "geom/curve.h"

namespace tranos::geom {

// Points of two curves nearer to one another than this are common.
inline constexpr double kMeeting_m = 1e-6;

// A common point, with the natural parameters at which the two curves are there.
struct Crossing {
  Vec3 point;
  double t_a, t_b;
};

// The points that two curves share, crossing or touching, in the order of the first; a corner
// counts once. Exact for lines and arcs; of B-splines found by halving and polished. Stretches
// that lie on one another share more than points, and are not told.
std::vector<Crossing> Crossings(const Curve& a, const Curve& b);

// How many lines, arcs and B-splines the curve is made of: the cost of `Crossings` grows with the
// product.
std::size_t CountPieces(const Curve& curve);

}  // namespace tranos::geom
