// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/camera.h"

#include <algorithm>

namespace tranos::camera {

Mat3 Frame::DotFromFrame() const {
  const Vec2 pitch = pitch_mm(), centre = centre_px();
  Mat3 m;
  m << 1 / pitch.x(), 0, centre.x(), 0, 1 / pitch.y(), centre.y(), 0, 0, 1;
  return m;
}

ProjectionMatrix FrameFromWorld(const Camera& camera) {
  ProjectionMatrix pose;
  pose.leftCols<3>() = CameraFromWorld(camera.parameters);
  pose.col(3) = -pose.leftCols<3>() * camera.position_m();
  return FrameFromCamera(camera.parameters) * pose;
}

ProjectionMatrix DotFromWorld(const Camera& camera, const Frame& frame) {
  return frame.DotFromFrame() * FrameFromWorld(camera);
}

Camera CameraOf(const Mat3& k, const Mat3& r, const Vec3& position_m) {
  // The third row of R is (−cos ω sin φ, cos ω cos φ, sin ω).
  const double omega = std::atan2(r(2, 2), std::hypot(r(2, 0), r(2, 1)));
  const double phi = std::atan2(-r(2, 0), r(2, 1));
  // R takes (cos φ, sin φ, 0) to (cos κ, sin κ, 0): also where ω is 90° and φ may be any angle.
  const Vec3 level = r * Vec3(std::cos(phi), std::sin(phi), 0);
  const double kappa = std::atan2(level.y(), level.x());
  Camera camera;
  camera.parameters << k(0, 0), k(1, 1) / k(0, 0), k(0, 2), k(1, 2), std::atan2(k(0, 0), k(0, 1)),
      omega, phi, kappa, position_m;
  return camera;
}

Image Project(const Camera& camera, const Vec3& point_in_world_m) {
  const Vec3 x = FrameFromWorld(camera) * point_in_world_m.homogeneous();
  return {x.hnormalized(), x.z()};
}

}  // namespace tranos::camera
