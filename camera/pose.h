// SPDX-License-Identifier: GPL-3.0-or-later
// Where a calibrated camera was: from a facade's homography, from vanishing points, from edges and
// points in space.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "camera/space_traces.h"

namespace tranos::camera {

// The rotation nearest to a matrix in the Frobenius norm, by singular values.
Mat3 NearestRotation(const Mat3& matrix);

enum class PoseKind {
  kDirect,    // of H
  kOpposite,  // of −H, Lemma 8: the same picture from behind the facade's image
  kFlipped,   // the facade's normal mirrored at the line of sight: nearly the same picture
};
struct PoseCandidate {
  ConditionedCamera camera;
  PoseKind kind;
  double rms_px;  // of the distances of the given points' images from their dots
  bool in_front;  // whether all of the points are before the camera
};

// All poses that a homography from the plane y = 0, with points (X, Z), to conditioned dots gives.
// H and −H: with the plane's axes first, (r_X, r_Z, normal, t) and (−r_X, −r_Z, normal, −t), so not
// the paper's "(−R, t)". To the one with the points before the camera comes the local minimum of
// the reprojection error beside it (the ambiguity that IPPE handles, Collins and Bartoli 2014), if
// there is one. Those in front first, by error. Error kDegenerate: H is not of full rank.
geom::Result<std::vector<PoseCandidate>> PosesFromHomography(const Mat3& inverse_calibration,
                                                             const Mat3& conditioned_from_facade,
                                                             std::span<const Vec2> points_m,
                                                             std::span<const Vec2> dots,
                                                             double scale_px);

// The homography of the plane y = `y_m` from points (X, Z, 1) to conditioned dots, from edges and
// points that lie in it. Error kDegenerate: they do not determine it.
geom::Result<Mat3> FacadeHomography(const SpaceTraces& traces, double y_m);
// y of the plane parallel to the world's X and Z with most edges and points; of several the first
// from the front. None if no edge or point lies in such a plane with three others.
std::optional<double> FacadeWithMost(const SpaceTraces& traces);

// Whether a camera is upright and has X to its right, as is supposed where nothing tells the signs
// of the axes.
bool IsUsual(const Mat3& camera_from_world);

// What becomes of a position that edges and points leave open.
enum class OpenPosition : std::uint8_t { kRefused, kAssumed };
// The position, m, with K and R given: least squares of edges and points, linear, weighted anew by
// the depths found. Where they leave it open, as a single point does: the place that they allow
// from which their centre is most nearly straight ahead, 10 m away, or the error kDegenerate.
geom::Result<Vec3> PositionFromTraces(const SpaceTraces& traces, const Mat3& inverse_calibration,
                                      const Mat3& camera_from_world,
                                      OpenPosition open = OpenPosition::kRefused);

// The pose from two or three vanishing points of the world's axes (any sign) and the edges and
// points. Of the four ways to sign the axes, the one with the least penalty and all in front.
// Without edges and points: Z up in the picture, X to the right, position 10 m before the origin.
// Error kDegenerate: fewer than two vanishing points, or nothing comes in front.
using AxisPoints = std::array<std::optional<Vec3>, 3>;
geom::Result<ConditionedCamera> PoseFromDirections(const Mat3& inverse_calibration,
                                                   const AxisPoints& points,
                                                   const SpaceTraces& traces);

// The pose near a given one with the least penalty, by damped Gauss–Newton; `focal`: the focal
// length, with aspect, skew and principal point kept, too.
ConditionedCamera RefinePose(const SpaceTraces& traces, ConditionedCamera camera, bool focal);

}  // namespace tranos::camera
