// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/orthocentre.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace tranos::camera {
namespace {

tl::unexpected<geom::Error> Degenerate(const char* detail) {
  return tl::unexpected(geom::Error{geom::ErrorCode::kDegenerate, detail});
}

}  // namespace

geom::Result<Mat3> CalibrationFromTriangle(const std::array<Vec3, 3>& points) {
  Mat3 altitudes;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Vec3& vertex = points[static_cast<size_t>(i)];
    const Vec3 side =
        points[static_cast<size_t>((i + 1) % 3)].cross(points[static_cast<size_t>((i + 2) % 3)]);
    // Perpendicular to the side, so through the point at infinity of the side's normal.
    const Vec3 altitude = vertex.normalized().cross(Vec3(side.x(), side.y(), 0));
    if (!(altitude.norm() > 1e-12 * side.norm()))
      return Degenerate("the triangle of the vanishing points has no altitudes");
    altitudes.row(i) = altitude.normalized();
  }
  const Eigen::JacobiSVD<Mat3> svd(altitudes, Eigen::ComputeFullV);
  if (!(svd.singularValues()[1] > 1e-9))
    return Degenerate("a vanishing point at infinity leaves the principal point open");
  const Vec3 meet = svd.matrixV().col(2);
  if (!(std::abs(meet.z()) > 1e-12)) return Degenerate("the altitudes meet at infinity");
  const Vec2 principal = meet.hnormalized();
  // f² = −(vᵢ − p)·(vⱼ − p), from the two points farthest from infinity.
  double square = 0, finite = 0;
  for (size_t i = 0; i < 3; ++i) {
    const Vec3 &u = points[i], &v = points[(i + 1) % 3];
    const double weight = u.z() * v.z() / (u.norm() * v.norm());
    if (!(std::abs(weight) > finite)) continue;
    finite = std::abs(weight);
    square = -(u.head<2>() / u.z() - principal).dot(v.head<2>() / v.z() - principal);
  }
  if (!(finite > 1e-18)) return Degenerate("two vanishing points are at infinity");
  if (!(square > 0))
    return Degenerate("the triangle of the vanishing points has an obtuse angle: no real camera");
  const double f = std::sqrt(square);
  Mat3 k;
  k << f, 0, principal.x(), 0, f, principal.y(), 0, 0, 1;
  return k;
}

geom::Result<Camera> CalibrateOrthocentre(const Photograph& photograph, const Numbers& numbers) {
  const ConicRows rows = ConicRowsOf(photograph, numbers);
  const Mat3 to_frame = FrameFromConditioned(photograph.frame);
  std::array<Vec3, 3> points;
  for (size_t i = 0; i < 3; ++i) {
    if (!rows.axes[i]) return Degenerate("three vanishing points are needed, one of each axis");
    // Scaled alike in both directions, and not far from 1.
    points[i] = Vec3(1, to_frame(1, 1) / to_frame(0, 0), 1).asDiagonal() * rows.axes[i]->point;
  }
  const geom::Result<Mat3> k = CalibrationFromTriangle(points);
  if (!k) return tl::unexpected(k.error());
  const Mat3 inverse = k->inverse() * Vec3(1, to_frame(1, 1) / to_frame(0, 0), 1).asDiagonal();
  const geom::Result<ConditionedCamera> camera =
      PoseFromDirections(inverse, rows.points, SpaceTracesOf(photograph, numbers));
  if (!camera) return tl::unexpected(camera.error());
  return CameraOf(*camera, photograph.frame);
}

}  // namespace tranos::camera
