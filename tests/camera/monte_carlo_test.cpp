// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's Section 6 as it should have come out: simulated traces of the cuboid, adjusted a few
// thousand times, against the Cramér–Rao bounds of benchmarks/cuboid.json. Seeds: trial i of a case
// has seed i + 1 + 100000 × (case), cases in the order of the loops below.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <cstdio>

#include "camera/adjustment.h"
#include "camera/calibrate.h"
#include "camera/likelihood.h"
#include "camera/refinement.h"
#include "camera/start.h"
#include "tests/camera/scenes.h"

namespace tranos::camera {
namespace {

using benchmark::Cuboid;
using benchmark::CuboidOf;
using benchmark::Picture;
using benchmark::TraceCuboid;
using benchmark::TracedCuboid;

// Limits for fewer trials are wider by the same number of their standard errors.
#ifdef TRANOS_SANITIZED
constexpr int kTrials = 60;
constexpr double kWider = 5.8;
#else
constexpr int kTrials = 2000;
constexpr double kWider = 1;
#endif

constexpr const char* kNames[] = {"B1", "B2", "B3", "B4"};
struct Noise {
  Picture picture;
  double sigma_px;
};
constexpr Noise kNoises[] = {{benchmark::kHi, 0.1}, {benchmark::kHi, 0.25}, {benchmark::kHi, 0.5},
                             {benchmark::kHi, 1.0}, {benchmark::kLo, 0.25}, {benchmark::kLo, 0.5}};

std::uint64_t SeedOf(int trial, int chosen) {
  return static_cast<std::uint64_t>(trial + 1 + 100000 * chosen);
}

// Errors of many trials, and how often the truth was within 1.96 deviations.
struct Errors {
  int trials = 0;
  ParameterVector sum = ParameterVector::Zero();
  ParameterVector squares = ParameterVector::Zero();
  ParameterVector covered = ParameterVector::Zero();

