// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/drawing.h"

#include <Eigen/LU>
#include <Eigen/QR>

#include "camera/residuals.h"

namespace tranos::camera {

using geom::Error;
using geom::ErrorCode;

namespace {

// The sine of the angle between ray and plane below which they count as parallel.
constexpr double kParallel = 1e-6;
// The same of edges that tell no direction or length.
constexpr double kLevel = 1e-3;

}  // namespace

Vec3 RayOf(const Camera& camera, const Frame& frame, const Vec2& dot_px) {
  const View view = ViewOf(camera.parameters, frame);
  const Mat3 dot_from_direction = view.dot_from_camera * view.camera_from_world;
  return (dot_from_direction.inverse() * dot_px.homogeneous()).normalized();
}

geom::Result<Vec3> LevelDirection(const Camera& camera, const Frame& frame, const ImageLine& line) {
  const Vec3 from = RayOf(camera, frame, line.a_px), to = RayOf(camera, frame, line.b_px);
  const Vec3 back_projected = from.cross(to).normalized();  // the normal of Aᵀ = lᵀP
  const Vec3 along = back_projected.cross(Vec3::UnitZ());
  if (along.norm() <= kLevel) {
    return tl::unexpected(Error{ErrorCode::kDegenerate,
                                "the edge is at the camera's height, where all horizontal edges "
                                "are seen alike"});
  }
  return Vec3(along.normalized() * (along.dot(to - from) < 0 ? -1 : 1));
}

geom::Result<Vec3> BeginningOf(const Camera& camera, const Frame& frame, const ImageLine& line,
                               const Vec3& along, double length_m) {
  const Vec3 from = RayOf(camera, frame, line.a_px), to = RayOf(camera, frame, line.b_px);
  if (along.cross(from).norm() <= kLevel || from.cross(to).norm() <= kParallel) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "the edge is seen end-on"});
  }
  Eigen::Matrix<double, 3, 2> rays;  // λ_a a + length · along = λ_b b
  rays << from, -to;
  const Vec2 reach_m = rays.colPivHouseholderQr().solve(-length_m * along);
  return Vec3(camera.position_m() + reach_m[0] * from);
}

geom::Result<double> LengthAlong(const Camera& camera, const Frame& frame, const Vec3& from_m,
                                 const Vec3& along, const Vec2& dot_px) {
  const Vec3 ray = RayOf(camera, frame, dot_px), from = from_m - camera.position_m();
  const double cosine = ray.dot(along), square = ray.cross(along).squaredNorm();
  if (square <= kLevel * kLevel) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "the edge is seen end-on"});
  }
  const double length_m = (cosine * ray.dot(from) - along.dot(from)) / square;
  if (ray.dot(from + length_m * along) <= 0) {
    return tl::unexpected(Error{ErrorCode::kOutOfRange, "the edge would end behind the camera"});
  }
  return length_m;
}

geom::Result<DrawnPoint> DrawOnto(const Camera& camera, const Frame& frame,
                                  const geom::Frame& plane, const Vec2& dot_px) {
  const View view = ViewOf(camera.parameters, frame);
  const Vec3 ray = RayOf(camera, frame, dot_px);
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
