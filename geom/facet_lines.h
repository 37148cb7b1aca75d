// SPDX-License-Identifier: GPL-3.0-or-later
// The parameter lines along which a surface is cut into facets. Internal to geom.
#pragma once

#include "geom/facet_count.h"
#include "geom/surface_patches.h"

namespace tranos::geom {

// A line of constant parameter: at `local` of the span (the lower of two where they join).
struct FacetLine {
  int span;
  double local;
  bool crease = false;  // the tangent plane breaks here
};

// Neighbouring spans that are cut as one: a circular arc (all poles across it are points of
// concentric arcs or of their affine images), a straight span, or any other.
struct SpanGroup {
  enum class Kind { kStraight, kArc, kGeneral };
  Kind kind;
  int first, count;
  double sweep_rad = 0;    // of an arc
  double reach_m = 0;      // largest radius of an arc; largest second derivative of a general span
  double turning_rad = 0;  // of a general span
};

// One of the two parameter directions of a grid.
struct Direction {
  std::vector<SpanGroup> groups;
  std::vector<double> half_rad;  // of each span: half the sweep of its arcs, or zero
  std::vector<bool> crease;  // at each break; first and last are one flag where the surface closes
  bool closed = false;       // the last line is the first
};

Direction DirectionAlongU(const PatchGrid&);
// The same surface with u and v exchanged.
PatchGrid Exchanged(const PatchGrid&);

// The facets of each group for the tolerance (chord_m the share of this direction), times `factor`.
std::vector<double> FacetCounts(const Direction&, const Tolerance&, double factor);
std::vector<FacetLine> LinesOf(const Direction&, const std::vector<double>& counts);

// The unit normal at (s, t); where the surface is singular there, its limit from the side of
// direction `towards` of the patch's parameters. Zero if there is none.
Vec3 LimitNormal(const BezierPatch&, double s, double t, const Vec2& towards);

// Two normals further apart than this make a crease.
inline constexpr double kCrease_rad = 1e-6;
double AngleBetween(const Vec3& a, const Vec3& b);

}  // namespace tranos::geom
