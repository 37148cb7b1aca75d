// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/camera_trials.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "camera/dlt.h"
#include "camera/likelihood.h"
#include "camera/orthocentre.h"
#include "camera/paper_method.h"

namespace tranos::bench {
namespace {

using camera::Camera;
using camera::benchmark::TracedCuboid;

struct Trial {
  Camera camera;
  bool has_sigmas = false;
  ParameterVector half_intervals = ParameterVector::Zero();  // 95 %, as the camera has it
  bool is_warned = false;
};

geom::Result<Trial> TrialOf(const geom::Result<Camera>& camera) {
  if (!camera) return tl::unexpected(camera.error());
  return Trial{*camera};
}

geom::Result<Trial> TrialOf(const geom::Result<camera::SweepResult>& sweep) {
  if (!sweep) return tl::unexpected(sweep.error());
  return Trial{sweep->camera};
}

geom::Result<Trial> Likeliest(const TracedCuboid& traced) {
  const auto estimate = camera::Calibrate(traced.photograph, traced.numbers);
  if (!estimate) return tl::unexpected(estimate.error());
  if (!estimate->complete())
    return tl::unexpected(geom::Error{geom::ErrorCode::kDegenerate, "not determined"});
  Trial trial{estimate->camera, true, {}, !estimate->warnings.empty()};
  for (int i = 0; i < kParameters; ++i)
    trial.half_intervals[i] = estimate->quantile95 * estimate->parameters[i].sigma;
  return trial;
}

geom::Result<Trial> Calibrated(Method method, const TracedCuboid& traced) {
  switch (method) {
    case kOrthocentre:
      return TrialOf(camera::CalibrateOrthocentre(traced.photograph, traced.numbers));
    case kDlt:
      return TrialOf(camera::CalibrateDlt(traced.photograph, traced.numbers));
    case kPaper:
      return TrialOf(camera::CalibratePaper(traced.photograph, traced.numbers));
    case kSweep:
      return TrialOf(camera::CalibrateSweep(traced.photograph, traced.numbers));
    default:
      return Likeliest(traced);
  }
}

}  // namespace

std::string Noise::name() const {
  return fmt::format("{} {:g}", picture == camera::benchmark::kHi ? "hi" : "lo", sigma_px);
}

ParameterVector InTableUnits(ParameterVector p) {
  p.segment<4>(camera::kSkew) *= 180 / camera::kPi;
  return p;
}

ParameterVector Errors::Mean() const {
  ParameterVector sum = ParameterVector::Zero();
  for (const ParameterVector& e : each) sum += e;
  return sum / static_cast<double>(each.size());
}

ParameterVector Errors::Deviation() const {
  const ParameterVector mean = Mean();
  ParameterVector sum = ParameterVector::Zero();
  for (const ParameterVector& e : each) sum += (e - mean).cwiseAbs2();
  return (sum / (static_cast<double>(each.size()) - 1)).cwiseSqrt();
}

ParameterVector Errors::Rmse() const {
  ParameterVector sum = ParameterVector::Zero();
  for (const ParameterVector& e : each) sum += e.cwiseAbs2();
  return (sum / static_cast<double>(each.size())).cwiseSqrt();
}

ParameterVector Errors::Median() const {
  ParameterVector median = ParameterVector::Constant(std::nan(""));
  if (each.empty()) return median;
  for (int i = 0; i < kParameters; ++i) {
    std::vector<double> sizes;
    for (const ParameterVector& e : each) sizes.push_back(std::abs(e[i]));
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::ranges::nth_element(sizes, middle);
    median[i] = *middle;
  }
  return median;
}

ParameterVector Errors::Coverage() const { return covered / static_cast<double>(each.size()); }

ParameterVector Errors::BiasInStandardErrors() const {
  return Mean().cwiseAbs().cwiseQuotient(Deviation()) * std::sqrt(static_cast<double>(each.size()));
}

Errors Simulate(const Cuboid& cuboid, const Noise& noise, Method method, int trials, int chosen) {
  Errors errors;
  errors.trials = trials;
  for (int i = 0; i < trials; ++i) {
    const auto seed =
        1 + static_cast<std::uint64_t>(i) + 100000 * static_cast<std::uint64_t>(chosen);
    const TracedCuboid traced = camera::benchmark::TraceCuboid(
        cuboid, {.picture = noise.picture, .sigma_px = noise.sigma_px, .seed = seed});
    const geom::Result<Trial> trial = Calibrated(method, traced);
    if (!trial) {
      ++errors.failures;
      continue;
    }
    ParameterVector error = trial->camera.parameters - cuboid.truth.parameters;
    errors.covered.array() += (error.array().abs() <= trial->half_intervals.array()).cast<double>();
    // Angles of turning without whole turns.
    for (int k = camera::kOmega; k <= camera::kKappa; ++k)
      error[k] = std::remainder(error[k], 2 * camera::kPi);
    errors.each.push_back(InTableUnits(error));
    errors.warned += trial->is_warned;
  }
  return errors;
}

ParameterVector BoundOf(const Cuboid& cuboid, const Noise& noise) {
  const TracedCuboid exact =
      camera::benchmark::TraceCuboid(cuboid, {.picture = noise.picture, .sigma_px = 0});
  const camera::CameraFit fit = camera::FitCamera(exact.photograph, exact.numbers, cuboid.truth);
  // Exact traces are declared with half a pixel.
  return InTableUnits(fit.information.inverse().diagonal().cwiseSqrt()) * noise.sigma_px / 0.5;
}

}  // namespace tranos::bench
