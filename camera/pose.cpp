// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/pose.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <map>

namespace tranos::camera {
namespace {

constexpr double kRank = 1e-9;

tl::unexpected<geom::Error> Degenerate(const char* detail) {
  return tl::unexpected(geom::Error{geom::ErrorCode::kDegenerate, detail});
}

ProjectionMatrix ProjectionOf(const ConditionedCamera& camera) {
  ProjectionMatrix p;
  p.leftCols<3>() = camera.inverse_calibration.inverse() * camera.camera_from_world;
  p.col(3) = -p.leftCols<3>() * camera.position_m;
  return p;
}

Mat3 Cross(const Vec3& w) {
  Mat3 m;
  m << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return m;
}

// The plane's axes are X and Z of the world; its H is K (r_X, r_Z, t) up to scale.
ConditionedCamera PoseOf(const Mat3& inverse_calibration, const Mat3& h) {
  const Mat3 a = inverse_calibration * h;
  const double scale = 0.5 * (a.col(0).norm() + a.col(1).norm());
  Mat3 axes;
  axes << a.col(0), a.col(1).cross(a.col(0)) / scale, a.col(1);
  const Mat3 r = NearestRotation(axes / scale);
  return {inverse_calibration, r, -r.transpose() * a.col(2) / scale};
}

// In a view of little perspective, the points of a plane mirrored at the plane across the line of
// sight have the same image.
ConditionedCamera Mirrored(const ConditionedCamera& camera, const Vec3& centre_m) {
  const Vec3 centre = camera.camera_from_world * (centre_m - camera.position_m);
  const Vec3 sight = centre.normalized();
  const Mat3 mirror = Mat3::Identity() - 2 * sight * sight.transpose();
  const Vec3 x = mirror * camera.camera_from_world.col(0);
  const Vec3 z = mirror * camera.camera_from_world.col(2);
  Mat3 r;
  r << x, z.cross(x), z;
  return {camera.inverse_calibration, r, centre_m - r.transpose() * centre};
}

}  // namespace

bool IsUsual(const Mat3& camera_from_world) {
  return camera_from_world(1, 2) < 0 && camera_from_world(0, 0) >= 0;
}

Mat3 NearestRotation(const Mat3& matrix) {
  const Eigen::JacobiSVD<Mat3> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3 sign(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

geom::Result<std::vector<PoseCandidate>> PosesFromHomography(const Mat3& inverse_calibration,
                                                             const Mat3& h,
                                                             std::span<const Vec2> points_m,
                                                             std::span<const Vec2> dots,
                                                             double scale_px) {
  const Mat3 a = inverse_calibration * h;
  if (points_m.empty() || !(a.col(0).cross(a.col(1)).norm() > kRank * a.col(0).squaredNorm()) ||
      !(std::abs(a.determinant()) > 0))
    return Degenerate("the homography does not map the facade to a plane of the picture");
  SpaceTraces traces;
  for (size_t i = 0; i < std::min(points_m.size(), dots.size()); ++i)
    traces.points.push_back({dots[i], {points_m[i].x(), 0, points_m[i].y()}, 1});
  const auto candidate = [&](const ConditionedCamera& camera, PoseKind kind) {
    const double mean = PenaltyOf(traces, camera) / static_cast<double>(traces.points.size());
    return PoseCandidate{camera, kind, scale_px * std::sqrt(mean), InFront(traces, camera)};
  };
  std::vector<PoseCandidate> poses{candidate(PoseOf(inverse_calibration, h), PoseKind::kDirect),
                                   candidate(PoseOf(inverse_calibration, -h), PoseKind::kOpposite)};
  std::stable_sort(poses.begin(), poses.end(),
                   [](const auto& p, const auto& q) { return p.in_front > q.in_front; });
  if (poses[0].in_front && points_m.size() >= 4) {
    const ConditionedCamera& seen = poses[0].camera;
    const PoseCandidate flipped =
        candidate(RefinePose(traces, Mirrored(seen, traces.centre_m()), false), PoseKind::kFlipped);
    const double turn = (flipped.camera.camera_from_world - seen.camera_from_world).norm();
    if (flipped.in_front && turn > 1e-3) poses.insert(poses.begin() + 1, flipped);
    std::stable_sort(poses.begin(), poses.end(), [](const auto& p, const auto& q) {
      return std::pair(!p.in_front, p.rms_px) < std::pair(!q.in_front, q.rms_px);
    });
  }
  return poses;
}

geom::Result<Mat3> FacadeHomography(const SpaceTraces& traces, double y_m) {
  SpaceTraces in_plane;
  for (const SpaceEdge& e : traces.edges)
    if (std::abs(e.from_m.y() - y_m) < geom::kCoincident_m &&
        std::abs(e.to_m.y() - y_m) < geom::kCoincident_m)
      in_plane.edges.push_back(e);
  for (const SpacePoint& p : traces.points)
    if (std::abs(p.point_m.y() - y_m) < geom::kCoincident_m) in_plane.points.push_back(p);
  if (in_plane.edges.size() + in_plane.points.size() < 4)
    return Degenerate("a facade's homography needs four edges or points in it");
  const ProjectionRows all = ProjectionRowsOf(in_plane, nullptr);
  Eigen::MatrixXd rows(std::max<Eigen::Index>(9, all.rows()), 9);
  rows.setZero();
  rows.topRows(all.rows()) << all.leftCols<3>(), all.rightCols<6>();
  Eigen::VectorXd size = rows.colwise().norm();
  for (Eigen::Index i = 0; i < 9; ++i)
    if (!(size[i] > 0)) return Degenerate("the edges of the facade are on one line");
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows * size.cwiseInverse().asDiagonal(),
                                              Eigen::ComputeFullV);
  if (!(svd.singularValues()[7] > kRank * svd.singularValues()[0]))
    return Degenerate("the edges and points in the facade leave its homography open");
  const Eigen::Matrix<double, 9, 1> h = svd.matrixV().col(8).cwiseQuotient(size);
  return Mat3(h.reshaped(3, 3) / h.norm());
}

std::optional<double> FacadeWithMost(const SpaceTraces& traces) {
  std::vector<std::pair<double, int>> planes;
  const auto count = [&](double y) {
    for (auto& [at, number] : planes)
      if (std::abs(at - y) < geom::kCoincident_m) return void(++number);
    planes.push_back({y, 1});
  };
  for (const SpaceEdge& e : traces.edges)
    if (std::abs(e.from_m.y() - e.to_m.y()) < geom::kCoincident_m) count(e.from_m.y());
  for (const SpacePoint& p : traces.points) count(p.point_m.y());
  std::sort(planes.begin(), planes.end());
  const auto most =
      std::max_element(planes.begin(), planes.end(),
                       [](const auto& p, const auto& q) { return p.second < q.second; });
  if (most == planes.end() || most->second < 4) return std::nullopt;
  return most->first;
}

geom::Result<Vec3> PositionFromTraces(const SpaceTraces& traces, const Mat3& inverse_calibration,
                                      const Mat3& camera_from_world, OpenPosition open) {
  // About their centre, so that a world with large coordinates loses no digits.
  SpaceTraces centred = traces;
  const Vec3 centre = traces.centre_m();
  for (SpaceEdge& e : centred.edges) e.from_m -= centre, e.to_m -= centre;
  for (SpacePoint& p : centred.points) p.point_m -= centre;
  ProjectionMatrix projection;
  projection.leftCols<3>() = inverse_calibration.inverse() * camera_from_world;
  const Eigen::Matrix<double, 9, 1> m = projection.leftCols<3>().reshaped();
  constexpr double kAssumed_m = 10;
  const Vec3 ahead = inverse_calibration.inverse() * Vec3(0, 0, kAssumed_m);
  for (int i = 0; i < 3; ++i) {
    const ProjectionRows rows = ProjectionRowsOf(centred, i == 0 ? nullptr : &projection);
    if (!rows.allFinite()) return Degenerate("edges and points do not determine the position");
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> seen(rows.rightCols<3>());
    seen.setThreshold(kRank);
    if (seen.rank() < 3 && open == OpenPosition::kRefused)
      return Degenerate("edges and points do not determine the position");
    // What they leave open stays as if their centre were straight ahead.
    projection.col(3) = ahead + seen.solve(-rows.leftCols<9>() * m - rows.rightCols<3>() * ahead);
  }
  return Vec3(centre - camera_from_world.transpose() * (inverse_calibration * projection.col(3)));
}

geom::Result<ConditionedCamera> PoseFromDirections(const Mat3& inverse_calibration,
                                                   const AxisPoints& points,
                                                   const SpaceTraces& traces) {
  Mat3 axes = Mat3::Zero();
  std::vector<int> known;
  for (int i = 0; i < 3; ++i)
    if (const auto& point = points[static_cast<size_t>(i)]) {
      axes.col(i) = (inverse_calibration * *point).normalized();
      known.push_back(i);
    }
  if (known.size() < 2) return Degenerate("a rotation needs two vanishing points");
  if (known.size() == 2) {
    const int third = 3 - known[0] - known[1];
    axes.col(third) = axes.col((third + 1) % 3).cross(axes.col((third + 2) % 3)).normalized();
  }
  std::optional<ConditionedCamera> best;
  double least = std::numeric_limits<double>::infinity();
  for (int signs = 0; signs < 4; ++signs) {
    Mat3 signed_axes = axes;
    if (signs & 1) signed_axes.col(known[0]) *= -1;
    if (signs & 2) signed_axes.col(known[1]) *= -1;
    const int third = 3 - known[0] - known[1];
    if (signed_axes.determinant() < 0) signed_axes.col(third) *= -1;
    const Mat3 r = NearestRotation(signed_axes);
    if (traces.empty()) {
      if (IsUsual(r)) return ConditionedCamera{inverse_calibration, r, {0, -10, 0}};
      continue;
    }
    const geom::Result<Vec3> position =
        PositionFromTraces(traces, inverse_calibration, r, OpenPosition::kAssumed);
    if (!position) return tl::unexpected(position.error());
    const ConditionedCamera camera{inverse_calibration, r, *position};
    const double penalty = PenaltyOf(traces, camera);
    if (penalty < least && InFront(traces, camera)) best = camera, least = penalty;
  }
  if (!best)
    return Degenerate("no camera with these vanishing points has what is traced before it");
  return *best;
}

ConditionedCamera RefinePose(const SpaceTraces& traces, ConditionedCamera camera, bool focal) {
  using Vec7 = Eigen::Matrix<double, 7, 1>;
  using Mat7 = Eigen::Matrix<double, 7, 7>;
  const int count = focal ? 7 : 6;
  const Vec3 centre = traces.centre_m();
  double penalty = PenaltyOf(traces, camera), damping = 1e-3;
  for (int i = 0; i < 60 && std::isfinite(penalty); ++i) {
    const ProjectionMatrix p = ProjectionOf(camera);
    const Mat3 k = camera.inverse_calibration.inverse();
    const ProjectionRows rows = ProjectionRowsOf(traces, &p);
    const Eigen::VectorXd residual = rows * p.reshaped();
    // Turned about the traces' centre, as the translation would otherwise undo most of each turn.
    const Vec3 pivot = camera.camera_from_world * (centre - camera.position_m);
    Eigen::Matrix<double, 12, 7> slope = Eigen::Matrix<double, 12, 7>::Zero();
    Eigen::Matrix<double, 3, 4> pose = camera.inverse_calibration * p, turned = pose;
    turned.col(3) -= pivot;
    for (int axis = 0; axis < 3; ++axis) {
      slope.col(axis) = (k * Cross(Vec3::Unit(axis)) * turned).reshaped();
      slope.block<3, 1>(9, 3 + axis) = k.col(axis) * pivot.norm();
    }
    slope.col(6) = (k * Vec3(1, 1, 0).asDiagonal() * pose).reshaped();
    if (!focal) slope.col(6).setZero();
    const Eigen::MatrixXd jacobian = rows * slope;
    const Mat7 information = jacobian.transpose() * jacobian;
    const Vec7 gradient = jacobian.transpose() * residual;
    bool better = false;
    for (int attempt = 0; attempt < 12 && !better; ++attempt) {
      Mat7 damped = information;
      damped.diagonal() *= 1 + damping;
      if (!focal) damped(6, 6) = 1;
      damped.diagonal().array() += 1e-12 * information.trace();
      const Vec7 step = -damped.ldlt().solve(gradient);
      const Vec3 turn = step.head<3>();
      ConditionedCamera next = camera;
      const double angle = turn.norm();
      const Mat3 rotation =
          angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Mat3::Identity();
      next.camera_from_world = rotation * camera.camera_from_world;
      const Vec3 moved = pivot + pivot.norm() * step.segment<3>(3);
      next.position_m = centre - next.camera_from_world.transpose() * moved;
      if (count == 7) {
        const double scale = std::exp(-std::clamp(step[6], -0.5, 0.5));
        next.inverse_calibration = camera.inverse_calibration;
        next.inverse_calibration.topRows<2>() *= scale;
      }
      const double now = PenaltyOf(traces, next);
      better = now < penalty;
      damping *= better ? 0.2 : 8;
      if (!better) continue;
      const bool done = now > penalty * (1 - 1e-10);
      camera = next, penalty = now;
      camera.camera_from_world = NearestRotation(camera.camera_from_world);
      if (done) return camera;
    }
    if (!better) break;
  }
  return camera;
}

}  // namespace tranos::camera
