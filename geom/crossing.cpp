// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/crossing.h"

#include <algorithm>
#include <cmath>

#include "geom/crossing_spans.h"
#include "geom/curve_pieces.h"

namespace tranos::geom {
namespace {

// A piece of a curve over the natural parameters [t0, t1], in a box.
struct Piece {
  std::variant<Line, Arc, BsplineCurve> shape;
  double t0, t1;
  Box box;
};

std::vector<Piece> PiecesOf(const Curve& curve) {
  std::vector<Piece> pieces;
  if (!Check(curve)) return pieces;
  ForEachPiece(curve, [&](const auto& shape, double t0, double t1) {
    pieces.push_back({shape, t0, t1, BoxOf(shape)});
  });
  return pieces;
}

bool MayMeet(const Box& a, const Box& b) {
  return ((a.min - b.max).array() <= kMeeting_m).all() &&
         ((b.min - a.max).array() <= kMeeting_m).all();
}

// The piece's parameter at the point, if it lies on the piece.
std::optional<double> ParameterOn(const Piece& piece, const Vec3& p) {
  const Nearest nearest =
      std::visit([&](const auto& shape) { return NearestOn(shape, p); }, piece.shape);
  if (nearest.distance_m > kMeeting_m) return std::nullopt;
  return piece.t0 + nearest.t * (piece.t1 - piece.t0);
}

std::vector<Vec3> Meet(const Line& a, const Line& b) {
  const Vec3 u = a.end - a.start, v = b.end - b.start, w = b.start - a.start;
  const Vec3 normal = u.cross(v);
  const double square = normal.squaredNorm();
  if (!(square > 1e-24 * u.squaredNorm() * v.squaredNorm())) return {};
  if (std::abs(w.dot(normal)) > kMeeting_m * std::sqrt(square)) return {};
  return {a.start + w.cross(v).dot(normal) / square * u};
}

// The points of a circle on the line through `base` along unit `u`, both in the circle's plane.
std::vector<Vec3> OnCircle(const Arc& arc, const Vec3& base, const Vec3& u) {
  const Vec3 foot = base + u.dot(arc.frame.origin - base) * u;
  const double offset = (foot - arc.frame.origin).norm();
  if (offset > arc.radius + kMeeting_m) return {};
  const double half = std::sqrt(std::max(0.0, (arc.radius - offset) * (arc.radius + offset)));
  // Within reach of touching, the two are one point.
  if (std::abs(arc.radius - offset) <= kMeeting_m * kMeeting_m / arc.radius ||
      offset >= arc.radius) {
    return {foot};
  }
  return {foot - half * u, foot + half * u};
}

std::vector<Vec3> Meet(const Line& line, const Arc& arc) {
  const Vec3 u = (line.end - line.start).normalized(), normal = arc.frame.z();
  const double height = normal.dot(line.start - arc.frame.origin), slope = normal.dot(u);
  if (std::abs(slope) > 1e-9) {  // it pierces the circle's plane
    const Vec3 p = line.start - height / slope * u;
    const double off = std::abs((p - arc.frame.origin).norm() - arc.radius);
    return off <= kMeeting_m ? std::vector<Vec3>{p} : std::vector<Vec3>{};
  }
  if (std::abs(height) > kMeeting_m) return {};
  return OnCircle(arc, line.start - height * normal, u);
}
std::vector<Vec3> Meet(const Arc& arc, const Line& line) { return Meet(line, arc); }

std::vector<Vec3> Meet(const Arc& a, const Arc& b) {
  const Vec3 normal = a.frame.z(), other = b.frame.z(), between = b.frame.origin - a.frame.origin;
  if (normal.cross(other).norm() > 1e-9) {
    // Common points lie on the line in which the planes meet.
    const Vec3 along = normal.cross(other).normalized();
    const Vec3 inward = normal.cross(along);
    const Vec3 base = a.frame.origin + other.dot(between) / other.dot(inward) * inward;
    std::vector<Vec3> points;
    for (const Vec3& p : OnCircle(a, base, along)) {
      if (std::abs((p - b.frame.origin).norm() - b.radius) <= kMeeting_m) points.push_back(p);
    }
    return points;
  }
  const double distance = between.norm();
  if (std::abs(normal.dot(between)) > kMeeting_m || distance <= kMeeting_m) return {};
  const double t =
      (distance * distance + (a.radius - b.radius) * (a.radius + b.radius)) / (2 * distance);
  const Vec3 u = between / distance;
  return OnCircle(a, a.frame.origin + t * u, normal.cross(u));
}

// With a B-spline among the two: by halving both.
template <class A, class B>
std::vector<Vec3> Meet(const A& a, const B& b) {
  return MeetBySpans(BezierSpansOf(a), BezierSpansOf(b));
}

void AddCommon(const Piece& a, const Piece& b, std::vector<Crossing>& found) {
  if (!MayMeet(a.box, b.box)) return;
  const auto points =
      std::visit([](const auto& p, const auto& q) { return Meet(p, q); }, a.shape, b.shape);
  for (const Vec3& point : points) {
    const std::optional<double> t_a = ParameterOn(a, point), t_b = ParameterOn(b, point);
    if (t_a && t_b) found.push_back({point, *t_a, *t_b});
  }
}

bool IsNear(const Crossing& a, const Crossing& b) {
  return (a.point - b.point).norm() <= kMeeting_m;
}

}  // namespace

std::vector<Crossing> Crossings(const Curve& a, const Curve& b) {
  const std::vector<Piece> pieces_a = PiecesOf(a), pieces_b = PiecesOf(b);
  std::vector<Crossing> found;
  for (const Piece& piece : pieces_a) {
    for (const Piece& other : pieces_b) AddCommon(piece, other, found);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Crossing& x, const Crossing& y) { return x.t_a < y.t_a; });
  std::vector<Crossing> crossings;
  for (const Crossing& next : found) {  // a corner is found on both of its pieces
    if (crossings.empty() || !IsNear(crossings.back(), next)) crossings.push_back(next);
  }
  if (crossings.size() > 1 && IsNear(crossings.front(), crossings.back())) crossings.pop_back();
  return crossings;
}

std::size_t CountPieces(const Curve& curve) {
  std::size_t count = 0;
  ForEachPiece(curve, [&](const auto&, double, double) { ++count; });
  return count;
}

}  // namespace tranos::geom
