// SPDX-License-Identifier: GPL-3.0-or-later
// Circles in a known plane, seen as conics.
#pragma once

#include <span>

#include "camera/camera.h"

namespace tranos::camera {

struct FittedCircle {
  Vec2 centre_m;  // along the plane's x and y, from its origin
  double radius_m;
  Mat3 covariance;  // of centre and radius, by the dots alone
  double chi2;      // Σ (distance of the dot from the circle's image / σ)², dots − 3 degrees
  std::vector<double> angles_rad;  // of each dot's nearest point, from x towards y
};

// The circle in the plane whose image is likeliest to have given the dots, each coordinate with
// deviation `sigma_px`. It starts where the cone of their conic meets the plane (Lemma 10): that
// section is a circle, which makes it linear; then the dots' distances from the circle's image are
// made least. Errors: kDegenerate: fewer than three dots, or they lie on a line within their noise,
// or the plane is seen edge-on; kOutOfRange: a dot is of no point of the plane.
geom::Result<FittedCircle> FitCircleSeen(const Camera&, const Frame&, const geom::Frame& plane,
                                         std::span<const Vec2> dots_px, double sigma_px);

}  // namespace tranos::camera
