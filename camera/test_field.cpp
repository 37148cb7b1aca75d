// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/test_field.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <optional>
#include <string>

namespace tranos::camera {
namespace {

using geom::Error;
using geom::ErrorCode;

tl::unexpected<Error> Degenerate(std::string detail, int part = -1) {
  return tl::unexpected(Error{ErrorCode::kDegenerate, std::move(detail), part});
}

bool OnALine(const std::vector<Vec2>& points) {
  Vec2 centroid = Vec2::Zero();
  for (const Vec2& p : points) centroid += p / static_cast<double>(points.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Vec2& p : points) scatter += (p - centroid) * (p - centroid).transpose();
  const Vec2 spread = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(scatter).eigenvalues();
  return !(spread[0] > 1e-12 * spread[1]);
}

std::optional<Error> FaultOf(std::span<const TargetView> views, int terms) {
  if (terms < 0 || terms > 2) return Error{ErrorCode::kOutOfRange, "no, one or two terms"};
  if (views.size() < 2) return Error{ErrorCode::kDegenerate, "two views or more are needed"};
  for (std::size_t i = 0; i < views.size(); ++i) {
    const TargetView& view = views[i];
    const int part = static_cast<int>(i);
    if (view.points_m.size() != view.dots_px.size()) {
      return Error{ErrorCode::kOutOfRange, "the view has not one dot for each point", part};
    }
    if (!(view.sigma_px > 0)) {
      return Error{ErrorCode::kOutOfRange, "a dot's deviation must be above 0", part};
    }
    for (std::size_t k = 0; k < view.dots_px.size(); ++k) {
      if (!view.dots_px[k].allFinite() || !view.points_m[k].allFinite()) {
        return Error{ErrorCode::kOutOfRange, "the view has a dot or point that is none", part};
      }
    }
    if (view.points_m.size() < 4 || OnALine(view.points_m) || OnALine(view.dots_px)) {
      return Error{ErrorCode::kDegenerate, "a view needs four points that are not on one line",
                   part};
    }
  }
  return std::nullopt;
}

// All that is solved for.
struct State {
  std::vector<Camera> cameras;
  double k1 = 0;
  double k2 = 0;

