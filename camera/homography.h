// SPDX-License-Identifier: GPL-3.0-or-later
// The homography from a facade to the picture.
#pragma once

#include <span>

#include "camera/camera.h"

namespace tranos::camera {

// H from points (along, up, 1) of a rectangle's plane, in metres from its first corner, to its
// dots, exactly; corners (0, 0), (a, 0), (a, b), (0, b), so that H₃₃ is the first dot's coordinate.
// In any coordinates of the dots. (The paper's Lemma 1.) Error kOutOfRange: a or b is not positive;
// kDegenerate: three dots on a line, or the quadrangle is crossed or not convex.
geom::Result<Mat3> HomographyOfRectangle(std::span<const Vec2, 4> dots, double a_m, double b_m);

// H from points of a plane to dots by the normalised direct linear transformation of four or more;
// with four it is exact. H has unit Frobenius norm and maps the points' centre to a positive third
// coordinate. Error kDegenerate: fewer than four, or all but one on a line.
geom::Result<Mat3> FitHomography(std::span<const Vec2> points, std::span<const Vec2> dots);

}  // namespace tranos::camera
