// SPDX-License-Identifier: GPL-3.0-or-later
// Rounding and cutting the corners of curves made of lines and arcs.
#pragma once

#include <optional>

#include "geom/curve.h"

namespace tranos::geom {

// Where two pieces of a curve meet at an angle: the index of the piece that ends there, and the
// place. The last of a closed curve is its start.
struct Corner {
  std::size_t piece;
  Vec3 point;
};
std::vector<Corner> CornersOf(const Curve& curve);

// The curve with its corners (or the one given) rounded by arcs of this radius that touch both
// sides, or cut off at this length along both sides (along the one that ends, then the one that
// begins). kOutOfRange where they do not fit between the pieces' ends, kDegenerate if there is no
// corner or nothing is to be cut, kNotPlanar for pieces that do not lie in one plane; a B-spline
// beside a corner is kOutOfRange, too.
Result<Curve> Rounded(const Curve& curve, double radius_m, std::optional<Corner> only = {});
Result<Curve> CutOff(const Curve& curve, double before_m, double after_m,
                     std::optional<Corner> only = {});

// Two open curves with the corner between them rounded or cut off: each made longer or shorter, at
// the end that is nearer to where they meet, up to where the new piece begins.
struct Joint {
  Curve a, b;
  Curve between;
};
Result<Joint> RoundedBetween(const Curve& a, const Curve& b, double radius_m);
Result<Joint> CutOffBetween(const Curve& a, const Curve& b, double along_a_m, double along_b_m);

}  // namespace tranos::geom
