// SPDX-License-Identifier: GPL-3.0-or-later
// A curve as facets that remember where it was smooth. Internal to geom.
#pragma once

#include <vector>

#include "geom/curve.h"

namespace tranos::geom {

struct FacetCorner {
  Vec3 point;
  Vec3 in, out;           // unit: the curve's directions before and after the corner
  bool IsSmooth() const;  // not a corner of the curve itself
};
// The first corner of a closed curve is not repeated; at an open one's ends `in` and `out` agree.
struct FacetedCurve {
  std::vector<FacetCorner> corners;
  bool closed = false;
  std::size_t FacetCount() const { return closed ? corners.size() : corners.size() - 1; }
};
// Where facets go by the chord tolerance, a full circle has a multiple of four, so that it reaches
// as far as it should. kDegenerate for a curve of no length; kTooLarge as Tessellate.
Result<FacetedCurve> FacetsOf(const Curve&, const Tolerance&);

// The facets of a full turn by this tolerance; may be far above any cap.
double FullTurnFacets(double radius_m, const Tolerance&);

// The number of the smooth run that each facet is of: facets on either side of a smooth corner are
// of one run. Numbers count from zero.
struct SmoothRuns {
  std::vector<std::uint32_t> of_facet;
  std::uint32_t count = 0;
};
SmoothRuns SmoothRunsOf(const FacetedCurve&);

}  // namespace tranos::geom
