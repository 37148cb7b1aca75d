// SPDX-License-Identifier: GPL-3.0-or-later
// Dots scaled so that linear solvers are well conditioned: origin in the middle of the picture,
// half its width the unit. Noise that is the same in x and y stays so, and so does the skew angle.
#pragma once

#include "camera/camera.h"
#include "camera/image_line.h"

namespace tranos::camera {

struct Conditioning {
  Vec2 centre_px;
  double scale_px;

  Vec2 PointFromDot(const Vec2& dot_px) const { return (dot_px - centre_px) / scale_px; }
  Vec2 DotFromPoint(const Vec2& point) const { return scale_px * point + centre_px; }
  // The line of conditioned points where `line` is the line of dots; (l₁, l₂) stays a unit vector.
  Vec3 LineFromImageLine(const Vec3& line) const {
    return {line.x(), line.y(), (line.z() + line.head<2>().dot(centre_px)) / scale_px};
  }
};

inline Conditioning ConditioningOf(const Frame& frame) {
  return {frame.centre_px(), 0.5 * frame.size_px.x()};
}

// Homogeneous conditioned points to points of the frame in mm; diagonal, so that it takes a matrix
// K to a matrix K.
inline Mat3 FrameFromConditioned(const Frame& frame) {
  const Vec2 scale = ConditioningOf(frame).scale_px * frame.pitch_mm();
  return Vec3(scale.x(), scale.y(), 1).asDiagonal();
}

}  // namespace tranos::camera
