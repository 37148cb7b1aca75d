// SPDX-License-Identifier: GPL-3.0-or-later
// Rational Bézier spans in homogeneous coordinates (w·x, w·y, w·z, w): what B-splines are cut
// into before anything is computed. Internal to geom.
#pragma once

#include <vector>

#include "geom/curve.h"

namespace tranos::geom {

inline constexpr int kMaxDegree = 24;

using Vec4 = Eigen::Vector4d;
// Columns are poles; room for the largest degree is on the stack.
using BezierPoles = Eigen::Matrix<double, 4, Eigen::Dynamic, Eigen::ColMajor, 4, kMaxDegree + 1>;

// A span of a curve over natural parameters [begin, end].
struct BezierSpan {
  double begin = 0, end = 1;
  BezierPoles poles;
};

// Position with first and second derivative.
struct CurveJet {
  Vec3 point = Vec3::Zero(), d1 = Vec3::Zero(), d2 = Vec3::Zero();
};

inline Vec4 Homogeneous(const Vec3& p, double weight) {
  return {weight * p.x(), weight * p.y(), weight * p.z(), weight};
}
inline Vec3 Projected(const Vec4& h) { return h.head<3>() / h.w(); }

// At s in [0, 1] of the span, derivatives by s.
CurveJet JetOf(const BezierPoles&, double s);
// The homogeneous point with its derivatives by s, before division by the weight.
struct HomogeneousJet {
  Vec4 point = Vec4::Zero(), d1 = Vec4::Zero(), d2 = Vec4::Zero();
};
HomogeneousJet HomogeneousJetOf(const BezierPoles&, double s);
CurveJet Project(const HomogeneousJet&);

// The parts over [0, s] and [s, 1].
std::pair<BezierPoles, BezierPoles> Split(const BezierPoles&, double s);
// The same curve with more poles.
BezierPoles Elevated(const BezierPoles&, int degree);

inline int DegreeOf(const BezierPoles& poles) { return static_cast<int>(poles.cols()) - 1; }

// Whether sizes, degree and knots' ends are such that the curve can be evaluated at all.
bool HasSoundShape(const BsplineCurve&);
// Every knot span that is not empty, in order. Natural parameters.
std::vector<BezierSpan> BezierSpansOf(const BsplineCurve&);
// The one span with the parameter t.
BezierSpan BezierSpanAt(const BsplineCurve&, double t);
// The poles that have influence on the knot span with this index.
BezierPoles ControlOf(const BsplineCurve&, int knot_index);
// Bézier poles over [a, b] (knots' scale) inside the knot span whose poles are `control`.
BezierPoles BezierOver(const std::vector<double>& knots, int knot_index, const BezierPoles& control,
                       double a, double b);
// The index k of the non-empty knot span with knots[k] ≤ u < knots[k + 1]; the last one at the end.
int KnotSpanAt(const std::vector<double>& knots, int degree, double u);

// The arc as one rational quadratic per span of at most a right angle.
std::vector<BezierSpan> BezierSpansOf(const Arc&);

// Spans joined to one B-spline: degree raised to the highest, knots one unit per span with full
// multiplicity, weights scaled so that they agree at the joints.
BsplineCurve JoinSpans(const std::vector<BezierSpan>&);

}  // namespace tranos::geom
