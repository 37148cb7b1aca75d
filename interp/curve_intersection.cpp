// SPDX-License-Identifier: GPL-3.0-or-later
// Common points of curves made of straight pieces and circular arcs.
#include <algorithm>
#include <cmath>

#include "interp/value_support.h"

namespace tranos::interp {

namespace {

using geom::Arc;
using geom::Line;
using geom::Vec3;

constexpr double kReach_m = 1e-6;  // points nearer than this are common

using Piece = std::variant<Line, Arc>;

void AddPieces(const Line& line, std::vector<Piece>& pieces) { pieces.push_back(line); }
void AddPieces(const Arc& arc, std::vector<Piece>& pieces) { pieces.push_back(arc); }
void AddPieces(const geom::Circle& circle, std::vector<Piece>& pieces) {
  pieces.push_back(Arc{circle.frame, circle.radius, 2 * geom::kPi});
}
void AddPieces(const geom::Polyline& polyline, std::vector<Piece>& pieces) {
  const std::size_t count = polyline.vertices.size();
  for (std::size_t i = 0; i + (polyline.closed ? 0 : 1) < count; ++i) {
    pieces.push_back(Line{polyline.vertices[i], polyline.vertices[(i + 1) % count]});
  }
}
void AddPieces(const geom::BsplineCurve&, std::vector<Piece>&) {
  throw OpFailure{Code::kWrongElement,
                  "intersections are found of lines, arcs and circles, and what is made of them"};
}
void AddPieces(const geom::Chain& chain, std::vector<Piece>& pieces) {
  for (const geom::Segment& segment : chain.segments) {
    std::visit([&](const auto& part) { AddPieces(part, pieces); }, segment);
  }
}

std::vector<Piece> PiecesOf(const geom::Curve& curve) {
  std::vector<Piece> pieces;
  std::visit([&](const auto& part) { AddPieces(part, pieces); }, curve);
  return pieces;
}

// A point on a piece, by how far along the piece it lies.
struct Found {
  double along;
  Vec3 point;
};
using FoundPoints = std::vector<Found>;

// Whether the point of the circle lies on the arc, and how far along.
bool IsOnArc(const Arc& arc, const Vec3& p, double* along) {
  const Vec3 local = arc.frame.ToLocal(p);
  double angle = std::atan2(local.y(), local.x());
  if (angle < 0) angle += 2 * geom::kPi;
  const double reach_rad = kReach_m / arc.radius;
  if (angle > 2 * geom::kPi - reach_rad) angle = 0;
  *along = std::min(angle / arc.sweep_rad, 1.0);
  return angle <= arc.sweep_rad + reach_rad;
}

bool IsOnLine(const Line& line, const Vec3& p, double* along) {
  const Vec3 direction = line.end - line.start;
  const double t = direction.dot(p - line.start) / direction.squaredNorm();
  const double reach = kReach_m / direction.norm();
  *along = std::clamp(t, 0.0, 1.0);
  return t >= -reach && t <= 1 + reach;
}

bool IsOn(const Piece& piece, const Vec3& p, double* along) {
  if (const auto* line = std::get_if<Line>(&piece)) return IsOnLine(*line, p, along);
  return IsOnArc(std::get<Arc>(piece), p, along);
}

std::vector<Vec3> Meet(const Line& a, const Line& b) {
  const Vec3 u = a.end - a.start, v = b.end - b.start, w = b.start - a.start;
  const Vec3 normal = u.cross(v);
  const double square = normal.squaredNorm();
  if (!(square > 1e-24 * u.squaredNorm() * v.squaredNorm())) return {};
  if (std::abs(w.dot(normal)) > kReach_m * std::sqrt(square)) return {};
  return {a.start + w.cross(v).dot(normal) / square * u};
}

// The points of a circle on the line through `base` along unit `u`, both in the circle's plane.
std::vector<Vec3> OnCircle(const Arc& arc, const Vec3& base, const Vec3& u) {
  const Vec3 foot = base + u.dot(arc.frame.origin - base) * u;
  const double offset = (foot - arc.frame.origin).norm();
  if (offset > arc.radius + kReach_m) return {};
  const double half = std::sqrt(std::max(0.0, (arc.radius - offset) * (arc.radius + offset)));
  // Within reach of touching, the two are one point.
  if (std::abs(arc.radius - offset) <= kReach_m * kReach_m / arc.radius || offset >= arc.radius) {
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
    return off <= kReach_m ? std::vector<Vec3>{p} : std::vector<Vec3>{};
  }
  if (std::abs(height) > kReach_m) return {};
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
      if (std::abs((p - b.frame.origin).norm() - b.radius) <= kReach_m) points.push_back(p);
    }
    return points;
  }
  const double distance = between.norm();
  if (std::abs(normal.dot(between)) > kReach_m || distance <= kReach_m) return {};
  const double t =
      (distance * distance + (a.radius - b.radius) * (a.radius + b.radius)) / (2 * distance);
  const Vec3 u = between / distance;
  return OnCircle(a, a.frame.origin + t * u, normal.cross(u));
}

void AddCommon(const Piece& a, const Piece& b, double piece_index, FoundPoints& found) {
  const auto points = std::visit([](const auto& p, const auto& q) { return Meet(p, q); }, a, b);
  for (const Vec3& point : points) {
    double along = 0, along_other = 0;
    if (!IsOn(a, point, &along) || !IsOn(b, point, &along_other)) continue;
    found.push_back({piece_index + along, point});
  }
}

}  // namespace

std::vector<geom::Vec3> Intersections(const CallContext& context, const geom::Curve& a,
                                      const geom::Curve& b) {
  const std::vector<Piece> pieces_a = PiecesOf(a), pieces_b = PiecesOf(b);
  context.charge_items(pieces_a.size() * pieces_b.size());
  FoundPoints found;
  for (std::size_t i = 0; i < pieces_a.size(); ++i) {
    for (const Piece& piece : pieces_b)
      AddCommon(pieces_a[i], piece, static_cast<double>(i), found);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Found& x, const Found& y) { return x.along < y.along; });
  std::vector<Vec3> points;
  const auto is_near = [](const Vec3& p, const Vec3& q) { return (p - q).norm() <= kReach_m; };
  for (const Found& next : found) {  // a corner is found on both of its pieces
    if (points.empty() || !is_near(points.back(), next.point)) points.push_back(next.point);
  }
  if (points.size() > 1 && is_near(points.front(), points.back())) points.pop_back();
  return points;
}

}  // namespace tranos::interp
