// SPDX-License-Identifier: GPL-3.0-or-later
// A camera with the frame that it exposes: what other programs exchange, in their pixels.
#pragma once

#include "camera/camera.h"

namespace tranos::camera {

struct FramedCamera {
  Frame frame;
  Camera camera;
};

inline constexpr double kFilmIfUnknown_mm = 36;  // of the longer side, where no format is stated

// The frame of so many pixels, square, the longer side kFilmIfUnknown_mm long.
Frame FrameOfPixels(const Eigen::Vector2i& size_px);

// K in pixels: directions in the camera to dots.
Mat3 DotFromCamera(const FramedCamera&);

// The camera whose K in pixels, R and position these are, on this frame. K is divided by K₃₃; R is
// replaced by the nearest rotation. Errors: kOutOfRange (no finite numbers; K not upper triangular
// with a positive diagonal; focal lengths, axes or a position beyond what a camera can have; R
// further than 1e-3 from any rotation, or a reflection).
geom::Result<FramedCamera> FramedCameraOf(const Frame& frame, const Mat3& dot_from_camera,
                                          const Mat3& camera_from_world, const Vec3& position_m);

}  // namespace tranos::camera
