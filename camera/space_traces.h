// SPDX-License-Identifier: GPL-3.0-or-later
// What linear solvers take from a photograph: image lines by axis, and edges and points whose place
// is known, in conditioned coordinates with their weights.
#pragma once

#include <array>
#include <vector>

#include "camera/conditioning.h"
#include "camera/traces.h"

namespace tranos::camera {

struct SpaceEdge {
  Vec3 line;  // through a and b, (l₁, l₂) a unit vector
  Vec2 a, b;
  Vec3 from_m, to_m;
  double centre_weight, tilt_weight;  // 1/σ
};
struct SpacePoint {
  Vec2 at;
  Vec3 point_m;
  double weight;  // 1/σ
};
struct SpaceTraces {
  std::vector<SpaceEdge> edges;
  std::vector<SpacePoint> points;
  bool empty() const { return edges.empty() && points.empty(); }
  Vec3 centre_m() const;
  bool varies(int axis) const;  // whether a coordinate is not the same everywhere
};

bool WorldIsFixed(const Photograph& photograph);
// Edges, points, and, where nothing else fixes the world, the corners of the first rectangle of
// facade 0 from the origin on in the plane y = 0.
SpaceTraces SpaceTracesOf(const Photograph& photograph, const Numbers& numbers);

// Lines known to be parallel to X, Y, Z: traced so, or edges whose ends differ in one coordinate.
using AxisLines = std::array<std::vector<ImageLine>, 3>;
AxisLines AxisLinesOf(const Photograph& photograph, const Numbers& numbers);

// A calibrated camera in conditioned coordinates.
struct ConditionedCamera {
  Mat3 inverse_calibration;
  Mat3 camera_from_world;
  Vec3 position_m;
};
Camera CameraOf(const ConditionedCamera& camera, const Frame& frame);
ConditionedCamera ConditionedCameraOf(const Camera& camera, const Frame& frame);

// Σ of the squared whitened residuals of edges (offset of the traced line's centre from the image
// of the edge, and difference of its ends' offsets) and points. The discrepancy of the paper's Step
// F.
double PenaltyOf(const SpaceTraces& traces, const ConditionedCamera& camera);
// Whether every point and end is before the camera.
bool InFront(const SpaceTraces& traces, const ConditionedCamera& camera);

// Whitened rows on the columns of P, one under the other, whose squares sum to the penalty to first
// order about `reference`; without it depths count as alike. Two for each edge and each point.
using ProjectionRows = Eigen::Matrix<double, Eigen::Dynamic, 12>;
ProjectionRows ProjectionRowsOf(const SpaceTraces& traces, const ProjectionMatrix* reference);

}  // namespace tranos::camera
