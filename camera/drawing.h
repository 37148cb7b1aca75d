// SPDX-License-Identifier: GPL-3.0-or-later
// Drawing through a photograph: where the ray of a dot meets a plane in space, and how that point
// moves with everything it comes from.
#pragma once

#include "camera/camera.h"

namespace tranos::camera {

// A point of a plane, with its first derivatives.
struct DrawnPoint {
  Vec3 point_m;
  Eigen::Matrix<double, 3, kParameters> by_camera;
  Eigen::Matrix<double, 3, 2> by_dot;  // m for each px
  Vec3 by_offset;                      // of the plane along its normal, at the point
};

// How uncertain a drawn point may be, by its distance from the camera.
inline constexpr double kMostUncertain = 0.1;

// Where the dot's ray meets the plane (Lemma 9 carried back). The point is where the image of what
// lies in the plane is the dot, so that its derivatives are those of an implicit function: three
// equations, two of the dot and one of the plane. Errors: kDegenerate where the ray runs along the
// plane or the camera stands in it; kOutOfRange where they meet behind the camera, beyond the
// plane's horizon.
geom::Result<DrawnPoint> DrawOnto(const Camera&, const Frame&, const geom::Frame& plane,
                                  const Vec2& dot_px);

}  // namespace tranos::camera
