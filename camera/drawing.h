// SPDX-License-Identifier: GPL-3.0-or-later
// Drawing through a photograph: where the ray of a dot meets a plane in space, and how that point
// moves with everything it comes from.
#pragma once

#include "camera/camera.h"
#include "camera/image_line.h"

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

// The unit vector in the world towards what is seen at the dot.
Vec3 RayOf(const Camera&, const Frame&, const Vec2& dot_px);

// The direction in the world of a horizontal edge that is seen along the line, from its a to its b
// as they are seen. Error kDegenerate: the edge is at the camera's height, where all are seen
// alike.
geom::Result<Vec3> LevelDirection(const Camera&, const Frame&, const ImageLine&);

// Where an edge of this direction and length, seen from the line's a to its b, begins (Lemma 9: the
// length gives λ). Error kDegenerate: it is seen end-on.
geom::Result<Vec3> BeginningOf(const Camera&, const Frame&, const ImageLine&, const Vec3& along,
                               double length_m);

// How far an edge that begins at a point and runs along a unit vector goes until it is seen at the
// dot; negative against that way. Where it passes the ray by, the nearest point is meant. Errors:
// kDegenerate: it is seen end-on; kOutOfRange: that is behind the camera.
geom::Result<double> LengthAlong(const Camera&, const Frame&, const Vec3& from_m, const Vec3& along,
                                 const Vec2& dot_px);

}  // namespace tranos::camera
