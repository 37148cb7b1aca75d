// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/circle_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "camera/drawing.h"
#include "camera/facade_plane.h"
#include "camera/residuals.h"

namespace tranos::camera {

using geom::Error;
using geom::ErrorCode;

namespace {

// A circle whose radius is less sure than this share of it is none.
constexpr double kMostUncertainRadius = 0.3;

struct Linear {
  Mat3 normal = Mat3::Zero();
  Vec3 slope = Vec3::Zero();
  double chi2 = 0;
  std::vector<double> angles_rad;
};

Linear LineariseCircle(const View& view, const geom::Frame& plane, std::span<const Vec2> dots_px,
                       double sigma_px, const Vec3& circle) {
  Linear at;
  const Vec3 centre = plane.ToWorld({circle.x(), circle.y(), 0});
  for (const Vec2& dot_px : dots_px) {
    const CircleResidual r =
        ResidualOfCircle(view, dot_px, sigma_px, centre, plane.x, plane.y, circle.z());
    const Vec2 out(std::cos(r.angle_rad), std::sin(r.angle_rad));
    const Vec3& by_point = r.residual.by_point[0];
    const Vec2 by_centre(by_point.dot(plane.x), by_point.dot(plane.y));
    const Vec3 row(by_centre.x(), by_centre.y(), by_centre.dot(out));
    at.normal += row * row.transpose();
    at.slope += r.residual.value * row;
    at.chi2 += r.residual.value * r.residual.value;
    at.angles_rad.push_back(r.angle_rad);
  }
  return at;
}

}  // namespace

geom::Result<FittedCircle> FitCircleSeen(const Camera& camera, const Frame& frame,
                                         const geom::Frame& plane, std::span<const Vec2> dots_px,
                                         double sigma_px) {
  if (dots_px.size() < 3) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "a circle has three dots or more"});
  }
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < dots_px.size(); ++i) {
    auto drawn = DrawOnto(camera, frame, plane, dots_px[i]);
    if (!drawn) {
      drawn.error().part = static_cast<int>(i);
      return tl::unexpected(drawn.error());
    }
    points.push_back(plane.ToLocal(drawn->point_m).head<2>());
  }
  const Error on_a_line{ErrorCode::kDegenerate, "the dots lie on one line, within their noise"};
  const PlaneCircle start = FitCircle(points);
  Vec3 circle(start.centre.x(), start.centre.y(), start.radius);
  if (!circle.allFinite() || !(start.radius > 0)) return tl::unexpected(on_a_line);
  const View view = ViewOf(camera.parameters, frame);
  Linear at = LineariseCircle(view, plane, dots_px, sigma_px, circle);
  double damping = 1e-6;
  for (int i = 0; i < 100 && std::isfinite(at.chi2); ++i) {
    Mat3 damped = at.normal;
    damped.diagonal() *= 1 + damping;
    const Vec3 step = -damped.ldlt().solve(at.slope);
    const Vec3 next = circle + step;
    Linear there;
    there.chi2 = std::numeric_limits<double>::infinity();
    if (next.allFinite() && next.z() > 0) {
      there = LineariseCircle(view, plane, dots_px, sigma_px, next);
    }
    if (!(there.chi2 <= at.chi2)) {
      if (damping > 1e12) break;
      damping *= 10;
      continue;
    }
    const double moved = std::sqrt(std::max(0.0, step.dot(at.normal * step)));  // in deviations
    circle = next;
    at = std::move(there);
    damping = std::max(damping / 10, 1e-12);
    if (moved < 1e-9) break;
  }
  const Mat3 covariance = at.normal.inverse();
  if (!covariance.allFinite() || !(covariance(2, 2) >= 0) ||
      !(std::sqrt(covariance(2, 2)) < kMostUncertainRadius * circle.z())) {
    return tl::unexpected(on_a_line);
  }
  return FittedCircle{circle.head<2>(), circle.z(), covariance, at.chi2, std::move(at.angles_rad)};
}

}  // namespace tranos::camera
