// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/arc.h"

#include <algorithm>
#include <cmath>

namespace tranos::geom {
namespace {

constexpr double kCollinearSine = 1e-10;

Frame FrameOf(const Vec3& centre, const Vec3& x_direction, const Vec3& normal) {
  Frame frame;
  frame.origin = centre;
  frame.x = x_direction.normalized();
  frame.y = normal.cross(x_direction).normalized();
  return frame;
}

double Positive(double angle_rad) { return angle_rad > 0 ? angle_rad : angle_rad + 2 * kPi; }

}  // namespace

CosSin ExactCosSin(double angle_rad) {
  const double quarters = angle_rad / (0.5 * kPi);
  const double whole = std::round(quarters);
  if (std::abs(quarters - whole) <= 4e-16 * std::max(1.0, std::abs(whole)) &&
      std::abs(whole) < 1e9) {
    switch (static_cast<long>(whole) & 3) {
      case 0:
        return {1, 0};
      case 1:
        return {0, 1};
      case 2:
        return {-1, 0};
      default:
        return {0, -1};
    }
  }
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

double PartsOf(double whole, double part) {
  return std::max(1.0, std::ceil(whole / part * (1 - 1e-12)));
}

Vec3 PointAtAngle(const Arc& arc, double angle_rad) {
  const CosSin at = ExactCosSin(angle_rad);
  return arc.frame.origin + arc.radius * (at.cos * arc.frame.x + at.sin * arc.frame.y);
}

double AngleOf(const Frame& frame, const Vec3& p) {
  const Vec3 d = p - frame.origin;
  const double angle = std::atan2(d.dot(frame.y), d.dot(frame.x));
  return angle < 0 ? angle + 2 * kPi : angle;
}

Box BoxOfArc(const Arc& arc) {
  Box box;
  box.Add(PointAtAngle(arc, 0));
  box.Add(PointAtAngle(arc, arc.sweep_rad));
  for (int axis = 0; axis < 3; ++axis) {
    const double x = arc.frame.x[axis], y = arc.frame.y[axis];
    const double crest = std::atan2(y, x);
    const double reach = arc.radius * std::hypot(x, y);
    for (const double side : {1.0, -1.0}) {
      double angle = side > 0 ? crest : crest + kPi;
      if (angle < 0) angle += 2 * kPi;
      if (angle > arc.sweep_rad) continue;
      const double value = arc.frame.origin[axis] + side * reach;
      box.min[axis] = std::min(box.min[axis], value);
      box.max[axis] = std::max(box.max[axis], value);
    }
  }
  return box;
}

Nearest NearestOnArc(const Arc& arc, const Vec3& p) {
  const double angle = AngleOf(arc.frame, p);
  double t = arc.sweep_rad > 0 ? angle / arc.sweep_rad : 0;
  if (angle > arc.sweep_rad) {
    const double start_m = (PointAtAngle(arc, 0) - p).squaredNorm();
    t = (PointAtAngle(arc, arc.sweep_rad) - p).squaredNorm() < start_m ? 1 : 0;
  }
  Nearest nearest;
  nearest.t = t;
  nearest.point = PointAtAngle(arc, t * arc.sweep_rad);
  nearest.distance_m = (nearest.point - p).norm();
  return nearest;
}

Arc ReversedArc(const Arc& arc) {
  const CosSin end = ExactCosSin(arc.sweep_rad);
  Arc reversed = arc;
  reversed.frame.x = end.cos * arc.frame.x + end.sin * arc.frame.y;
  reversed.frame.y = end.sin * arc.frame.x - end.cos * arc.frame.y;
  return reversed;
}

Result<Arc> ArcThrough(const Vec3& start, const Vec3& on, const Vec3& end) {
  const Vec3 a = on - start, b = end - start;
  const Vec3 n = a.cross(b);
  const double sine = n.norm() / (a.norm() * b.norm());
  if (!(sine > kCollinearSine) || !((end - on).norm() > 0) || !n.allFinite()) {
    return tl::unexpected(
        Error{ErrorCode::kDegenerate, "the three points of the arc coincide or are collinear"});
  }
  const Vec3 offset =
      (a.squaredNorm() * b.cross(n) + b.squaredNorm() * n.cross(a)) / (2 * n.squaredNorm());
  Arc arc{FrameOf(start + offset, -offset, n), offset.norm(), 0};
  arc.sweep_rad = Positive(AngleOf(arc.frame, end));
  if (!arc.frame.origin.allFinite() || !std::isfinite(arc.radius)) {
    return tl::unexpected(Error{ErrorCode::kOutOfRange, "the arc's centre is too far away"});
  }
  return arc;
}

Result<Arc> ArcAround(const Vec3& centre, const Vec3& start, const Vec3& end, const Vec3& normal) {
  const Vec3 to_start = start - centre, to_end = end - centre;
  const Vec3 x = to_start.normalized();
  const Vec3 upright = normal.normalized();
  // The start is taken as it is, so the axis gives way where it is not square to the radius.
  const Vec3 z = (upright - upright.dot(x) * x).normalized();
  const bool sound = z.allFinite() && to_start.allFinite() && to_end.allFinite();
  if (!sound || !(to_start.norm() > 0) || !(z.norm() > 0.5) ||
      !(to_end.cross(z).norm() > kCollinearSine * to_end.norm())) {
    return tl::unexpected(Error{ErrorCode::kDegenerate,
                                "the arc has no radius, or its start or end lies on its axis"});
  }
  Arc arc{FrameOf(centre, x, z), to_start.norm(), 0};
  arc.sweep_rad = Positive(AngleOf(arc.frame, end));
  return arc;
}

}  // namespace tranos::geom
