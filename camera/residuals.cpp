// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/residuals.h"

#include <algorithm>

namespace tranos::camera {

View ViewOf(const ParameterVector& p, const Frame& frame) {
  const double cw = std::cos(p[kOmega]), sw = std::sin(p[kOmega]);
  const double cp = std::cos(p[kPhi]), sp = std::sin(p[kPhi]);
  const double ck = std::cos(p[kKappa]), sk = std::sin(p[kKappa]);
  const double sine = std::sin(p[kSkew]), cotangent = std::cos(p[kSkew]) / sine;
  // Rows of Rx(−ω) Ry(φ) B, and the derivative of the first by φ.
  const Eigen::RowVector3d x(cp, sp, 0), x_by_phi(-sp, cp, 0);
  const Eigen::RowVector3d y(-sw * sp, sw * cp, -cw), z(-cw * sp, cw * cp, sw);
  View view;
  view.camera_from_world << ck * x - sk * y, sk * x + ck * y, z;
  view.by_omega << -sk * z, ck * z, -y;
  view.by_phi << ck * x_by_phi + sk * sw * x, sk * x_by_phi - ck * sw * x, -cw * x;
  view.position_m = p.tail<3>();
  const Vec2 per_mm = frame.pitch_mm().cwiseInverse(), centre = frame.centre_px();
  const double f = p[kFocal], r = p[kAspect];
  view.dot_from_camera << f * per_mm.x(), f * cotangent * per_mm.x(),
      p[kPrincipalX] * per_mm.x() + centre.x(),                         //
      0, r * f * per_mm.y(), p[kPrincipalY] * per_mm.y() + centre.y(),  //
      0, 0, 1;
  view.focal_11 = per_mm.x();
  view.focal_12 = cotangent * per_mm.x();
  view.focal_22 = r * per_mm.y();
  view.aspect_22 = f * per_mm.y();
  view.principal_13 = per_mm.x();
  view.principal_23 = per_mm.y();
  view.skew_12 = -f * per_mm.x() / (sine * sine);
  return view;
}

CameraRow ByCamera(const View& view, const Seen& seen, const Vec3& by_dot) {
  const Vec3& y = seen.in_camera;
  const Vec3 by_camera = view.dot_from_camera.transpose() * by_dot;
  CameraRow row;
  row[kFocal] = by_dot.x() * (view.focal_11 * y.x() + view.focal_12 * y.y()) +
                by_dot.y() * view.focal_22 * y.y();
  row[kAspect] = by_dot.y() * view.aspect_22 * y.y();
  row[kPrincipalX] = by_dot.x() * view.principal_13 * y.z();
  row[kPrincipalY] = by_dot.y() * view.principal_23 * y.z();
  row[kSkew] = by_dot.x() * view.skew_12 * y.y();
  row[kOmega] = by_camera.dot(view.by_omega * seen.from_position);
  row[kPhi] = by_camera.dot(view.by_phi * seen.from_position);
  row[kKappa] = by_camera.y() * y.x() - by_camera.x() * y.y();
  if (seen.is_direction)
    row.tail<3>().setZero();
  else
    row.tail<3>() = -by_camera.transpose() * view.camera_from_world;
  return row;
}

std::array<Residual, 2> EdgeResiduals(const View& view, const ImageLine& line, const Vec3& from_m,
                                      const Vec3& to_m) {
  const Seen from = See(view, from_m), to = See(view, to_m);
  const Vec3 l = from.dot.cross(to.dot);
  const double scale = 1 / l.head<2>().norm();
  const Vec3 normal(l.x() * scale, l.y() * scale, 0);
  const Vec3 observed[2] = {line.centre_px().homogeneous(),
                            (Vec3() << line.b_px - line.a_px, 0).finished()};
  const double sigma[2] = {line.centre_sigma_px, line.tilt_sigma_px};
  std::array<Residual, 2> residuals;
  for (int i = 0; i < 2; ++i) {
    const double offset = l.dot(observed[i]) * scale;
    const Vec3 by_line = (observed[i] - offset * normal) * (scale / sigma[i]);
    const Vec3 by_from = to.dot.cross(by_line), by_to = by_line.cross(from.dot);
    residuals[i].value = offset / sigma[i];
    residuals[i].by_camera = ByCamera(view, from, by_from) + ByCamera(view, to, by_to);
    residuals[i].by_point[0] = ByPoint(view, by_from);
    residuals[i].by_point[1] = ByPoint(view, by_to);
  }
  return residuals;
}

Residual DirectionResidual(const View& view, const ImageLine& line, const Vec3& direction) {
  const Seen seen = SeeDirection(view, direction);
  const double length = line.length_px(), slope_sigma = line.tilt_sigma_px / length;
  const Vec2 centre = line.centre_px(), along = (line.b_px - line.a_px) / length;
  const Vec2 across(-along.y(), along.x());
  const Vec3 by_along(along.x(), along.y(), -along.dot(centre));
  const Vec3 by_across(across.x(), across.y(), -across.dot(centre));
  const double d = by_along.dot(seen.dot), e = by_across.dot(seen.dot), w = seen.dot.z();
  const double centre_variance = line.centre_sigma_px * line.centre_sigma_px;
  const double slope_variance = slope_sigma * slope_sigma;
  const double variance = w * w * centre_variance + d * d * slope_variance;
  const double deviation = std::sqrt(variance);
  Vec3 by_dot = by_across / deviation - e / (deviation * variance) * d * slope_variance * by_along;
  by_dot.z() -= e / (deviation * variance) * w * centre_variance;
  return {e / deviation, ByCamera(view, seen, by_dot), {Vec3::Zero(), Vec3::Zero()}};
}

namespace {

// n · (the point's image) has this derivative by the homogeneous dot.
Vec3 ByDot(const Vec2& n, const Vec3& dot) {
  return Vec3(n.x(), n.y(), -n.dot(dot.hnormalized())) / dot.z();
}

Residual AcrossImage(const View& view, const Seen& seen, const Vec2& n, double value) {
  const Vec3 by_dot = ByDot(n, seen.dot);
  return {value, ByCamera(view, seen, by_dot), {ByPoint(view, by_dot), Vec3::Zero()}};
}

}  // namespace

std::array<Residual, 2> PointResiduals(const View& view, const Vec2& dot_px, double sigma_px,
                                       const Vec3& at_m) {
  const Seen seen = See(view, at_m);
  const Vec2 r = (seen.dot.hnormalized() - dot_px) / sigma_px;
  return {AcrossImage(view, seen, Vec2(1 / sigma_px, 0), r.x()),
          AcrossImage(view, seen, Vec2(0, 1 / sigma_px), r.y())};
}

CurveResidual ResidualOfCurve(const View& view, const Vec2& dot_px, double sigma_px,
                              std::span<const Seen> polyline) {
  CurveResidual nearest{-1, {0, CameraRow::Zero(), {Vec3::Zero(), Vec3::Zero()}}};
  double least = std::numeric_limits<double>::infinity(), foot = 0;
  Vec2 offset = Vec2::Zero(), along = Vec2::UnitX();
  for (int i = 0; i + 1 < static_cast<int>(polyline.size()); ++i) {
    if (polyline[i].dot.z() <= 0 || polyline[i + 1].dot.z() <= 0) continue;
    const Vec2 a = polyline[i].dot.hnormalized(), b = polyline[i + 1].dot.hnormalized();
    const double squared = (b - a).squaredNorm();
    if (!(squared > 0)) continue;
    const double t = std::clamp((dot_px - a).dot(b - a) / squared, 0.0, 1.0);
    const Vec2 o = dot_px - (a + t * (b - a));
    if (o.squaredNorm() >= least) continue;
    least = o.squaredNorm(), foot = t, offset = o, along = (b - a) / std::sqrt(squared);
    nearest.segment = i;
  }
  if (nearest.segment < 0) return nearest;
  const Vec2 right(-along.y(), along.x());
  const double distance = std::sqrt(least), side = offset.dot(right) < 0 ? -1.0 : 1.0;
  // On the curve itself the way to it has no direction; across the curve is its limit.
  const Vec2 way = distance > 1e-9 ? Vec2(offset * (side / distance)) : right;
  const Vec2 n = -way / sigma_px;
  nearest.residual.value = side * distance / sigma_px;
  const double share[2] = {1 - foot, foot};
  for (int k = 0; k < 2; ++k) {
    const Seen& seen = polyline[nearest.segment + k];
    const Vec3 by_dot = share[k] * ByDot(n, seen.dot);
    nearest.residual.by_camera += ByCamera(view, seen, by_dot);
    nearest.residual.by_point[k] = ByPoint(view, by_dot);
  }
  return nearest;
}

CircleResidual ResidualOfCircle(const View& view, const Vec2& dot_px, double sigma_px,
                                const Vec3& centre_m, const Vec3& u, const Vec3& v,
                                double radius_m) {
  // Where the dot's ray meets the circle's plane is a good first guess of the nearest point.
  const Mat3 world_from_dot = (view.dot_from_camera * view.camera_from_world).inverse();
  const Vec3 ray = world_from_dot * dot_px.homogeneous(), normal = u.cross(v);
  const double reach = normal.dot(centre_m - view.position_m) / normal.dot(ray);
  const Vec3 in_plane = view.position_m + reach * ray - centre_m;
  double angle = std::atan2(v.dot(in_plane), u.dot(in_plane));
  Seen seen;
  Vec2 tangent;
  for (int i = 0; i < 50; ++i) {
    const Vec3 out = std::cos(angle) * u + std::sin(angle) * v;
    const Vec3 turn = std::cos(angle) * v - std::sin(angle) * u;
    seen = See(view, centre_m + radius_m * out);
    const Vec3 moved = view.dot_from_camera * (view.camera_from_world * (radius_m * turn));
    const Vec2 at = seen.dot.hnormalized();
    tangent = (moved.head<2>() - at * moved.z()) / seen.dot.z();
    const double step = tangent.dot(dot_px - at) / tangent.squaredNorm();
    if (!(std::abs(step) > 1e-14)) break;
    angle += std::clamp(step, -0.5, 0.5);
  }
  const Vec2 right = Vec2(-tangent.y(), tangent.x()).normalized();
  const double value = right.dot(dot_px - seen.dot.hnormalized()) / sigma_px;
  return {angle, AcrossImage(view, seen, -right / sigma_px, value)};
}

}  // namespace tranos::camera
