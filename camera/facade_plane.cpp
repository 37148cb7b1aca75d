// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/facade_plane.h"

#include <Eigen/LU>

namespace tranos::camera {

Vec2 FacadePlane::Meet(const View& view, const Vec2& dot_px) const {
  const Mat3 dot_from_direction = view.dot_from_camera * view.camera_from_world;
  const Vec3 ray = dot_from_direction.inverse() * dot_px.homogeneous();
  const double reach = (distance_m - away().dot(view.position_m)) / away().dot(ray);
  const Vec3 point = view.position_m + reach * ray;
  return {point.dot(right()), point.z()};
}

double TurnOf(const RatioTrace& trace) {
  const Vec2 first = trace.dots_px[1] - trace.dots_px[0];
  const Vec2 second = trace.dots_px[3] - trace.dots_px[2];
  return first.x() * second.y() - first.y() * second.x() < 0 ? 1 : -1;
}

PlaneCircle FitCircle(const std::vector<Vec2>& points) {
  // About the mean, for the sake of rounding: p² = 2 c·p + k.
  Vec2 mean = Vec2::Zero();
  for (const Vec2& p : points) mean += p / static_cast<double>(points.size());
  Mat3 normal = Mat3::Zero();
  Vec3 right = Vec3::Zero();
  for (const Vec2& p : points) {
    const Vec2 d = p - mean;
    const Vec3 row(2 * d.x(), 2 * d.y(), 1);
    normal += row * row.transpose();
    right += d.squaredNorm() * row;
  }
  const Vec3 x = normal.fullPivLu().solve(right);
  const Vec2 centre = x.head<2>();
  return {mean + centre, std::sqrt(std::max(0.0, x.z() + centre.squaredNorm()))};
}

namespace {

// How far what the plane shows is from the shape it should be, without regard to size; and, of a
// rectangle, how many times too large it is.
struct Likeness {
  double misfit = 0;
  double scale = 0;
};

Likeness LikenessOf(const FacadePlane& plane, const OnFacade& item, const Numbers& numbers) {
  const auto at = [&](const Vec2& dot) { return plane.Meet(*item.view, dot); };
  if (const auto* rectangle = std::get_if<RectangleTrace>(item.trace)) {
    const Vec2 p[4] = {at(rectangle->dots_px[0]), at(rectangle->dots_px[1]),
                       at(rectangle->dots_px[2]), at(rectangle->dots_px[3])};
    const double a = numbers.values[rectangle->a], b = numbers.values[rectangle->b];
    Eigen::Matrix<double, 8, 1> shown, stated;
    shown << p[1] - p[0], p[2] - p[3], p[3] - p[0], p[2] - p[1];
    stated << a, 0, a, 0, 0, b, 0, b;
    const double scale = shown.dot(stated) / stated.squaredNorm();
    return {(shown - scale * stated).squaredNorm() / shown.squaredNorm(), scale};
  }
  if (const auto* ratio = std::get_if<RatioTrace>(item.trace)) {
    const Vec2 first = at(ratio->dots_px[1]) - at(ratio->dots_px[0]);
    const Vec2 second = at(ratio->dots_px[3]) - at(ratio->dots_px[2]);
    const Vec2 meant = TurnOf(*ratio) / numbers.values[ratio->ratio] * Vec2(-first.y(), first.x());
    return {(second - meant).squaredNorm() / (second.squaredNorm() + meant.squaredNorm())};
  }
  const auto& circle = std::get<CircleTrace>(*item.trace);
  std::vector<Vec2> points;
  for (const Vec2& dot : circle.dots_px) points.push_back(at(dot));
  const PlaneCircle fit = FitCircle(points);
  double sum = 0;
  for (const Vec2& p : points) {
    const double off = (p - fit.centre).norm() / fit.radius - 1;
    sum += off * off;
  }
  return {sum / static_cast<double>(points.size())};
}

bool IsBefore(const FacadePlane& plane, const OnFacade& item) {
  const View& view = *item.view;
  // The facade's outside faces the camera when `away` leads away from it, and its dots' rays, which
  // have depth 1, must reach it forward.
  const Mat3 direction_from_dot = (view.dot_from_camera * view.camera_from_world).inverse();
  const auto forward = [&](const Vec2& dot) {
    return plane.away().dot(direction_from_dot * dot.homogeneous()) > 1e-6;
  };
  return std::visit(
      [&](const auto& trace) {
        if constexpr (requires { trace.dots_px; }) {
          for (const Vec2& dot : trace.dots_px) {
            if (!forward(dot)) return false;
          }
        }
        return true;
      },
      *item.trace);
}

}  // namespace

FacadePlane LikelyPlane(std::span<const OnFacade> items, const Numbers& numbers) {
  constexpr double kReach_m = 10;
  FacadePlane best;
  double least = std::numeric_limits<double>::infinity();
  for (int degrees = -180; degrees < 180; degrees += 2) {
    FacadePlane plane{degrees * kPi / 180, 0};
    const double foot = plane.away().dot(items[0].view->position_m);
    plane.distance_m = foot + kReach_m;
    double misfit = 0, scale = 0;
    for (const OnFacade& item : items) {
      const Likeness likeness = IsBefore(plane, item)
                                    ? LikenessOf(plane, item, numbers)
                                    : Likeness{std::numeric_limits<double>::infinity()};
      misfit += likeness.misfit;
      if (scale == 0 && item.view == items[0].view) scale = likeness.scale;
    }
    if (!(misfit < least)) continue;
    least = misfit;
    best = plane;
    if (scale > 0) best.distance_m = foot + kReach_m / scale;
  }
  return best;
}

}  // namespace tranos::camera
