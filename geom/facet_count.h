// SPDX-License-Identifier: GPL-3.0-or-later
// How many facets a tolerance asks for. Internal to geom.
#pragma once

#include <cstddef>

#include "geom/bezier.h"

namespace tranos::geom {

inline constexpr std::size_t kMaxFacetPoints = 10'000'000;

tl::expected<void, Error> Check(const Tolerance&);

// At least 1; may be far above any cap, or NaN for values that are.
double ArcFacets(double radius_m, double sweep_rad, const Tolerance&);
// For a curve whose tangent turns by this in all, when facets are given per turn.
double TurningFacets(double turning_rad, const Tolerance&);
// The turning of the poles' polygon, which is not less than the curve's where weights are equal.
double TurningOf(const BezierPoles&);

}  // namespace tranos::geom
