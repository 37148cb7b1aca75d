// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/view.h"

#include <algorithm>

namespace tranos::output {

geom::Affine Camera::picture_from_world() const {
  Eigen::Matrix3d rows;
  rows << frame.x.transpose(), frame.y.transpose(), frame.z().transpose();
  geom::Affine result;
  result.linear() = rows / pixel_m;
  result.translation() = -(result.linear() * frame.origin);
  return result;
}

Camera FitCamera(const geom::Frame& directions, const geom::Box& box_in_view, int width_px,
                 int height_px) {
  const geom::Vec3 centre = box_in_view.empty() ? geom::Vec3::Zero() : box_in_view.centre();
  const geom::Vec3 extent =
      box_in_view.empty() ? geom::Vec3::Zero() : geom::Vec3(box_in_view.max - box_in_view.min);
  Camera camera;
  camera.frame = directions;
  camera.frame.origin =
      centre.x() * directions.x + centre.y() * directions.y + centre.z() * directions.z();
  camera.width_px = width_px;
  camera.height_px = height_px;
  const double inner = 1 - 2 * kMargin;
  camera.pixel_m = std::max(extent.x() / (inner * width_px), extent.y() / (inner * height_px));
  if (!(camera.pixel_m > 1e-12)) camera.pixel_m = 1 / (inner * std::max(width_px, 1));
  return camera;
}

}  // namespace tranos::output
