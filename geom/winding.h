// SPDX-License-Identifier: GPL-3.0-or-later
// How often a plane curve runs round a point. Internal to geom.
#pragma once

#include "geom/curve.h"

namespace tranos::geom {

// The turns of the closed curve about the point, counter-clockwise as seen from plane.z; curve and
// point are taken where they fall on the plane. Exact whatever the curve's distance from the point,
// but for a point on it.
int WindingNumber(const Curve& curve, const Frame& plane, const Vec3& p);

// Points of the curve that lie in a plane exactly if the curve does.
std::vector<Vec3> SpanningPoints(const Curve& curve);

}  // namespace tranos::geom
