// SPDX-License-Identifier: GPL-3.0-or-later
// A camera without skew in the place of one with it, and the photograph that goes with it: for
// programs that cannot hold skew, or pixels that are not square.
#pragma once

#include <cstdint>

#include "camera/framed_camera.h"
#include "camera/photo.h"

namespace tranos::camera {

enum class PixelShape : std::uint8_t { kRectangular, kSquare };

struct Unskewed {
  FramedCamera view;  // skew 90°; f_x = f_y in pixels if square; the same place and rotation
  // Affine: where a dot of the original is in the new picture. Rows stay rows: y does not change.
  Mat3 new_dot_from_dot = Mat3::Identity();
  bool changed = false;  // else all of it is as it was
};

// K′ K⁻¹ for the K′ that keeps f_y and v, and f_x too if pixels may be rectangular. The new frame
// holds the whole old one and is as high. Error: kTooLarge (more than kMaxPhotoPixels).
geom::Result<Unskewed> UnskewedOf(const FramedCamera&, PixelShape);

// The photograph as the new camera takes it: each row resampled along itself by Catmull and Rom's
// cubic, widened where it shrinks; black where the old one shows nothing.
Photo Warped(const Photo&, const Unskewed&);

}  // namespace tranos::camera
