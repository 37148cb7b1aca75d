// SPDX-License-Identifier: GPL-3.0-or-later
// Image lines by total least squares, with how sure they are.
#pragma once

#include <vector>

#include "camera/camera.h"

namespace tranos::camera {

// A straight line of the picture, observed between two ends. The centre's offset across the line
// and the tilt, the difference of the ends' offsets, are independent and normal.
struct ImageLine {
  Vec2 a_px, b_px;         // ends, the same distance from the centre
  double centre_sigma_px;  // of the offset of the centre, across the line
  double tilt_sigma_px;    // of the difference of the offsets of the ends
  int dots = 2;            // that the line was fitted to
  double misfit = 0;       // Σ (distance/σ)² of the dots; dots − 2 degrees of freedom

  Vec2 centre_px() const { return 0.5 * (a_px + b_px); }
  double length_px() const { return (b_px - a_px).norm(); }
  // Homogeneous, with (l₁, l₂) the unit normal; positive on the right when going from a to b with y
  // down.
  Vec3 coordinates() const;
};

// The line through dots by total least squares, each coordinate of a dot with deviation `sigma_px`.
// With `samples` > 0, for two dots: the ends of a line that was fitted to so many pixels spread
// evenly along it (centre σ/√N, tilt σ√(12/N)). Error kDegenerate: fewer than two different dots.
geom::Result<ImageLine> FitImageLine(const std::vector<Vec2>& dots_px, double sigma_px,
                                     double samples = 0);

// So many pixels that a line fitted to them, each with deviation `sigma_px`, is as sure of its
// direction as this one; two or more.
int SamplesOf(const ImageLine&, double sigma_px);

}  // namespace tranos::camera
