// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/facade_view.h"

#include <limits>

namespace tranos::camera {

Mat3 DotFromPlane(const Camera& camera, const Frame& frame, const geom::Frame& plane) {
  Eigen::Matrix<double, 4, 3> world_from_plane;
  world_from_plane << plane.x, plane.y, plane.origin, 0, 0, 1;
  return DotFromWorld(camera, frame) * world_from_plane;
}

double GroundSampling_m(const Mat3& dot_from_plane, const Vec2& place_m) {
  const Vec3 image = dot_from_plane * place_m.homogeneous();
  if (!(image.z() > 0)) return std::numeric_limits<double>::infinity();
  const Vec2 dot = image.hnormalized();
  // Dots for each metre, and of it the smaller singular value.
  const Eigen::Matrix2d by_place =
      (dot_from_plane.topLeftCorner<2, 2>() - dot * dot_from_plane.bottomLeftCorner<1, 2>()) /
      image.z();
  const double squares = by_place.squaredNorm(), area = std::abs(by_place.determinant());
  const double root = std::sqrt(std::max(0.0, squares * squares / 4 - area * area));
  // The smaller square as area² over the larger one: no difference of like numbers.
  return std::sqrt(squares / 2 + root) / area;
}

}  // namespace tranos::camera
