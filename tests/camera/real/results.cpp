// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/camera/real/results.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "camera/default_priors.h"
#include "camera/orthocentre.h"

namespace tranos::camera::real {
namespace {

constexpr double kEndSigmaPx = 1;  // only a unit, as the noise is estimated

double Angle(const Mat3& turn) { return Eigen::AngleAxisd(turn).angle() * 180 / kPi; }

// A turn by half a circle about Z: facades show their directions, not which way along them is
// which.
Mat3 HalfTurn() { return Vec3(-1, -1, 1).asDiagonal(); }

void SetNoise(Photograph& photograph, double sigma_px) {
  for (Trace& trace : photograph.traces) {
    if (auto* edge = std::get_if<DirectionTrace>(&trace)) {
      edge->line.centre_sigma_px *= sigma_px / kEndSigmaPx;
      edge->line.tilt_sigma_px *= sigma_px / kEndSigmaPx;
    }
    if (auto* point = std::get_if<PointTrace>(&trace)) point->sigma_px = sigma_px;
  }
}

Square SquareOf(const Camera& camera, const Frame& frame) {
  return {camera[kFocal] / frame.pitch_mm().x(),
          frame.DotFromPoint({camera[kPrincipalX], camera[kPrincipalY]})};
}

bool IsTwice(const geom::Error& error, const Photograph& photograph) {
  return error.code == geom::ErrorCode::kDegenerate && error.part >= 0 &&
         std::holds_alternative<DirectionTrace>(photograph.traces[error.part]);
}

}  // namespace

Traced TracedDirections(const Known& known) {
  Traced traced;
  traced.photograph.name = known.name;
  traced.photograph.frame = known.frame;
  for (const Segment& segment : known.segments) {
    const auto line = FitImageLine({segment.a_px, segment.b_px}, kEndSigmaPx);
    if (line) traced.photograph.traces.push_back(DirectionTrace{*line, segment.axis});
  }
  return traced;
}

Traced TracedEdges(const Known& known) {
  Known others = known;
  const auto upright_length = [](const Segment& s) {
    return s.axis == 2 ? (s.b_px - s.a_px).norm() : 0.0;
  };
  const auto longest = std::ranges::max_element(others.segments, {}, upright_length);
  Vec2 below = longest->a_px, above = longest->b_px;
  if (below.y() < above.y()) std::swap(below, above);
  others.segments.erase(longest);
  Traced traced = TracedDirections(others);
  traced.photograph.traces.push_back(PointTrace{below, kEndSigmaPx, 0});
  traced.photograph.traces.push_back(PointTrace{above, kEndSigmaPx, 3});
  traced.numbers = {(Eigen::VectorXd(6) << 0, 0, 0, 0, 0, 3).finished(), Eigen::MatrixXd(6, 0)};
  return traced;
}

void AssumeDefaults(Photograph& photograph) {
  const auto standard = DefaultPriors(photograph.frame);
  std::ranges::copy(standard, photograph.priors);
}

Found FoundCamera(Traced traced, Loss loss) {
  Photograph& photograph = traced.photograph;
  AssumeDefaults(photograph);
  CalibrateOptions options;
  options.loss = loss;
  options.noise_px = kEndSigmaPx;
  options.noise_is_estimated = true;
  auto estimate = Calibrate(photograph, traced.numbers, options);
  while (!estimate && IsTwice(estimate.error(), photograph)) {
    photograph.traces.erase(photograph.traces.begin() + estimate.error().part);
    estimate = Calibrate(photograph, traced.numbers, options);
  }
  Found found;
  found.name = photograph.name;
  found.edges = static_cast<int>(std::ranges::count_if(
      photograph.traces, [](const Trace& t) { return std::holds_alternative<DirectionTrace>(t); }));
  found.edges += traced.numbers.values.size() > 0 ? 1 : 0;
  if (!estimate) return found;
  const Camera& camera = estimate->camera;
  found.camera_from_world = CameraFromWorld(camera.parameters);
  found.dot_from_camera = photograph.frame.DotFromFrame() * FrameFromCamera(camera.parameters);
  if (estimate->parameters[kFocal].free()) return found;
  const double pitch_mm = photograph.frame.pitch_mm().x();
  found.focal_px = camera[kFocal] / pitch_mm;
  found.sigma_px = estimate->parameters[kFocal].sigma / pitch_mm;
  found.noise_px = estimate->noise_px;
  found.is_found = true;
  return found;
}

std::vector<Found> FoundCameras(const std::vector<Known>& photographs, Loss loss) {
  std::vector<Found> found;
  for (const Known& known : photographs) found.push_back(FoundCamera(TracedEdges(known), loss));
  return found;
}

std::vector<double> FocalErrors(const std::vector<Found>& found, const std::vector<Known>& known,
                                Loose loose) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const bool counts = found[i].is_found && (loose == Loose::kCounts || !found[i].is_loose());
    errors.push_back(counts ? std::abs(found[i].focal_px / known[i].focal_px - 1)
                            : std::numeric_limits<double>::infinity());
  }
  return errors;
}

