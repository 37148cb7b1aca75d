// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/curve.h"

#include <cmath>

#include "geom/curve_pieces.h"

namespace tranos::geom {
namespace {

tl::expected<void, Error> Refuse(const char* detail) {
  return tl::unexpected(Error{ErrorCode::kOutOfRange, detail});
}

bool InRange(double x) { return std::abs(x) <= kLargestCoordinate_m; }
bool InRange(const Vec3& p) { return InRange(p.x()) && InRange(p.y()) && InRange(p.z()); }

bool IsFrame(const Frame& f) {
  return InRange(f.origin) && std::abs(f.x.norm() - 1) < 1e-6 && std::abs(f.y.norm() - 1) < 1e-6 &&
         std::abs(f.x.dot(f.y)) < 1e-6;
}

tl::expected<void, Error> CheckOne(const Line& line) {
  if (!InRange(line.start) || !InRange(line.end)) return Refuse("a coordinate is not a number");
  return {};
}

tl::expected<void, Error> CheckOne(const Arc& arc) {
  if (!IsFrame(arc.frame)) return Refuse("the arc's frame is not orthonormal");
  if (!(arc.radius >= 0) || !InRange(arc.radius)) return Refuse("the radius is not a length");
  if (!(arc.sweep_rad >= 0 && arc.sweep_rad <= 2 * kPi * (1 + 1e-12))) {
    return Refuse("the sweep is not between zero and a full turn");
  }
  return {};
}

tl::expected<void, Error> CheckOne(const Circle& c) { return CheckOne(FullTurn(c)); }

tl::expected<void, Error> CheckOne(const Polyline& p) {
  if (p.vertices.empty()) return Refuse("it has no vertices");
  for (const Vec3& v : p.vertices) {
    if (!InRange(v)) return Refuse("a coordinate is not a number");
  }
  return {};
}

tl::expected<void, Error> CheckOne(const BsplineCurve& c) {
  if (!HasSoundShape(c)) return Refuse("poles, knots, weights and degree do not fit together");
  for (const Vec3& p : c.poles) {
    if (!InRange(p)) return Refuse("a coordinate is not a number");
  }
  for (const double w : c.weights) {
    if (!(w >= 1e-9 && w <= 1e9)) return Refuse("a weight is not between 1e-9 and 1e9");
  }
  if (!AreClampedKnots(c.knots, c.degree))
    return Refuse("the knots do not ascend or are not clamped");
  return {};
}

tl::expected<void, Error> CheckOne(const Chain& chain) {
  if (chain.segments.empty()) return Refuse("the chain has no segments");
  for (std::size_t i = 0; i < chain.segments.size(); ++i) {
    auto checked = std::visit([](const auto& s) { return CheckOne(s); }, chain.segments[i]);
    if (!checked) {
      checked.error().part = static_cast<int>(i);
      return checked;
    }
  }
  return {};
}

double Clamped(double t) { return t > 0 ? std::min(t, 1.0) : 0.0; }

CurveJet JetIn(const Polyline& p, double t) {
  if (p.vertices.empty()) return {};
  const auto [index, local] = PartAt(t, PieceCount(p));
  return JetOf(PieceOf(p, index), local);
}
CurveJet JetIn(const Circle& c, double t) { return JetOf(FullTurn(c), t); }
CurveJet JetIn(const Line& c, double t) { return JetOf(c, t); }
CurveJet JetIn(const Arc& c, double t) { return JetOf(c, t); }
CurveJet JetIn(const BsplineCurve& c, double t) { return JetOf(c, t); }
CurveJet JetIn(const Chain& chain, double t) {
  if (chain.segments.empty()) return {};
  const auto [index, local] = PartAt(t, chain.segments.size());
  return std::visit([l = local](const auto& s) { return JetIn(s, l); }, chain.segments[index]);
}

Polyline ReversedOne(Polyline p) {
  if (!p.vertices.empty()) std::reverse(p.vertices.begin() + (p.closed ? 1 : 0), p.vertices.end());
  return p;
}
Line ReversedOne(const Line& line) { return {line.end, line.start}; }
Arc ReversedOne(const Arc& arc) { return ReversedArc(arc); }
Circle ReversedOne(Circle c) {
  c.frame.y = -c.frame.y;
  return c;
}
BsplineCurve ReversedOne(BsplineCurve c) {
  if (c.knots.empty()) return c;
  const double ends = c.knots.front() + c.knots.back();
  std::reverse(c.poles.begin(), c.poles.end());
  std::reverse(c.weights.begin(), c.weights.end());
  std::reverse(c.knots.begin(), c.knots.end());
  for (double& knot : c.knots) knot = ends - knot;
  return c;
}
Chain ReversedOne(const Chain& chain) {
  Chain reversed;
  reversed.closed = chain.closed;
  for (auto segment = chain.segments.rbegin(); segment != chain.segments.rend(); ++segment) {
    reversed.segments.push_back(
        std::visit([](const auto& s) { return Segment(ReversedOne(s)); }, *segment));
  }
  return reversed;
}

}  // namespace

bool AreClampedKnots(const std::vector<double>& knots, int degree) {
  const std::size_t p = static_cast<std::size_t>(degree), n = knots.size();
  if (n < 2 * (p + 1)) return false;
  for (std::size_t i = 0; i < n; ++i) {
    if (!InRange(knots[i]) || (i > 0 && !(knots[i - 1] <= knots[i]))) return false;
    // No interior knot may be so often there that the curve could jump.
    if (i > 0 && i + p + 1 < n && !(knots[i] < knots[i + p])) return false;
  }
  const double range = knots.back() - knots.front();
  return range > 0 && knots[p] == knots[0] && knots[n - 1 - p] == knots[n - 1];
}

tl::expected<void, Error> Check(const Curve& curve) {
  return std::visit([](const auto& c) { return CheckOne(c); }, curve);
}

CurveJet JetOf(const Line& line, double t) {
  CurveJet jet;
  jet.point = (1 - t) * line.start + t * line.end;
  jet.d1 = line.end - line.start;
  return jet;
}

CurveJet JetOf(const Arc& arc, double t) {
  const CosSin at = ExactCosSin(t * arc.sweep_rad);
  const Vec3 out = arc.radius * (at.cos * arc.frame.x + at.sin * arc.frame.y);
  CurveJet jet;
  jet.point = arc.frame.origin + out;
  jet.d1 = arc.sweep_rad * arc.radius * (at.cos * arc.frame.y - at.sin * arc.frame.x);
  jet.d2 = -arc.sweep_rad * arc.sweep_rad * out;
  return jet;
}

CurveJet JetOf(const BsplineCurve& curve, double t) {
  if (!HasSoundShape(curve)) return {};
  const BezierSpan span = BezierSpanAt(curve, t);
  const double width = span.end - span.begin;
  CurveJet jet = JetOf(span.poles, std::clamp((t - span.begin) / width, 0.0, 1.0));
  jet.d1 /= width;
  jet.d2 /= width * width;
  return jet;
}

CurveJet JetOf(const Curve& curve, double t) {
  return std::visit([&](const auto& c) { return JetIn(c, Clamped(t)); }, curve);
}

Vec3 PointAt(const Curve& curve, double t) {
  const Vec3 point = JetOf(curve, t).point;
  return point.allFinite() ? point : Vec3::Zero();
}

Vec3 TangentAt(const Curve& curve, double t) {
  const CurveJet jet = JetOf(curve, t);
  double length = jet.d1.norm();
  if (length > 0 && std::isfinite(length)) return jet.d1 / length;
  // A span may start at rest; it then leaves along its second derivative, and arrives against it.
  length = jet.d2.norm();
  if (!(length > 0 && std::isfinite(length))) return Vec3::Zero();
  return (t >= 1 ? -1 : 1) * jet.d2 / length;
}

bool IsClosed(const Curve& curve) {
  if (const auto* p = std::get_if<Polyline>(&curve); p && p->closed) return p->vertices.size() > 2;
  if (const auto* c = std::get_if<Chain>(&curve); c && c->closed) return true;
  if (std::holds_alternative<Circle>(curve)) return true;
  if (std::holds_alternative<Line>(curve) || !Check(curve)) return false;
  const double gap = (PointAt(curve, 0) - PointAt(curve, 1)).norm();
  // A curve that goes nowhere is not closed.
  return gap <= kCoincident_m && Length(curve) > 2 * kCoincident_m;
}

Box BoundingBox(const Curve& curve) {
  Box box;
  if (!Check(curve)) return box;
  ForEachPiece(curve, [&](const auto& piece, double, double) { box.Add(BoxOf(piece)); });
  return box;
}

Curve Reversed(const Curve& curve) {
  return std::visit([](const auto& c) { return Curve(ReversedOne(c)); }, curve);
}

}  // namespace tranos::geom
