// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "geom/curve_pieces.h"

namespace tranos::geom {
namespace {

// Images of unit vectors differ by no more than this where the circle's plane is only turned
// and scaled.
constexpr double kSimilar = 1e-12;

BsplineCurve TransformedOne(BsplineCurve c, const Affine& m) {
  for (Vec3& p : c.poles) p = m * p;
  return c;
}

// The frame's image if its plane is only turned, mirrored and scaled; else nothing.
struct ScaledFrame {
  Frame frame;
  double scale;
};
std::optional<ScaledFrame> ImageOf(const Frame& frame, const Affine& m) {
  const Vec3 x = m.linear() * frame.x, y = m.linear() * frame.y;
  const double scale = x.norm();
  if (!(scale > 0) || std::abs(y.norm() - scale) > kSimilar * scale ||
      std::abs(x.dot(y)) > kSimilar * scale * scale) {
    return std::nullopt;
  }
  ScaledFrame image{frame, scale};
  image.frame.origin = m * frame.origin;
  image.frame.x = x / scale;
  image.frame.y = (y - y.dot(image.frame.x) * image.frame.x).normalized();
  return image;
}

Line TransformedOne(const Line& line, const Affine& m) { return {m * line.start, m * line.end}; }
Polyline TransformedOne(Polyline p, const Affine& m) {
  for (Vec3& v : p.vertices) v = m * v;
  return p;
}
Segment TransformedOne(const Arc& arc, const Affine& m) {
  if (const auto image = ImageOf(arc.frame, m)) {
    return Arc{image->frame, image->scale * arc.radius, arc.sweep_rad};
  }
  return TransformedOne(JoinSpans(BezierSpansOf(arc)), m);
}
Segment TransformedOne(const Circle& circle, const Affine& m) {
  if (const auto image = ImageOf(circle.frame, m)) {
    return Circle{image->frame, image->scale * circle.radius};
  }
  return TransformedOne(JoinSpans(BezierSpansOf(FullTurn(circle))), m);
}

BsplineCurve PolygonThrough(const Polyline& p) {
  BsplineCurve curve;
  curve.poles = p.vertices;
  if (p.closed && p.vertices.size() > 1) curve.poles.push_back(p.vertices.front());
  if (curve.poles.size() == 1) curve.poles.push_back(curve.poles.front());
  curve.knots.push_back(0);
  for (std::size_t i = 0; i < curve.poles.size(); ++i)
    curve.knots.push_back(static_cast<double>(i));
  curve.knots.push_back(curve.knots.back());
  return curve;
}

}  // namespace

Curve Transformed(const Curve& curve, const Affine& m) {
  return std::visit(
      Overloaded{[&](const Chain& chain) -> Curve {
                   Chain image;
                   image.closed = chain.closed;
                   for (const Segment& segment : chain.segments) {
                     image.segments.push_back(std::visit(
                         [&](const auto& s) -> Segment { return TransformedOne(s, m); }, segment));
                   }
                   return image;
                 },
                 [&](const Arc& arc) -> Curve { return ToCurve(TransformedOne(arc, m)); },
                 [&](const Circle& circle) -> Curve { return ToCurve(TransformedOne(circle, m)); },
                 [&](const auto& c) -> Curve { return TransformedOne(c, m); }},
      curve);
}

BsplineCurve ToBspline(const Curve& curve) {
  if (const auto* b = std::get_if<BsplineCurve>(&curve)) return *b;
  if (const auto* p = std::get_if<Polyline>(&curve)) return PolygonThrough(*p);
  std::vector<BezierSpan> spans;
  ForEachPiece(curve, [&](const auto& piece, double, double) {
    for (BezierSpan& span : BezierSpansOf(piece)) spans.push_back(std::move(span));
  });
  return JoinSpans(spans);
}

}  // namespace tranos::geom
