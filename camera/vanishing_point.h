// SPDX-License-Identifier: GPL-3.0-or-later
// The vanishing point of image lines by maximum likelihood, at and near infinity too.
#pragma once

#include <span>

#include "camera/conditioning.h"

namespace tranos::camera {

// A vanishing point in homogeneous conditioned coordinates, a unit vector: the sphere has no
// infinity. Its sign means nothing.
struct VanishingPoint {
  Vec3 point;
  Mat3 covariance;       // rank 2: none along `point`
  double misfit = 0;     // Σ of squares of whitened residuals; lines − 2 degrees of freedom
  double sigma_max = 0;  // the largest deviation of any direction on the sphere, rad
  // How many of its deviations the point is from infinity.
  double FromInfinity() const;
  // Lines so nearly parallel, short or uncertain that the point is known only to 1/20 rad.
  bool nearly_degenerate() const { return sigma_max > 0.05; }
};

// The point v for which the lines, moved through it, are likeliest: the sum over lines of
// (l·v)² / (σ_centre² w² + σ_tilt² (m·v)²), where (m·v)/w is how many lengths of the line v is from
// its centre. Gauss–Newton on the sphere from the weighted algebraic solution, always to the same
// result. Error kDegenerate: fewer than two lines, or all of them are the same line within noise.
// (The paper's Section 3, references [41, 42].)
geom::Result<VanishingPoint> FitVanishingPoint(std::span<const ImageLine> lines,
                                               const Conditioning& conditioning);
// That sum for a given v.
double PencilMisfit(std::span<const ImageLine> lines, const Conditioning& conditioning,
                    const Vec3& v);

}  // namespace tranos::camera