  Distortion distortion() const {
    const Camera& c = cameras[0];
    return {{c[kPrincipalX], c[kPrincipalY]}, {c[kFocal], c[kAspect] * c[kFocal]}, k1, k2};
  }
  bool IsFinite() const {
    for (const Camera& camera : cameras) {
      if (!camera.parameters.allFinite()) return false;
    }
    return std::isfinite(k1) && std::isfinite(k2);
  }
};

// OpenCV's target has its z towards the viewer: x, y, z of it are X, Z, −Y of the world.
Mat3 TargetFromWorld() {
  Mat3 m;
  m << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return m;
}

Camera CameraFrom(const Mat3& frame_from_camera, const cv::Mat& rotation, const cv::Mat& shift) {
  const auto vector = [](const cv::Mat& m) {
    return Vec3(m.at<double>(0), m.at<double>(1), m.at<double>(2));
  };
  const Vec3 turn = vector(rotation);
  const double angle = turn.norm();
  const Vec3 axis = angle > 0 ? Vec3(turn / angle) : Vec3::UnitX();
  const Mat3 camera_from_target = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  const Vec3 position = -camera_from_target.transpose() * vector(shift);
  return CameraOf(frame_from_camera, camera_from_target * TargetFromWorld(),
                  TargetFromWorld().transpose() * position);
}

Mat3 FrameFromCameraOf(const cv::Mat& dot_from_camera, const Frame& frame) {
  const auto at = [&](int row, int column) { return dot_from_camera.at<double>(row, column); };
  const Vec2 pitch = frame.pitch_mm(), principal = frame.PointFromDot({at(0, 2), at(1, 2)});
  Mat3 k;
  k << at(0, 0) * pitch.x(), 0, principal.x(), 0, at(1, 1) * pitch.y(), principal.y(), 0, 0, 1;
  return k;
}

// OpenCV keeps dots in single precision and throws; neither leaves this function.
geom::Result<State> Start(std::span<const TargetView> views, const Frame& frame, int terms) try {
  cv::setNumThreads(1);  // so that sums are made in one order
  std::vector<std::vector<cv::Point3f>> points;
  std::vector<std::vector<cv::Point2f>> dots;
  for (const TargetView& view : views) {
    points.emplace_back();
    dots.emplace_back();
    for (std::size_t k = 0; k < view.points_m.size(); ++k) {
      const Eigen::Vector2f p = view.points_m[k].cast<float>(), d = view.dots_px[k].cast<float>();
      points.back().emplace_back(p.x(), p.y(), 0.f);
      dots.back().emplace_back(d.x(), d.y());
    }
  }
  int flags = cv::CALIB_ZERO_TANGENT_DIST | cv::CALIB_FIX_K3;
  if (terms < 2) flags |= cv::CALIB_FIX_K2;
  if (terms < 1) flags |= cv::CALIB_FIX_K1;
  cv::Mat k, distortion = cv::Mat::zeros(5, 1, CV_64F);
  std::vector<cv::Mat> rotations, shifts;
  cv::calibrateCamera(points, dots, {frame.size_px.x(), frame.size_px.y()}, k, distortion,
                      rotations, shifts, flags);
  State state;
  for (std::size_t i = 0; i < views.size(); ++i) {
    state.cameras.push_back(CameraFrom(FrameFromCameraOf(k, frame), rotations[i], shifts[i]));
  }
  state.k1 = distortion.at<double>(0);
  state.k2 = distortion.at<double>(1);
  if (!state.IsFinite() || !(state.cameras[0][kFocal] > 0) || !(state.cameras[0][kAspect] > 0)) {
    return Degenerate("the views do not determine the camera: turn the target between them");
  }
  return state;
} catch (const cv::Exception& exception) {
  return Degenerate("OpenCV finds no camera (" + exception.err + ")");
}

// The unknowns in order: f, r, u, v, k1, k2 of all views, then ω, φ, κ, X, Y, Z of each.
constexpr int kShared = 6;
constexpr int kPose = 6;

State Moved(const State& state, const Eigen::VectorXd& by) {
  State moved = state;
  for (std::size_t i = 0; i < moved.cameras.size(); ++i) {
    moved.cameras[i].parameters.head<4>() += by.head<4>();
    moved.cameras[i].parameters.tail<kPose>() +=
        by.segment<kPose>(kShared + kPose * static_cast<int>(i));
  }
  moved.k1 += by[4];
  moved.k2 += by[5];
  return moved;
}

// Whitened, two for each dot of a view.
Eigen::VectorXd Residuals(const TargetView& view, const Camera& camera, const Distortion& d,
                          const Frame& frame) {
  Eigen::VectorXd residuals(2 * static_cast<int>(view.dots_px.size()));
  for (int k = 0; k < residuals.size() / 2; ++k) {
    const Vec3 point(view.points_m[k].x(), 0, view.points_m[k].y());
    const Vec2 pinhole = frame.DotFromPoint(Project(camera, point).point_mm);
    residuals.segment<2>(2 * k) = (DistortDot(d, frame, pinhole) - view.dots_px[k]) / view.sigma_px;
  }
  return residuals;
}

struct Equations {
  Eigen::MatrixXd normal;
  Eigen::VectorXd gradient;
  double misfit = 0;
};

double MisfitOf(std::span<const TargetView> views, const State& state, const Frame& frame) {
  double misfit = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    misfit += Residuals(views[i], state.cameras[i], state.distortion(), frame).squaredNorm();
  }
  return misfit;
}

// Derivatives by central differences: exact enough for the step and for deviations, and the fixed
// point is that of the gradient to their error times the residuals.
Eigen::MatrixXd JacobianOf(const TargetView& view, std::size_t index, const State& state,
                           const Frame& frame) {
  const int unknowns = kShared + kPose * static_cast<int>(state.cameras.size());
  const int first = kShared + kPose * static_cast<int>(index);
  Eigen::MatrixXd jacobian(2 * static_cast<int>(view.dots_px.size()), kShared + kPose);
  for (int j = 0; j < kShared + kPose; ++j) {
    constexpr double kStep = 1e-6;
    Eigen::VectorXd by = Eigen::VectorXd::Zero(unknowns);
    const int unknown = j < kShared ? j : first + j - kShared;
    by[unknown] = kStep;
    const State up = Moved(state, by), down = Moved(state, -by);
    jacobian.col(j) = (Residuals(view, up.cameras[index], up.distortion(), frame) -
                       Residuals(view, down.cameras[index], down.distortion(), frame)) /
                      (2 * kStep);
  }
  return jacobian;
}

// Terms that are not sought keep their place with an equation of their own.
Equations EquationsOf(std::span<const TargetView> views, const State& state, const Frame& frame,
                      int terms) {
  const int unknowns = kShared + kPose * static_cast<int>(views.size());
  Equations e{Eigen::MatrixXd::Zero(unknowns, unknowns), Eigen::VectorXd::Zero(unknowns), 0};
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Eigen::VectorXd r = Residuals(views[i], state.cameras[i], state.distortion(), frame);
    const Eigen::MatrixXd jacobian = JacobianOf(views[i], i, state, frame);
    const auto shared = jacobian.leftCols<kShared>();
    const auto pose = jacobian.rightCols<kPose>();
    const int first = kShared + kPose * static_cast<int>(i);
    e.normal.topLeftCorner<kShared, kShared>() += shared.transpose() * shared;
    e.normal.block<kShared, kPose>(0, first) = shared.transpose() * pose;
    e.normal.block<kPose, kShared>(first, 0) = pose.transpose() * shared;
    e.normal.block<kPose, kPose>(first, first) = pose.transpose() * pose;
    e.gradient.head<kShared>() += shared.transpose() * r;
    e.gradient.segment<kPose>(first) = pose.transpose() * r;
    e.misfit += r.squaredNorm();
  }
  for (int k = 4 + terms; k < kShared; ++k) {
    e.normal.row(k).setZero();
    e.normal.col(k).setZero();
    e.normal(k, k) = 1;
    e.gradient[k] = 0;
  }
  return e;
}

