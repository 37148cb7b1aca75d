// SPDX-License-Identifier: GPL-3.0-or-later
// Every curve is a row of lines, arcs and B-splines. What is summed, joined or compared over a
// curve is done over these three kinds of piece. Internal to geom.
#pragma once

#include <algorithm>
#include <cmath>

#include "geom/arc.h"
#include "geom/bezier.h"
#include "geom/curve.h"

namespace tranos::geom {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

inline std::size_t PieceCount(const Polyline& p) {
  if (p.vertices.size() < 2) return p.vertices.size();
  return p.closed ? p.vertices.size() : p.vertices.size() - 1;
}
inline Line PieceOf(const Polyline& p, std::size_t i) {
  return {p.vertices[i], p.vertices[(i + 1) % p.vertices.size()]};
}

// Calls visit(piece, t0, t1) for each Line, Arc and BsplineCurve in order, over the natural
// parameters from t0 to t1 of the whole curve.
template <class Visit>
void ForEachPiece(const Polyline& p, double t0, double t1, const Visit& visit) {
  const std::size_t count = PieceCount(p);
  const double step = (t1 - t0) / static_cast<double>(std::max<std::size_t>(count, 1));
  for (std::size_t i = 0; i < count; ++i) {
    const double from = t0 + step * static_cast<double>(i);
    visit(PieceOf(p, i), from, i + 1 == count ? t1 : from + step);
  }
}
template <class Visit>
void ForEachPiece(const Line& line, double t0, double t1, const Visit& visit) {
  visit(line, t0, t1);
}
template <class Visit>
void ForEachPiece(const Arc& arc, double t0, double t1, const Visit& visit) {
  visit(arc, t0, t1);
}
template <class Visit>
void ForEachPiece(const Circle& circle, double t0, double t1, const Visit& visit) {
  visit(FullTurn(circle), t0, t1);
}
template <class Visit>
void ForEachPiece(const BsplineCurve& b, double t0, double t1, const Visit& visit) {
  visit(b, t0, t1);
}
template <class Visit>
void ForEachPiece(const Chain& chain, double t0, double t1, const Visit& visit) {
  const double count = static_cast<double>(std::max<std::size_t>(chain.segments.size(), 1));
  for (std::size_t i = 0; i < chain.segments.size(); ++i) {
    const double from = t0 + (t1 - t0) * (static_cast<double>(i) / count);
    const double to = t0 + (t1 - t0) * (static_cast<double>(i + 1) / count);
    std::visit([&](const auto& s) { ForEachPiece(s, from, to, visit); }, chain.segments[i]);
  }
}
template <class Visit>
void ForEachPiece(const Curve& curve, const Visit& visit) {
  std::visit([&](const auto& c) { ForEachPiece(c, 0.0, 1.0, visit); }, curve);
}

// The index of the part of `count` equal parts that holds t in [0, 1], and t within that part.
inline std::pair<std::size_t, double> PartAt(double t, std::size_t count) {
  const double scaled = t * static_cast<double>(count);
  const auto index = std::min(static_cast<std::size_t>(scaled), count - 1);
  return {index, std::clamp(scaled - static_cast<double>(index), 0.0, 1.0)};
}

// Position and derivatives of a piece at its own parameter in [0, 1], by that parameter.
CurveJet JetOf(const Line&, double t);
CurveJet JetOf(const Arc&, double t);
CurveJet JetOf(const BsplineCurve&, double t);
// Of a whole curve; the derivatives are by the piece's own parameter, so only their
// directions mean something.
CurveJet JetOf(const Curve&, double t);

double LengthOf(const Line&);
double LengthOf(const Arc&);
double LengthOf(const BsplineCurve&);

Box BoxOf(const Line&);
inline Box BoxOf(const Arc& arc) { return BoxOfArc(arc); }
Box BoxOf(const BsplineCurve&);

Nearest NearestOn(const Line&, const Vec3& p);
inline Nearest NearestOn(const Arc& arc, const Vec3& p) { return NearestOnArc(arc, p); }
Nearest NearestOn(const BsplineCurve&, const Vec3& p);

inline std::vector<BezierSpan> BezierSpansOf(const Line& line) {
  BezierSpan span;
  span.poles.resize(4, 2);
  span.poles.col(0) = Homogeneous(line.start, 1);
  span.poles.col(1) = Homogeneous(line.end, 1);
  return {span};
}

inline Curve ToCurve(const Segment& segment) {
  return std::visit([](const auto& s) { return Curve(s); }, segment);
}

}  // namespace tranos::geom
