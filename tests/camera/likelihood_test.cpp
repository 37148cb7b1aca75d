// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/likelihood.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/camera/scenes.h"

namespace tranos::camera {
namespace {

using benchmark::Cuboid;
using benchmark::Cuboids;
using benchmark::Picture;
using benchmark::TraceCuboid;
using benchmark::TracedCuboid;

Camera Near(const Camera& truth, std::uint64_t seed) {
  scenes::Noise noise(seed);
  Camera camera = truth;
  for (int i = 0; i < kParameters; ++i) {
    const double size = i < 1 ? 1.0 : i == kAspect || i == kSkew ? 0.01 : i < kX0 ? 0.02 : 0.3;
    camera.parameters[i] += size * noise.Draw();
  }
  return camera;
}

TEST(Likelihood, FindsTheCameraOfExactEdges) {
  for (const Cuboid& cuboid : Cuboids()) {
    const TracedCuboid traced = TraceCuboid(cuboid, {});
    const CameraFit fit = FitCamera(traced.photograph, traced.numbers, Near(cuboid.truth, 3));
    EXPECT_TRUE(fit.converged) << cuboid.name;
    for (int i = 0; i < kParameters && cuboid.determined(); ++i) {
      const double truth = cuboid.truth.parameters[i];
      EXPECT_NEAR(fit.camera.parameters[i], truth, 1e-8 * std::max(1.0, std::abs(truth)))
          << cuboid.name << " " << kParameterNames[i];
    }
  }
}

TEST(Likelihood, ConvergesFromNearAndFromTheSolutionItself) {
  for (const Cuboid& cuboid : Cuboids()) {
    if (!cuboid.determined()) continue;
    for (const double sigma_px : {0.01, 0.1, 0.5}) {
      for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        const TracedCuboid traced = TraceCuboid(cuboid, {.sigma_px = sigma_px, .seed = seed});
        const CameraFit fit = FitCamera(traced.photograph, traced.numbers, cuboid.truth);
        const CameraFit again = FitCamera(traced.photograph, traced.numbers, fit.camera);
        EXPECT_TRUE(fit.converged && again.converged) << cuboid.name << " " << seed;
        EXPECT_LE(fit.iterations, 15) << cuboid.name << " " << seed;
        EXPECT_LE(again.iterations, 5) << cuboid.name << " " << seed;
      }
    }
  }
}

TEST(Likelihood, ItsInformationIsTheBenchmarksBound) {
  for (const Cuboid& cuboid : Cuboids()) {
    if (!cuboid.determined()) continue;
    for (const Picture picture : {benchmark::kHi, benchmark::kLo}) {
      const TracedCuboid traced = TraceCuboid(cuboid, {.picture = picture});
      const CameraFit fit = FitCamera(traced.photograph, traced.numbers, cuboid.truth);
      const ParameterMatrix covariance = fit.information.inverse();
      for (int i = 0; i < kParameters; ++i) {
        // Exact traces are declared with half a pixel.
        const double bound = 0.5 * cuboid.bound[picture][i];
        EXPECT_NEAR(std::sqrt(covariance(i, i)), bound, 1e-5 * bound)
            << cuboid.name << " " << kParameterNames[i];
      }
    }
  }
}

TEST(Likelihood, OfAHeldSkewIsNeverAboveTheFreeOnes) {
  const Cuboid& cuboid = benchmark::CuboidOf("B2");
  const TracedCuboid traced = TraceCuboid(cuboid, {.sigma_px = 0.5, .seed = 9});
  const CameraFit free = FitCamera(traced.photograph, traced.numbers, cuboid.truth);
  const double sigma = std::sqrt(free.information.inverse()(kSkew, kSkew));
  for (const double away : {-2.0, -1.0, 0.0, 1.0, 2.0}) {
    const double alpha = free.camera[kSkew] + away * sigma;
    const CameraFit held = FitCamera(traced.photograph, traced.numbers, free.camera, alpha);
    EXPECT_EQ(held.camera[kSkew], alpha);
    // The profile is a parabola of the analytic width to a few per cent.
    EXPECT_NEAR(held.chi2 - free.chi2, away * away, 0.05 * away * away + 1e-9);
  }
}

TEST(Likelihood, APriorPullsByItsShareOfTheInformation) {
  const Cuboid& cuboid = benchmark::CuboidOf("B1");
  TracedCuboid traced = TraceCuboid(cuboid, {.sigma_px = 0.5, .seed = 2});
  const CameraFit data = FitCamera(traced.photograph, traced.numbers, cuboid.truth);
  const double variance = data.information.inverse()(kFocal, kFocal);
  // As sure as the data, a deviation away: half-way.
  traced.photograph.priors[kFocal] = {data.camera[kFocal] + std::sqrt(variance),
                                      std::sqrt(variance)};
  const CameraFit both = FitCamera(traced.photograph, traced.numbers, cuboid.truth);
  EXPECT_NEAR(both.camera[kFocal] - data.camera[kFocal], 0.5 * std::sqrt(variance),
              0.02 * std::sqrt(variance));
  EXPECT_NEAR(both.information.inverse()(kFocal, kFocal), 0.5 * variance, 0.02 * variance);
}

TEST(Likelihood, TellsTheCameraThatLooksAway) {
  const Cuboid& cuboid = benchmark::CuboidOf("B3");
  const TracedCuboid traced = TraceCuboid(cuboid, {});
  EXPECT_TRUE(SeesTraces(traced.photograph, traced.numbers, cuboid.truth));
  Camera away = cuboid.truth;
  away[kPhi] += kPi;
  EXPECT_FALSE(SeesTraces(traced.photograph, traced.numbers, away));
}

}  // namespace
}  // namespace tranos::camera
