// SPDX-License-Identifier: GPL-3.0-or-later
// A plane of the world as a camera shows it.
#pragma once

#include "camera/camera.h"

namespace tranos::camera {

// Homogeneous dots from metres along the plane's x and y; the third is the depth before the camera
// in metres, so that what is behind it has none above 0.
Mat3 DotFromPlane(const Camera&, const Frame&, const geom::Frame& plane);

// The ground sampling distance: the length on the plane that a pixel of the photograph covers at
// this place, along the direction in which it covers most. Infinite for what is not before the
// camera, or seen edge-on.
double GroundSampling_m(const Mat3& dot_from_plane, const Vec2& place_m);

}  // namespace tranos::camera
