// SPDX-License-Identifier: GPL-3.0-or-later
// Parallel curves.
#pragma once

#include "geom/curve.h"

namespace tranos::geom {

enum class OffsetJoin : std::uint8_t {
  kMitred,   // sides run on until they meet; beyond four times the distance the tip is cut off
  kRounded,  // an arc about the corner
};

// The curves at this distance to the left of the curve as seen from `normal` (to the right, if
// negative): lines and arcs exactly, where the curve comes too near to itself cut back to what is
// no nearer to it than the distance. None where nothing is left. kNotPlanar for a curve across the
// normal's plane, kOutOfRange for a B-spline, a distance of zero, more
// than five thousand pieces.
Result<std::vector<Curve>> Offset(const Curve& curve, const Vec3& normal, double distance_m,
                                  OffsetJoin join);

}  // namespace tranos::geom
