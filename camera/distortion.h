// SPDX-License-Identifier: GPL-3.0-or-later
// Radial distortion of a lens: what it does to dots, and how strong it is, from lines that should
// be straight (Brown 1971, "Close-range camera calibration": plumb lines).
#pragma once

#include <span>
#include <vector>

#include "camera/camera.h"

namespace tranos::camera {

// The picture of a point that a pinhole would put at distance r from `centre_mm` lies, in the same
// direction, at r (1 + k1 r² + k2 r⁴); r² = (x / unit_x)² + (y / unit_y)². With half the frame's
// diagonal as the unit, k1 + k2 is the share by which a corner is moved; with (f, r f) k1 and k2
// are those of OpenCV.
struct Distortion {
  Vec2 centre_mm = Vec2::Zero();  // in the frame
  Vec2 unit_mm = Vec2::Ones();
  double k1 = 0;
  double k2 = 0;
};

// Where the lens puts what a pinhole would put at this dot.
Vec2 DistortDot(const Distortion&, const Frame&, const Vec2& dot_px);

// Where a pinhole would put what is seen at this dot: the inverse of DistortDot, to 1e-12 of the
// distance from the centre. Error kOutOfRange: the dot lies where the distortion would fold the
// picture over, so that no point or more than one belongs to it.
geom::Result<Vec2> UndistortDot(const Distortion&, const Frame&, const Vec2& dot_px);

// Dots along a line that is straight in the world.
struct PlumbLine {
  std::vector<Vec2> dots_px;  // three or more
  double sigma_px;            // of each coordinate
};

struct DistortionFit {
  Distortion distortion;
  Eigen::Matrix2d covariance;  // of k1 and k2; that of k2 is 0 where it was not sought
  double misfit;               // Σ (distance/σ)² of the dots from their lines, in the photograph
  int degrees_of_freedom;
};

// k1, and with `terms` 2 also k2, about `centre_mm` (the principal point) in units of half the
// frame's diagonal, by maximum likelihood: the dots' distances, before the distortion is taken
// away, from lines that it makes straight. Errors: kOutOfRange (terms not 1 or 2, a deviation not
// above 0, a dot or a centre that is no number); kDegenerate (fewer than three dots in a line,
// `part`; lines that do not determine it, as those through the centre, which stay straight, or
// whose dots lie at too few distances to tell k1 from k2; a fit that does not converge).
geom::Result<DistortionFit> FitDistortion(std::span<const PlumbLine>, const Frame&,
                                          const Vec2& centre_mm, int terms);

}  // namespace tranos::camera
