// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "geom/curve_pieces.h"
#include "geom/quadrature.h"
#include "geom/winding.h"

namespace tranos::geom {
namespace {

constexpr double kPlanar = 1e-9;

double SpeedAt(const BezierPoles& poles, double s) { return JetOf(poles, s).d1.norm(); }

double LengthOfSpan(const BezierPoles& poles, double until) {
  return Integrate([&](double s) { return SpeedAt(poles, s); }, 0.0, until);
}

// The parameter of a span where its length from the start is `length_m`: bisection kept
// within bounds, Newton's step where it stays inside them.
double ParameterAtLength(const BezierPoles& poles, double length_m, double total_m) {
  double low = 0, high = 1, s = total_m > 0 ? length_m / total_m : 0;
  for (int i = 0; i < 60; ++i) {
    const double excess = LengthOfSpan(poles, s) - length_m;
    if (std::abs(excess) <= 1e-14 * total_m) break;
    (excess > 0 ? high : low) = s;
    const double step = s - excess / SpeedAt(poles, s);
    s = step > low && step < high ? step : 0.5 * (low + high);
  }
  return s;
}

// The piece's parameter where its length from the start is `length_m` of `total_m`.
double ParameterAtLength(const Line&, double length_m, double total_m) {
  return total_m > 0 ? length_m / total_m : 0;
}
double ParameterAtLength(const Arc&, double length_m, double total_m) {
  return total_m > 0 ? length_m / total_m : 0;
}
double ParameterAtLength(const BsplineCurve& curve, double length_m, double) {
  const std::vector<BezierSpan> spans = BezierSpansOf(curve);
  for (std::size_t i = 0; i < spans.size(); ++i) {
    const double span_m = LengthOfSpan(spans[i].poles, 1);
    if (length_m > span_m && i + 1 < spans.size()) {
      length_m -= span_m;
      continue;
    }
    const double s = ParameterAtLength(spans[i].poles, std::min(length_m, span_m), span_m);
    return spans[i].begin + s * (spans[i].end - spans[i].begin);
  }
  return 0;
}

// Calls f(piece, local, t0, t1) for the piece that holds the fraction of the length, at its own
// parameter there; the piece lies over [t0, t1] of the curve.
template <class F>
void AtFraction(const Curve& curve, double fraction, const F& f) {
  double left_m = fraction * Length(curve);
  bool found = false;
  ForEachPiece(curve, [&](const auto& piece, double t0, double t1) {
    if (found) return;
    const double length_m = LengthOf(piece);
    found = left_m <= length_m;
    if (found) f(piece, ParameterAtLength(piece, left_m, length_m), t0, t1);
    left_m -= length_m;
  });
}

// ∫ f(jet) dt along the curve, for integrands that are smooth on each span. T is a vector.
template <class T, class F>
T IntegrateSpan(const F& f, double a, double b, const T& whole, double tolerance, int depth) {
  const double middle = 0.5 * (a + b);
  const T left = Gauss16(f, a, middle), right = Gauss16(f, middle, b);
  if (depth <= 0 || !((left + right - whole).norm() > tolerance)) return left + right;
  return IntegrateSpan(f, a, middle, left, tolerance, depth - 1) +
         IntegrateSpan(f, middle, b, right, tolerance, depth - 1);
}

template <class F>
Vec3 IntegrateAlong(const Curve& curve, double scale, const F& of_jet) {
  Vec3 sum = Vec3::Zero();
  auto add = [&](const auto& jet_at, double a, double b) {
    auto f = [&](double t) -> Vec3 { return of_jet(jet_at(t)); };
    sum += IntegrateSpan<Vec3>(f, a, b, Gauss16(f, a, b), 1e-14 * scale, 20);
  };
  ForEachPiece(curve, Overloaded{[&](const BsplineCurve& b, double, double) {
                                   for (const BezierSpan& span : BezierSpansOf(b)) {
                                     add([&](double s) { return JetOf(span.poles, s); }, 0.0, 1.0);
                                   }
                                 },
                                 [&](const auto& piece, double, double) {
                                   for (int i = 0; i < 4; ++i) {
                                     add([&](double t) { return JetOf(piece, t); }, 0.25 * i,
                                         0.25 * (i + 1));
                                   }
                                 }});
  return sum;
}

// Half of ∮ (p − origin) × dp: its length is the enclosed area, its direction the normal about
// which the curve runs counter-clockwise.
Vec3 AreaVector(const Curve& curve, const Vec3& origin) {
  const Box box = BoundingBox(curve);
  const double size = (box.max - box.min).norm();
  // Far from the world's origin coordinates are rounded by more than the size would tell.
  const double scale = size * std::max(size, 0.1 * box.centre().norm());
  Vec3 twofold = Vec3::Zero();
  ForEachPiece(curve, Overloaded{[&](const Line& line, double, double) {
                                   twofold += (line.start - origin).cross(line.end - origin);
                                 },
                                 [&](const Arc& arc, double, double) {
                                   const Vec3 a = JetOf(arc, 0).point, b = JetOf(arc, 1).point;
                                   const double segment = arc.sweep_rad - std::sin(arc.sweep_rad);
                                   twofold += (a - origin).cross(b - origin) +
                                              segment * arc.radius * arc.radius * arc.frame.z();
                                 },
                                 [&](const BsplineCurve& b, double, double) {
                                   twofold += IntegrateAlong(b, scale, [&](const CurveJet& jet) {
                                     return Vec3((jet.point - origin).cross(jet.d1));
                                   });
                                 }});
  return 0.5 * twofold;
}

}  // namespace

double LengthOf(const Line& line) { return (line.end - line.start).norm(); }
double LengthOf(const Arc& arc) { return arc.radius * arc.sweep_rad; }
double LengthOf(const BsplineCurve& curve) {
  double length_m = 0;
  for (const BezierSpan& span : BezierSpansOf(curve)) length_m += LengthOfSpan(span.poles, 1);
  return length_m;
}

double Length(const Curve& curve) {
  double length_m = 0;
  if (!Check(curve)) return 0;
  ForEachPiece(curve, [&](const auto& piece, double, double) { length_m += LengthOf(piece); });
  return length_m;
}

Vec3 PointAtFraction(const Curve& curve, double fraction) {
  if (!(fraction > 0)) return PointAt(curve, 0);
  if (fraction >= 1) return PointAt(curve, 1);
  Vec3 point = PointAt(curve, 1);
  AtFraction(curve, fraction, [&](const auto& piece, double local, double, double) {
    const Vec3 found = JetOf(piece, local).point;
    if (found.allFinite()) point = found;
  });
  return point;
}

double ParameterAtFraction(const Curve& curve, double fraction) {
  if (!(fraction > 0)) return 0;
  double t = 1;
  if (fraction >= 1) return t;
  AtFraction(curve, fraction,
             [&](const auto&, double local, double t0, double t1) { t = t0 + local * (t1 - t0); });
  return t;
}

std::optional<Frame> PlaneOf(const Curve& curve) {
  if (!Check(curve)) return std::nullopt;
  const std::vector<Vec3> points = SpanningPoints(curve);
  const Vec3 start = PointAt(curve, 0);
  Vec3 far = start, normal = Vec3::Zero();
  double reach = 0;
  for (const Vec3& p : points) {
    if ((p - start).norm() > reach) reach = (far = p, (p - start).norm());
  }
  for (const Vec3& p : points) {
    const Vec3 candidate = (far - start).cross(p - start);
    if (candidate.norm() > normal.norm()) normal = candidate;
  }
  const double tolerance_m = kPlanar * std::max(1.0, reach);
  // The normal's length over the reach is the distance of a point from the line to the farthest.
  if (!(normal.norm() > tolerance_m * reach)) return std::nullopt;
  normal.normalize();
  for (const Vec3& p : points) {
    if (std::abs((p - start).dot(normal)) > tolerance_m) return std::nullopt;
  }
  if (AreaVector(curve, start).dot(normal) < 0) normal = -normal;
  Frame frame;
  frame.origin = start;
  const Vec3 tangent = TangentAt(curve, 0);
  const Vec3 along = tangent.isZero() ? Vec3(far - start) : tangent;
  frame.x = (along - along.dot(normal) * normal).normalized();
  frame.y = normal.cross(frame.x);
  return frame;
}

Result<double> EnclosedArea(const Curve& curve) {
  if (auto checked = Check(curve); !checked) return tl::unexpected(checked.error());
  if (const auto* circle = std::get_if<Circle>(&curve))
    return kPi * circle->radius * circle->radius;
  if (!IsClosed(curve)) return tl::unexpected(Error{ErrorCode::kNotClosed, "the curve is open"});
  const std::optional<Frame> plane = PlaneOf(curve);
  if (!plane) {
    // What goes forth and back along a line lies in many planes.
    const Box box = BoundingBox(curve);
    const double widest_m2 = (box.max - box.min).squaredNorm();
    if (AreaVector(curve, box.min).norm() <= 1e-12 * widest_m2) {
      return tl::unexpected(Error{ErrorCode::kDegenerate, "the curve encloses no area"});
    }
    return tl::unexpected(Error{ErrorCode::kNotPlanar, "the curve does not lie in one plane"});
  }
  return std::abs(AreaVector(curve, plane->origin).dot(plane->z()));
}

Result<Vec3> Centroid(const Curve& curve) {
  const Result<double> area = EnclosedArea(curve);
  if (!area) return tl::unexpected(area.error());
  const Frame plane = *PlaneOf(curve);
  const Box box = BoundingBox(curve);
  const double size = (box.max - box.min).norm();
  if (!(*area > 1e-14 * size * size)) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "the curve encloses no area"});
  }
  // Green: ∫ x dA = ½ ∮ x² dy and ∫ y dA = −½ ∮ y² dx.
  const Vec3 moment = IntegrateAlong(curve, size * size * size, [&](const CurveJet& jet) -> Vec3 {
    const Vec3 p = plane.ToLocal(jet.point);
    return {0.5 * p.x() * p.x() * jet.d1.dot(plane.y), -0.5 * p.y() * p.y() * jet.d1.dot(plane.x),
            0};
  });
  return plane.ToWorld(moment / *area);
}

}  // namespace tranos::geom