double RotationErrorUpToSigns(const Mat3& found, const Mat3& truth) {
  double least = 180;
  for (int signs = 0; signs < 8; ++signs) {
    const Vec3 sign(signs & 1 ? -1 : 1, signs & 2 ? -1 : 1, signs & 4 ? -1 : 1);
    const Mat3 turn = found * (truth * sign.asDiagonal()).transpose();
    if (turn.determinant() > 0) least = std::min(least, Angle(turn));
  }
  return least;
}

std::vector<double> RelativeRotationErrors(const std::vector<Found>& found,
                                           const std::vector<Known>& known) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Mat3 truth = known[i].camera_from_world * known[j].camera_from_world.transpose();
      const auto error = [&](const Mat3& to_other_side) {
        return Angle(found[i].camera_from_world * to_other_side *
                     found[j].camera_from_world.transpose() * truth.transpose());
      };
      errors.push_back(std::min(error(Mat3::Identity()), error(HalfTurn())));
    }
  }
  return errors;
}

std::vector<Mat3> TrueRotations(const std::vector<Found>& found, const std::vector<Known>& known,
                                int alike) {
  // So many times the azimuth, so that turns that are alike do not count.
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Vec3 x = known[i].camera_from_world.transpose() * found[i].camera_from_world.col(0);
    sum += std::pow(std::complex<double>(x.x(), x.y()), alike);
  }
  const double azimuth = std::arg(sum) / alike;
  Mat3 world_from_castle;  // the survey's Z is downward
  world_from_castle.col(0) = Vec3(std::cos(azimuth), std::sin(azimuth), 0);
  world_from_castle.col(2) = -Vec3::UnitZ();
  world_from_castle.col(1) = world_from_castle.col(2).cross(world_from_castle.col(0));
  std::vector<Mat3> rotations;
  for (const Known& photograph : known)
    rotations.push_back(photograph.camera_from_world * world_from_castle);
  return rotations;
}

std::vector<double> RotationErrors(const std::vector<Found>& found, const std::vector<Known>& known,
                                   int alike) {
  const std::vector<Mat3> truth = TrueRotations(found, known, alike);
  std::vector<double> errors;
  for (std::size_t i = 0; i < found.size(); ++i) {
    double least = 180;
    for (int k = 0; k < alike; ++k) {
      const Eigen::AngleAxisd turn(2 * kPi * k / alike, Vec3::UnitZ());
      least = std::min(least, Angle(found[i].camera_from_world * turn.toRotationMatrix() *
                                    truth[i].transpose()));
    }
    errors.push_back(least);
  }
  return errors;
}

std::vector<double> UprightErrors(const std::vector<Found>& found,
                                  const std::vector<Known>& known) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Vec3 up = -known[i].camera_from_world.col(2);
    const double cosine = found[i].camera_from_world.col(2).dot(up.normalized());
    errors.push_back(std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / kPi);
  }
  return errors;
}

std::optional<Square> SquareByOrthocentre(const Known& known) {
  const auto camera = CalibrateOrthocentre(TracedDirections(known).photograph, {});
  if (!camera) return {};
  return SquareOf(*camera, known.frame);
}

std::optional<Square> SquareByLikelihood(const Known& known) {
  Traced traced = TracedEdges(known);
  SetNoise(traced.photograph, 0.01);  // fSpy takes its lines as they stand
  traced.photograph.priors[kAspect] = {1, 1e-6};
  traced.photograph.priors[kSkew] = {kPi / 2, 1e-6};
  const auto estimate = Calibrate(traced.photograph, traced.numbers);
  if (!estimate || estimate->parameters[kFocal].free()) return {};
  return SquareOf(estimate->camera, known.frame);
}

double Coverage(const std::vector<Found>& found, const std::vector<Known>& known) {
  int all = 0, covered = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!found[i].is_found) continue;
    ++all;
    covered += std::abs(found[i].focal_px - known[i].focal_px) <= 1.96 * found[i].sigma_px;
  }
  return static_cast<double>(covered) / all;
}

double Quantile(std::vector<double> values, double p) {
  std::ranges::sort(values);
  const double at = p * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const double beyond = at - static_cast<double>(below);
  // An infinite neighbour counts only if it has a share.
  return beyond > 0 ? values[below] + beyond * (values[below + 1] - values[below]) : values[below];
}

}  // namespace tranos::camera::real
