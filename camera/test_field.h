// SPDX-License-Identifier: GPL-3.0-or-later
// A camera calibrated by a test field (the paper's 3.2.1): a planar target with marked points, seen
// in several views by the same camera.
#pragma once

#include <span>
#include <vector>

#include "camera/camera.h"
#include "camera/distortion.h"

namespace tranos::camera {

// One photograph of the target. The target is the plane y = 0 of the world, as a facade is, and a
// point of it is (X, Z).
struct TargetView {
  std::vector<Vec2> points_m;
  std::vector<Vec2> dots_px;  // one for each point
  double sigma_px;            // of each coordinate
};

struct TestField {
  std::vector<Camera> cameras;  // one for each view; f, r, u, v are those of all
  Distortion distortion;        // about (u, v), in units of (f, r f)
  // Of each camera's parameters, from the views' sigma_px; 0 for the skew angle.
  std::vector<ParameterVector> deviations;
  Vec2 distortion_deviation;  // of k1 and k2, 0 for a term not sought
  double misfit;              // Σ (residual/σ)² of all coordinates
  int degrees_of_freedom;
};

// The camera with `terms` (0, 1 or 2) of radial distortion: started by OpenCV's calibrateCamera
// (Zhang 2000, "A flexible new technique for camera calibration"), brought to the least squares in
// double precision. Zero skew is OpenCV's model: the skew angle is 90° and not estimated. Errors:
// kOutOfRange (terms; points and dots of different number, a deviation not above 0, what is no
// number: `part` the view); kDegenerate (fewer than two views; fewer than four points in a view or
// all on a line, `part`; views that do not determine the camera, as those of a target that was
// never turned).
geom::Result<TestField> CalibrateByTestField(std::span<const TargetView>, const Frame&, int terms);

}  // namespace tranos::camera
