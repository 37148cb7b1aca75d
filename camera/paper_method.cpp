// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/paper_method.h"

#include <Eigen/LU>
#include <cmath>

namespace tranos::camera {
namespace {

tl::unexpected<geom::Error> Degenerate(const char* detail) {
  return tl::unexpected(geom::Error{geom::ErrorCode::kDegenerate, detail});
}

}  // namespace

geom::Result<SweepResult> CalibratePaper(const Photograph& photograph, const Numbers& numbers,
                                         const SkewRange& range) {
  if (range.count < 1 || !(range.from_rad > 0) || !(range.step_rad > 0) ||
      !(range.at(range.count - 1) < kPi))
    return tl::unexpected(
        geom::Error{geom::ErrorCode::kOutOfRange, "skew angles must be between 0° and 180°"});
  const SpaceTraces traces = SpaceTracesOf(photograph, numbers);
  std::vector<Conic> rows = IndependentRows(ConicRowsOf(photograph, numbers).all(), 4);
  rows.push_back(ZeroSkewRow());
  const geom::Result<Mat3> without_skew = CalibrationFromRows(rows);
  if (!without_skew) return tl::unexpected(without_skew.error());
  const std::optional<double> y_m = FacadeWithMost(traces);
  if (!y_m) return Degenerate("no facade parallel to X and Z has four edges or points");
  const geom::Result<Mat3> h = FacadeHomography(traces, *y_m);
  if (!h) return tl::unexpected(h.error());

  // Pose needs points only to tell what is in front: any of the facade, by the penalty's traces.
  const std::array<Vec2, 1> origin{Vec2(traces.centre_m().x(), traces.centre_m().z())};
  const double scale_px = ConditioningOf(photograph.frame).scale_px;
  SweepResult result;
  result.penalty = std::numeric_limits<double>::infinity();
  ConditionedCamera best;
  int lowest = 0;
  for (int i = 0; i < range.count; ++i) {
    Mat3 k = *without_skew;
    k(0, 1) = k(0, 0) * std::cos(range.at(i)) / std::sin(range.at(i));
    const Mat3 inverse = k.inverse();
    const std::array<Vec2, 1> dot{(*h * origin[0].homogeneous()).hnormalized()};
    const auto poses = PosesFromHomography(inverse, *h, origin, dot, scale_px);
    if (!poses) return tl::unexpected(poses.error());
    double least = std::numeric_limits<double>::infinity();
    for (const PoseCandidate& pose : *poses) {
      if (pose.kind == PoseKind::kFlipped) continue;
      ConditionedCamera camera = pose.camera;
      camera.position_m.y() += *y_m;
      const double penalty = PenaltyOf(traces, camera);
      if (!InFront(traces, camera) || !(penalty < least)) continue;
      least = penalty;
      if (penalty < result.penalty) result.penalty = penalty, best = camera, lowest = i;
    }
    result.curve.push_back({range.at(i), least});
  }
  if (!std::isfinite(result.penalty)) return Degenerate("no pose has what is traced before it");
  result.at_end = lowest == 0 || lowest == range.count - 1;
  result.camera = CameraOf(best, photograph.frame);
  return result;
}

}  // namespace tranos::camera