// Of unknowns in units of their own deviations: singular where something is not determined.
std::optional<Eigen::MatrixXd> CovarianceOf(const Eigen::MatrixXd& normal) {
  if (!(normal.diagonal().minCoeff() > 0)) return std::nullopt;
  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
  if (!(solver.eigenvalues()[0] > 1e-12)) return std::nullopt;
  const Eigen::MatrixXd inverse = solver.eigenvectors() *
                                  solver.eigenvalues().cwiseInverse().asDiagonal() *
                                  solver.eigenvectors().transpose();
  return Eigen::MatrixXd(scale.asDiagonal() * inverse * scale.asDiagonal());
}

struct Least {
  State state;
  Eigen::MatrixXd covariance;
  double misfit;
};

geom::Result<Least> Descend(std::span<const TargetView> views, const Frame& frame, State state,
                            int terms) {
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Equations e = EquationsOf(views, state, frame, terms);
    const auto covariance = CovarianceOf(e.normal);
    // A focal length within a quarter of itself is no calibration.
    if (!covariance || !((*covariance)(0, 0) < std::pow(0.25 * state.cameras[0][kFocal], 2))) {
      return Degenerate("the views do not determine the camera: turn the target between them");
    }
    const Eigen::VectorXd step = -*covariance * e.gradient;
    const State moved = Moved(state, step);
    // Within rounding of the least no step is better; that of OpenCV is near it.
    if (!moved.IsFinite() || !(MisfitOf(views, moved, frame) < e.misfit)) {
      return Least{state, *covariance, e.misfit};
    }
    state = moved;
    if (-step.dot(e.gradient) < 1e-20) return Least{state, *covariance, e.misfit};
  }
  return Degenerate("the fit of the test field does not converge");
}

ParameterVector DeviationsOf(const Eigen::VectorXd& variances, std::size_t view) {
  ParameterVector deviations = ParameterVector::Zero();
  deviations.head<4>() = variances.head<4>().cwiseSqrt();
  deviations.tail<kPose>() =
      variances.segment<kPose>(kShared + kPose * static_cast<int>(view)).cwiseSqrt();
  return deviations;
}

}  // namespace

geom::Result<TestField> CalibrateByTestField(std::span<const TargetView> views, const Frame& frame,
                                             int terms) {
  if (const auto fault = FaultOf(views, terms)) return tl::unexpected(*fault);
  const auto start = Start(views, frame, terms);
  if (!start) return tl::unexpected(start.error());
  const auto least = Descend(views, frame, *start, terms);
  if (!least) return tl::unexpected(least.error());
  const Eigen::VectorXd variances = least->covariance.diagonal();
  TestField field;
  field.cameras = least->state.cameras;
  field.distortion = least->state.distortion();
  field.misfit = least->misfit;
  field.degrees_of_freedom = -4 - terms;
  for (std::size_t i = 0; i < views.size(); ++i) {
    field.deviations.push_back(DeviationsOf(variances, i));
    field.degrees_of_freedom += 2 * static_cast<int>(views[i].dots_px.size()) - kPose;
  }
  field.distortion_deviation = {terms > 0 ? std::sqrt(variances[4]) : 0,
                                terms > 1 ? std::sqrt(variances[5]) : 0};
  return field;
}

}  // namespace tranos::camera
