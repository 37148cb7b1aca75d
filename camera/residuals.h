// SPDX-License-Identifier: GPL-3.0-or-later
// How far each traced thing is from where a camera puts it, in standard deviations, with exact
// derivatives by the camera's parameters and by the points in space that it stands on.
//
// Every residual is a function of homogeneous dots h = A R (X − C), with A the camera's matrix to
// dots. Its derivative by h is written down for each kind of trace; `ByCamera` and `ByPoint` carry
// it on, so that one place knows how dots depend on the camera.
#pragma once

#include <array>
#include <span>

#include "camera/image_line.h"

namespace tranos::camera {

using CameraRow = Eigen::Matrix<double, 1, kParameters>;

// A camera made ready to put points where its dots are.
struct View {
  Mat3 dot_from_camera;
  Mat3 camera_from_world;
  Mat3 by_omega, by_phi;  // derivatives of camera_from_world; κ's is a quarter turn of it
  Vec3 position_m;
  // Derivatives of dot_from_camera, where they are not zero.
  double focal_11, focal_12, focal_22, aspect_22, principal_13, principal_23, skew_12;
};
View ViewOf(const ParameterVector&, const Frame&);

// A point, or a direction, as the camera sees it.
struct Seen {
  Vec3 from_position;  // in the world; m, or a unit vector
  Vec3 in_camera;
  Vec3 dot;  // homogeneous; the third is the depth
  bool is_direction = false;
};

inline Seen See(const View& view, const Vec3& point_in_world_m) {
  Seen seen;
  seen.from_position = point_in_world_m - view.position_m;
  seen.in_camera = view.camera_from_world * seen.from_position;
  seen.dot = view.dot_from_camera * seen.in_camera;
  return seen;
}
// Its homogeneous dot is the direction's vanishing point.
inline Seen SeeDirection(const View& view, const Vec3& direction) {
  Seen seen;
  seen.from_position = direction;
  seen.in_camera = view.camera_from_world * direction;
  seen.dot = view.dot_from_camera * seen.in_camera;
  seen.is_direction = true;
  return seen;
}

// The derivative by the point in the world of what has the derivative `by_dot` by its homogeneous
// dot.
inline Vec3 ByPoint(const View& view, const Vec3& by_dot) {
  return view.camera_from_world.transpose() * (view.dot_from_camera.transpose() * by_dot);
}
// The same by the camera's parameters.
CameraRow ByCamera(const View&, const Seen&, const Vec3& by_dot);

// One whitened residual. Unused points have zero derivatives.
struct Residual {
  double value;
  CameraRow by_camera;
  Vec3 by_point[2];
};

// An edge whose ends in space are known: the observed centre's offset and tilt from the projected
// infinite line, each by its own deviation; positive to the right of the way from → to, y down
// (cuboid.json, "observation").
std::array<Residual, 2> EdgeResiduals(const View&, const ImageLine&, const Vec3& from_m,
                                      const Vec3& to_m);

// An edge of known direction. Of all lines through the vanishing point the likeliest is meant: with
// the vanishing point at D along and E across the observed line, an offset c and a slope k of it
// cost (c/σ_c)² + (kL/σ_t)² and must give c + kD = E, which is least at E²/(σ_c² + D²σ_t²/L²).
// Written homogeneously, it holds at infinity too.
Residual DirectionResidual(const View&, const ImageLine&, const Vec3& direction);

// A control point: x and y of its image less the dot.
std::array<Residual, 2> PointResiduals(const View&, const Vec2& dot_px, double sigma_px,
                                       const Vec3& at_m);

// A dot on a polyline in space: its distance from the nearest point of the image, positive on the
// right of the way along, y down. The nearest point is between vertices `segment` and `segment +
// 1`; it is held while differentiating, which gives the exact derivative, as the distance is least
// there. Segments not wholly before the camera are passed over; −1 where none is left.
struct CurveResidual {
  int segment;
  Residual residual;
};
CurveResidual ResidualOfCurve(const View&, const Vec2& dot_px, double sigma_px,
                              std::span<const Seen> polyline);

// A dot on a circle in space with unit orthogonal axes u and v: its distance from the nearest point
// of the image, by_point[0] the derivative by that point, which is at `angle_rad` from u.
struct CircleResidual {
  double angle_rad;
  Residual residual;
};
CircleResidual ResidualOfCircle(const View&, const Vec2& dot_px, double sigma_px,
                                const Vec3& centre_m, const Vec3& u, const Vec3& v,
                                double radius_m);

}  // namespace tranos::camera