  void Add(const ParameterVector& error, const ParameterVector& sigma) {
    ++trials;
    sum += error;
    squares += error.cwiseProduct(error);
    covered.array() += (error.array().abs() <= 1.959963984540054 * sigma.array()).cast<double>();
  }
  double Rmse(int i) const { return std::sqrt(squares[i] / trials); }
  double Bias(int i) const { return sum[i] / trials; }
  double BiasError(int i) const {
    return std::sqrt((squares[i] / trials - Bias(i) * Bias(i)) / trials);
  }
  double Coverage(int i) const { return covered[i] / trials; }
};

ParameterVector SigmasOf(const ParameterMatrix& information) {
  return information.inverse().diagonal().cwiseSqrt();
}

Errors Simulate(const Cuboid& cuboid, const Noise& noise, int chosen) {
  Errors errors;
  for (int i = 0; i < kTrials; ++i) {
    const TracedCuboid traced = TraceCuboid(
        cuboid, {.picture = noise.picture, .sigma_px = noise.sigma_px, .seed = SeedOf(i, chosen)});
    const CameraFit fit = FitCamera(traced.photograph, traced.numbers, cuboid.truth);
    EXPECT_TRUE(fit.converged);
    errors.Add(fit.camera.parameters - cuboid.truth.parameters, SigmasOf(fit.information));
    // From the linear start, too, the same camera is reached.
    if (i % 50 != 0) continue;
    const CameraFit from_start =
        FitCamera(traced.photograph, traced.numbers, Starts(traced.photograph, traced.numbers)[0]);
    EXPECT_TRUE(from_start.converged);
    EXPECT_NEAR(from_start.chi2, fit.chi2, 1e-7 * fit.chi2);
  }
  return errors;
}

TEST(MonteCarlo, ReachesTheBoundInEachOf264) {
  double worst = 0, sum = 0, farthest = 0, lowest = 1, highest = 0;
  int count = 0, chosen = 0;
  for (const char* name : kNames) {
    const Cuboid& cuboid = CuboidOf(name);
    for (const Noise& noise : kNoises) {
      const Errors errors = Simulate(cuboid, noise, ++chosen);
      for (int i = 0; i < kParameters; ++i) {
        SCOPED_TRACE(std::string(name) + " " + kParameterNames[i] + " " +
                     std::to_string(noise.sigma_px));
        const double ratio = errors.Rmse(i) / (noise.sigma_px * cuboid.bound[noise.picture][i]);
        const double bias = std::abs(errors.Bias(i)) / errors.BiasError(i);
        EXPECT_LE(ratio, 1 + 0.06 * kWider);
        EXPECT_LE(bias, 4);
        EXPECT_NEAR(errors.Coverage(i), 0.95, 0.02 * kWider);
        worst = std::max(worst, ratio), sum += ratio, farthest = std::max(farthest, bias);
        lowest = std::min(lowest, errors.Coverage(i));
        highest = std::max(highest, errors.Coverage(i));
        ++count;
      }
    }
  }
  EXPECT_EQ(count, 264);
  EXPECT_LE(sum / count, 1 + 0.01 * kWider);
  std::printf(
      "RMSE/CRLB: worst %.4f, mean %.4f; |bias|/standard error: worst %.2f; coverage %.4f "
      "to %.4f (%d trials)\n",
      worst, sum / count, farthest, lowest, highest, kTrials);
}

TEST(MonteCarlo, IsTenTimesBetterThanThePaper) {
  // mm, degrees, m at half a pixel of the high resolution; the paper printed 0.16, 0.88, 0.74 mm;
  // 0.15°, 0.21°, 0.71°; 0.62, 0.92, 0.48 m.
  const struct {
    const char* name;
    double f, alpha;
  } limits[] = {{"B1", 0.015, 0.016}, {"B2", 0.037, 0.013}, {"B3", 0.010, 0.005}};
  int chosen = 100;
  for (const auto& [name, f, alpha] : limits) {
    const Errors errors = Simulate(CuboidOf(name), {benchmark::kHi, 0.5}, ++chosen);
    const double alpha_deg = errors.Rmse(kSkew) * 180 / kPi;
    EXPECT_LE(errors.Rmse(kFocal), f * (1 + 0.06 * (kWider - 1))) << name;
    EXPECT_LE(alpha_deg, alpha * (1 + 0.06 * (kWider - 1))) << name;
    EXPECT_LE(errors.Rmse(kX0), 0.006 * (1 + 0.06 * (kWider - 1))) << name;
    std::printf("%s: RMSE f %.4f mm, alpha %.4f deg, X0 %.4f m\n", name, errors.Rmse(kFocal),
                alpha_deg, errors.Rmse(kX0));
  }
}

// Dimensions as unknowns with a deviation: Gauss–Newton on the joint residuals, from the truth.
struct JointFit {
  Eigen::VectorXd state;
  Eigen::MatrixXd covariance;
};

JointFit FitJointly(const Cuboid& cuboid, const TracedCuboid& traced) {
  const std::span<const Photograph> one(&traced.photograph, 1);
  const Layout layout = LayoutOf(one, traced.unknowns);
  JointFit fit;
  fit.state.resize(layout.columns);
  fit.state << cuboid.truth.parameters, cuboid.dimensions_m;
  for (int i = 0; i < 20; ++i) {
    const Numbers numbers = benchmark::NumbersOf(cuboid, fit.state.tail<3>(), 3);
    const Linearised at = *Linearise(one, traced.unknowns, layout, numbers, fit.state);
    const Eigen::VectorXd scale = at.jacobian.colwise().norm().cwiseInverse();
    const Eigen::MatrixXd j = at.jacobian * scale.asDiagonal();
    const Eigen::MatrixXd inverse = (j.transpose() * j).inverse();
    const Eigen::VectorXd step = -inverse * (j.transpose() * at.residuals);
    fit.state += scale.asDiagonal() * step;
    fit.covariance = scale.asDiagonal() * inverse * scale.asDiagonal();
    if (step.norm() < 1e-6) break;
  }
  return fit;
}

TEST(MonteCarlo, IntervalsCoverWhenDimensionsAreUncertain) {
  double lowest = 1, highest = 0;
  int chosen = 200;
  for (const char* name : kNames) {
    const Cuboid& cuboid = CuboidOf(name);
    for (const double relative : {0.001, 0.005, 0.02}) {
      Errors errors;
      ++chosen;
      for (int i = 0; i < kTrials; ++i) {
        const TracedCuboid traced = TraceCuboid(
            cuboid, {.sigma_px = 0.5, .seed = SeedOf(i, chosen), .dimension_sigma = relative});
        const JointFit fit = FitJointly(cuboid, traced);
        const ParameterVector sigma = fit.covariance.diagonal().head<kParameters>().cwiseSqrt();
        errors.Add(fit.state.head<kParameters>() - cuboid.truth.parameters, sigma);
        if (i % 200 != 0) continue;
        // What the program itself does with it.
        const std::span<const Photograph> one(&traced.photograph, 1);
        const Layout layout = LayoutOf(one, traced.unknowns);
        Eigen::VectorXd start(layout.columns);
        start << cuboid.truth.parameters, traced.dimensions_m;
        const auto refined = Refine(
            one, traced.unknowns, layout,
            [&](const Eigen::VectorXd& u) -> geom::Result<Numbers> {
              return benchmark::NumbersOf(cuboid, u, 3);
            },
            start);
        ASSERT_TRUE(refined.has_value());
        for (int k = 0; k < kParameters; ++k) {
          EXPECT_NEAR(refined->state[k], fit.state[k], 1e-4 * sigma[k]);
        }
      }
      for (int i = 0; i < kParameters; ++i) {
        EXPECT_NEAR(errors.Coverage(i), 0.95, 0.02 * kWider)
            << name << " " << relative << " " << kParameterNames[i];
        lowest = std::min(lowest, errors.Coverage(i));
        highest = std::max(highest, errors.Coverage(i));
      }
    }
  }
  std::printf("coverage with uncertain dimensions: %.4f to %.4f\n", lowest, highest);
}

TEST(MonteCarlo, FixedDimensionsThatAreWrongSpoilTheIntervals) {
  // The same with the dimensions taken as exact: what DESIGN.md warns of.
  const Cuboid& cuboid = CuboidOf("B1");
  Errors errors;
  for (int i = 0; i < kTrials / 4; ++i) {
    const TracedCuboid traced =
        TraceCuboid(cuboid, {.sigma_px = 0.5, .seed = SeedOf(i, 300), .dimension_sigma = 0.02});
    const CameraFit fit = FitCamera(traced.photograph, traced.numbers, cuboid.truth);
    errors.Add(fit.camera.parameters - cuboid.truth.parameters, SigmasOf(fit.information));
  }
  EXPECT_LT(errors.Coverage(kX0), 0.2);
}

// With few degrees of freedom: 7 for nine edges, 3 for seven.
TEST(MonteCarlo, StudentsIntervalsCoverWhenTheNoiseIsEstimated) {
  int chosen = 500;
  for (const char* name : {"B1", "B4"}) {
    const Cuboid& cuboid = CuboidOf(name);
    Errors student, normal;
    ++chosen;
    for (int i = 0; i < kTrials / 2; ++i) {
      const TracedCuboid traced = TraceCuboid(cuboid, {.sigma_px = 0.5, .seed = SeedOf(i, chosen)});
      CalibrateOptions options;
      options.noise_is_estimated = true;
      const auto estimate = Calibrate(traced.photograph, traced.numbers, options);
      ASSERT_TRUE(estimate.has_value());
      ParameterVector sigma;
      for (int k = 0; k < kParameters; ++k) sigma[k] = estimate->parameters[k].sigma;
      const ParameterVector error = estimate->camera.parameters - cuboid.truth.parameters;
      student.Add(error, sigma * estimate->quantile95 / 1.959963984540054);
      normal.Add(error, sigma);
    }
    double mean = 0;
    for (int i = 0; i < kParameters; ++i) {
      EXPECT_NEAR(student.Coverage(i), 0.95, 0.028 * kWider) << name << " " << kParameterNames[i];
      EXPECT_LE(normal.Coverage(i), student.Coverage(i));
      mean += normal.Coverage(i) / static_cast<double>(kParameters);
    }
    EXPECT_LT(mean, 0.93 + 0.01 * (kWider - 1));
    std::printf("%s, noise estimated: Student's t covers %.4f of f, normal quantiles %.4f\n", name,
                student.Coverage(kFocal), normal.Coverage(kFocal));
  }
}

// At tilts or pans where vanishing points are far away or at infinity.
TEST(MonteCarlo, SmallTiltAndPanDoNoHarm) {
  double worst = 0, widest = 0;
  int chosen = 400;
  for (const char* name : kNames) {
    for (const Parameter parameter : {kOmega, kPhi}) {
      Cuboid cuboid = CuboidOf(name);
      const double sign = cuboid.truth[parameter] < 0 ? -1 : 1;
      ParameterVector at_ten = ParameterVector::Zero();
      for (const double degrees : {10.0, 1.0, 0.1, 0.0}) {
        cuboid.truth[parameter] = sign * degrees * kPi / 180;
        const TracedCuboid exact = TraceCuboid(cuboid, {});
        const ParameterVector bound =
            SigmasOf(FitCamera(exact.photograph, exact.numbers, cuboid.truth).information);
        if (degrees == 10.0) {
          at_ten = bound;
          continue;
        }
        Errors errors;
        ++chosen;
        for (int i = 0; i < kTrials; ++i) {
          const TracedCuboid traced =
              TraceCuboid(cuboid, {.sigma_px = 0.5, .seed = SeedOf(i, chosen)});
          const CameraFit fit = FitCamera(traced.photograph, traced.numbers, cuboid.truth);
          errors.Add(fit.camera.parameters - cuboid.truth.parameters, SigmasOf(fit.information));
          if (i % 100 != 0) continue;
          const CameraFit from_start = FitCamera(traced.photograph, traced.numbers,
                                                 Starts(traced.photograph, traced.numbers)[0]);
          EXPECT_NEAR(from_start.chi2, fit.chi2, 1e-7 * fit.chi2);
        }
        for (int i = 0; i < kParameters; ++i) {
          const double ratio = errors.Rmse(i) / bound[i], wider = bound[i] / at_ten[i];
          EXPECT_LE(ratio, 1 + 0.1 * kWider) << name << " " << kParameterNames[i] << " " << degrees;
          EXPECT_LE(wider, 3) << name << " " << kParameterNames[i] << " " << degrees;
          worst = std::max(worst, ratio), widest = std::max(widest, wider);
        }
      }
    }
  }
  std::printf(
      "tilt and pan of 1, 0.1 and 0 degrees: RMSE/CRLB at most %.4f, CRLB at most %.3f of "
      "that at 10 degrees\n",
      worst, widest);
}

}  // namespace
}  // namespace tranos::camera
