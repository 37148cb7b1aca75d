// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/drawing.h"

#include <Eigen/LU>

#include "camera/residuals.h"

namespace tranos::camera {

using geom::Error;
using geom::ErrorCode;

namespace {

// The sine of the angle between ray and plane below which they count as parallel.
constexpr double kParallel = 1e-6;

}  // namespace

geom::Result<DrawnPoint> DrawOnto(const Camera& camera, const Frame& frame,
                                  const geom::Frame& plane, const Vec2& dot_px) {
  const View view = ViewOf(camera.parameters, frame);
  const Mat3 dot_from_direction = view.dot_from_camera * view.camera_from_world;
  const Vec3 ray = (dot_from_direction.inverse() * dot_px.homogeneous()).normalized();
  const Vec3 normal = plane.z();
  const double along = normal.dot(ray), height_m = normal.dot(plane.origin - view.position_m);
  if (std::abs(height_m) <= geom::kCoincident_m) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "the camera stands in its plane"});
  }
  if (std::abs(along) <= kParallel) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "the dot lies on its horizon"});
  }
  if (height_m / along < 0) {
    return tl::unexpected(Error{ErrorCode::kOutOfRange,
                                "the dot lies beyond its horizon, where its plane is behind the "
                                "camera"});
  }
  DrawnPoint drawn;
  drawn.point_m = view.position_m + height_m / along * ray;
  Mat3 by_point;
  Eigen::Matrix<double, 2, kParameters> by_camera;
  const auto image = PointResiduals(view, dot_px, 1, drawn.point_m);
  for (int i = 0; i < 2; ++i) {
    by_point.row(i) = image[static_cast<std::size_t>(i)].by_point[0].transpose();
    by_camera.row(i) = image[static_cast<std::size_t>(i)].by_camera;
  }
  by_point.row(2) = normal.transpose();
  const Mat3 point_by = by_point.inverse();
  drawn.by_camera = -point_by.leftCols<2>() * by_camera;
  drawn.by_dot = point_by.leftCols<2>();
  drawn.by_offset = point_by.col(2);
  return drawn;
}

}  // namespace tranos::camera
