// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geom/primitives.h"

namespace tranos::output {

// A parallel projection. Picture space has its origin at the picture's centre, x to the right, y up
// and z towards the viewer, all in pixels, so that depths compare with widths.
struct Camera {
  geom::Frame frame;   // x right, y up, z towards the viewer; its origin is seen in the centre
  double pixel_m = 1;  // the length that a pixel shows
  int width_px = 0, height_px = 0;

  geom::Affine picture_from_world() const;
};

// Of the picture that is left free on each side, at least.
inline constexpr double kMargin = 0.05;

// The camera that looks along −z of `directions` (whose origin does not count) and fits
// `box_in_view`, given along the axes of `directions`, into the picture with kMargin. An empty box
// or a single point is seen as if it were a metre wide.
Camera FitCamera(const geom::Frame& directions, const geom::Box& box_in_view, int width_px,
                 int height_px);

}  // namespace tranos::output
