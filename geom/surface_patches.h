// SPDX-License-Identifier: GPL-3.0-or-later
// Any surface as a grid of rational Bézier patches, exact for Coons patches too: measures, boxes,
// nearest points and facets are computed on these. Internal to geom.
#pragma once

#include "geom/bezier.h"
#include "geom/surface.h"

namespace tranos::geom {

// rows[i] holds the poles along v that belong to pole i along u.
struct BezierPatch {
  std::vector<BezierPoles> rows;
};

// Patch (i, j) covers natural parameters breaks_u[i] … breaks_u[i + 1], and likewise in v.
struct PatchGrid {
  std::vector<double> breaks_u, breaks_v;
  std::vector<BezierPatch> patches;
  int count_u() const { return static_cast<int>(breaks_u.size()) - 1; }
  int count_v() const { return static_cast<int>(breaks_v.size()) - 1; }
  const BezierPatch& at(int i, int j) const { return patches[i * count_v() + j]; }
};

struct SurfaceJet {
  Vec3 point, du, dv, duu, duv, dvv;
};

// At (s, t) in [0, 1]² of the patch, derivatives by s and t.
SurfaceJet JetOf(const BezierPatch&, double s, double t);
Vec3 PointOf(const BezierPatch&, double s, double t);
// The poles along u that belong to pole j along v.
BezierPoles ColumnOf(const BezierPatch&, int j);
BezierPatch SplitOff(const BezierPatch&, bool along_u, bool upper_half);

// Empty for a surface that is not sound.
PatchGrid PatchesOf(const Surface&);
PatchGrid PatchesOf(const CoonsPatch&);
// The one patch with these natural parameters, and where in it they are.
struct Located {
  BezierPatch patch;
  double s, t;
};
Located PatchAt(const BsplineSurface&, double u, double v);

// Natural parameters of the ends of the curve's spans.
std::vector<double> BreaksOf(const BsplineCurve&);
// Ascending, those nearer than rounding taken as one.
std::vector<double> UnitedBreaks(const std::vector<double>& a, const std::vector<double>& b);
// The curve cut at these natural parameters, which include its own breaks.
std::vector<BezierSpan> SpansBetween(const BsplineCurve&, const std::vector<double>& breaks);

// The curves as B-splines with one degree and the same knots; those of equal natural parameters
// belong together.
std::vector<BsplineCurve> MadeAlike(const std::vector<Curve>& curves);

}  // namespace tranos::geom
