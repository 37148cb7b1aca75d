// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/calibrate.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/camera/comparison.h"
#include "tests/camera/scenes.h"

namespace tranos::camera {
namespace {

using benchmark::Cuboid;
using benchmark::CuboidOf;
using benchmark::Cuboids;
using benchmark::Mentions;
using benchmark::TraceCuboid;
using benchmark::TracedCuboid;
using scenes::Scene;
using scenes::Townhouse;

#ifdef TRANOS_SANITIZED
constexpr int kSeeds = 20;
#else
constexpr int kSeeds = 1000;
#endif

void ExpectSame(const Camera& found, const Camera& truth, double tolerance) {
  for (int i = 0; i < kParameters; ++i) {
    EXPECT_NEAR(found.parameters[i], truth.parameters[i],
                tolerance * std::max(1.0, std::abs(truth.parameters[i])))
        << kParameterNames[i];
  }
}

TEST(Calibrate, FindsAllElevenParametersOfExactTraces) {
  for (const Cuboid& cuboid : Cuboids()) {
    if (!cuboid.determined()) continue;
    SCOPED_TRACE(cuboid.name);
    const TracedCuboid traced = TraceCuboid(cuboid, {});
    const auto estimate = Calibrate(traced.photograph, traced.numbers);
    ASSERT_TRUE(estimate.has_value()) << estimate.error().detail;
    ExpectSame(estimate->camera, cuboid.truth, 1e-8);
    EXPECT_TRUE(estimate->determined());
    EXPECT_TRUE(estimate->undetermined.empty());
    EXPECT_LT(estimate->chi2, 1e-16);
  }
}

TEST(Calibrate, FindsTheTownhouseOfEverything) {
  const Scene scene = Townhouse();
  const auto estimate = Calibrate(scene.photograph, scene.list.numbers());
  ASSERT_TRUE(estimate.has_value()) << estimate.error().detail;
  ExpectSame(estimate->camera, scene.truth, 1e-8);
  EXPECT_EQ(estimate->residuals.size(), scene.photograph.traces.size());
}

TEST(Calibrate, FindsACameraOfControlPointsAlone) {
  Scene scene;
  scene.truth = Townhouse().truth;
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(10, 0, 0), Vec3(10, 0, 8), Vec3(0, 0, 8),
                        Vec3(10, 12, 0), Vec3(10, 12, 8), Vec3(4, 0, 11)}) {
    scene.Point(p);
  }
  const auto estimate = Calibrate(scene.photograph, scene.list.numbers());
  ASSERT_TRUE(estimate.has_value()) << estimate.error().detail;
  ExpectSame(estimate->camera, scene.truth, 1e-8);
}

TEST(Calibrate, SharesAddUpAndFollowTheirSources) {
  const Cuboid& cuboid = CuboidOf("B1");
  TracedCuboid traced = TraceCuboid(cuboid, {.sigma_px = 0.1, .seed = 3, .dimension_sigma = 0.02});
  traced.photograph.priors[kAspect] = {1, 0.0001};
  const auto estimates = Calibrate(std::vector{traced.photograph}, traced.unknowns,
                                   [&](const Eigen::VectorXd& u) -> geom::Result<Numbers> {
                                     return benchmark::NumbersOf(cuboid, u, 3);
                                   });
  ASSERT_TRUE(estimates.has_value()) << estimates.error().detail;
  const Estimate& estimate = estimates->front();
  for (const ParameterEstimate& parameter : estimate.parameters) {
    const Shares& s = parameter.shares;
    EXPECT_NEAR(s.pixels + s.metric + s.priors, 1, 1e-12);
  }
  // Two per cent of the dimensions are more than a tenth of a pixel (DESIGN.md), and nothing but
  // the prior knows the aspect to a ten-thousandth.
  EXPECT_GT(estimate.parameters[kX0].shares.metric, 0.9);
  EXPECT_GT(estimate.parameters[kAspect].shares.priors, 0.5);
  EXPECT_EQ(estimate.unknowns.size(), 3u);
  EXPECT_EQ(estimate.covariance.rows(), kParameters + 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(estimate.unknowns[i].value, cuboid.dimensions_m[i], 4 * estimate.unknowns[i].sigma);
    EXPECT_NEAR(estimate.covariance(kParameters + i, kParameters + i),
                estimate.unknowns[i].sigma * estimate.unknowns[i].sigma, 1e-15);
  }
}

TEST(Calibrate, AnUnknownThatTheEdgesShowIsFound) {
  // Only the height is known; width and depth are unknowns without priors, far from their starts.
  const Cuboid& cuboid = CuboidOf("B4");
  TracedCuboid traced = TraceCuboid(cuboid, {.dimension_sigma = 1e-9});
  std::vector<Unknown> unknowns = traced.unknowns;
  for (int i = 0; i < 2; ++i) {
    unknowns[i].start = 1.02 * cuboid.dimensions_m[i];
    unknowns[i].sigma = 0;
  }
  Photograph photograph = traced.photograph;
  // Of one photograph that leaves two directions; a skew and an aspect that are known close them.
  photograph.priors[kSkew] = {cuboid.truth[kSkew], 1e-6};
  photograph.priors[kAspect] = {cuboid.truth[kAspect], 1e-6};
  const auto estimates = Calibrate(std::vector{photograph}, unknowns,
                                   [&](const Eigen::VectorXd& u) -> geom::Result<Numbers> {
                                     return benchmark::NumbersOf(cuboid, u, 3);
                                   });
  ASSERT_TRUE(estimates.has_value()) << estimates.error().detail;
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(estimates->front().unknowns[i].value, cuboid.dimensions_m[i],
                1e-5 * cuboid.dimensions_m[i]);
  }
}

// One facade in the plane y = 0: edges, a window, and what else there may be.
Scene OneFacade(std::uint64_t seed) {
  Scene scene;
  scene.truth = Townhouse().truth;
  const scenes::Wall front{Vec3(0, 0, 0), 0, 0};
  scene.Rectangle(front, 0, 0, 10, 6);
  scene.Rectangle(front, 2, 1, 1.5, 2);
  scene.Direction({1, 0, 5}, {9, 0, 5}, 0);
  scene.Direction({1, 0, 4}, {8, 0, 4}, 0);
  scene.Direction({8, 0, 1}, {8, 0, 5}, 2);
  scenes::Noise noise(seed);
  for (Trace& trace : scene.photograph.traces) {
    if (auto* rectangle = std::get_if<RectangleTrace>(&trace)) {
      for (Vec2& dot : rectangle->dots_px) dot += 0.5 * noise.Draw2();
    } else if (auto* direction = std::get_if<DirectionTrace>(&trace)) {
      direction->line.a_px += 0.5 * noise.Draw2();
      direction->line.b_px += 0.5 * noise.Draw2();
    }
  }
  return scene;
}

// Seven edges of a box of 10 m by 6 m whose depth is unknown: one parameter of the camera and the
// depth trade off, and nothing but the depth's own deviation holds them.
geom::Result<std::vector<Estimate>> BoxOfUnknownDepth(const Unknown& depth) {
  Scene scene;
  scene.photograph.frame = {{36, 24.0075}, {1600, 1067}};
  scene.truth.parameters << 35, 1, 0, 0, 89 * kPi / 180, 12 * kPi / 180, 25 * kPi / 180,
      0.5 * kPi / 180, 22, -24, 2;
  constexpr double kDepth_m = 14;
  const Vec3 corners[] = {{0, 0, 0},  {10, 0, 0},        {0, 0, 6},
                          {10, 0, 6}, {10, kDepth_m, 0}, {10, kDepth_m, 6}};
  for (const auto& [from, to] : {std::pair(0, 1), {2, 3}, {0, 2}, {1, 3}, {1, 4}, {3, 5}, {4, 5}}) {
    scene.Edge(corners[from], corners[to]);
  }
  return Calibrate(std::vector{scene.photograph}, std::vector{depth},
                   [&](const Eigen::VectorXd& u) -> geom::Result<Numbers> {
                     Numbers numbers = scene.list.numbers(1);
                     for (Eigen::Index i = 1; i < numbers.values.size(); i += 3) {
                       if (numbers.values[i] != kDepth_m) continue;
                       numbers.values[i] = u[0];
                       numbers.by_unknown(i, 0) = 1;
                     }
                     return numbers;
                   });
}

TEST(Calibrate, WhatOnlyAnUnknownsDeviationHoldsIsOwedToIt) {
  for (const double sigma : {0.28, 1.3}) {
    SCOPED_TRACE(sigma);
    const auto estimates = BoxOfUnknownDepth({"depth", 13, sigma});
    ASSERT_TRUE(estimates.has_value()) << estimates.error().detail;
    const Estimate& estimate = estimates->front();
    // Any depth explains exact dots, so that its own mean costs nothing.
    EXPECT_NEAR(estimate.unknowns[0].value, 13, 1e-6);
    EXPECT_LT(estimate.chi2, 1e-12);
    EXPECT_NEAR(estimate.unknowns[0].sigma, sigma, 1e-4 * sigma);
    // Nothing else tells of the depth, so that what is owed to it is what goes along with it.
    const Eigen::MatrixXd& covariance = estimate.covariance;
    const double depth_variance = covariance(kParameters, kParameters);
    for (int i = 0; i < kParameters; ++i) {
      const ParameterEstimate& parameter = estimate.parameters[i];
      if (parameter.free()) continue;
      const double along = covariance(i, kParameters);
      EXPECT_NEAR(parameter.shares.metric, along * along / depth_variance / covariance(i, i), 1e-4)
          << kParameterNames[i];
    }
    EXPECT_GT(estimate.parameters[kFocal].shares.metric, 0.6);
  }
}

TEST(Calibrate, ALooseDeviationIsNamedAsWhatLeavesAnAngleOpen) {
  const auto loose = BoxOfUnknownDepth({"depth", 13, 1.3});
  ASSERT_TRUE(loose.has_value()) << loose.error().detail;
  EXPECT_TRUE(loose->front().parameters[kPhi].free());
  EXPECT_TRUE(
      Mentions(loose->front().undetermined, "only the stated deviation of `depth` holds pan"));
  const auto close = BoxOfUnknownDepth({"depth", 13, 0.28});
  ASSERT_TRUE(close.has_value()) << close.error().detail;
  EXPECT_TRUE(close->front().determined());
  EXPECT_TRUE(close->front().undetermined.empty());
}

TEST(Calibrate, OneFacadeNeverShowsTheSkew) {
  int refused = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const Scene scene = OneFacade(static_cast<std::uint64_t>(seed));
    const auto estimate = Calibrate(scene.photograph, scene.list.numbers());
    ASSERT_TRUE(estimate.has_value()) << seed << ": " << estimate.error().detail;
    refused += !estimate->parameters[kSkew].determined && estimate->parameters[kSkew].free() &&
               std::isnan(estimate->parameters[kSkew].sigma) &&
               Mentions(estimate->undetermined, "skew") &&
               Mentions(estimate->undetermined, "a second independent ratio");
  }
  EXPECT_EQ(refused, kSeeds);
  RecordProperty("refused", refused);
}

// Three vanishing points of two or three lines each, and one ratio on the front.
Scene OneRatio(std::uint64_t seed, bool second) {
  Scene scene;
  scene.truth = Townhouse().truth;
  const scenes::Wall front{Vec3(0, 0, 0), 0, 0}, east{Vec3(10, 0, 0), kPi / 2, 1};
  scene.Direction({0, 0, 0}, {10, 0, 0}, 0);
  scene.Direction({0, 0, 8}, {10, 0, 8}, 0);
  scene.Direction({10, 0, 0}, {10, 12, 0}, 1);
  scene.Direction({10, 0, 8}, {10, 12, 8}, 1);
  scene.Direction({10, 0, 3}, {10, 12, 3}, 1);
  scene.Direction({0, 0, 0}, {0, 0, 8}, 2);
  scene.Direction({10, 12, 0}, {10, 12, 8}, 2);
  scene.Ratio(front, 2, 2, 3, 2);
  if (second) scene.Ratio(east, 3, 2, 3, 2);
  scenes::Noise noise(seed);
  for (Trace& trace : scene.photograph.traces) {
    if (auto* direction = std::get_if<DirectionTrace>(&trace)) {
      direction->line.a_px += 0.3 * noise.Draw2();
      direction->line.b_px += 0.3 * noise.Draw2();
    } else if (auto* ratio = std::get_if<RatioTrace>(&trace)) {
      for (Vec2& dot : ratio->dots_px) dot += 0.3 * noise.Draw2();
    }
  }
  return scene;
}

TEST(Calibrate, ASingleRatioNeverShowsTheSkew) {
  int refused = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const Scene scene = OneRatio(static_cast<std::uint64_t>(seed), false);
    const auto estimate = Calibrate(scene.photograph, scene.list.numbers());
    ASSERT_TRUE(estimate.has_value()) << seed << ": " << estimate.error().detail;
    refused += estimate->parameters[kSkew].free() && Mentions(estimate->undetermined, "skew");
  }
  EXPECT_EQ(refused, kSeeds);
  RecordProperty("refused", refused);
}

TEST(Calibrate, APriorAnswersWhereTheDataDoNot) {
  Scene scene = OneRatio(7, false);
  scene.photograph.priors[kPrincipalX] = {scene.truth[kPrincipalX], 0.05};
  scene.photograph.priors[kPrincipalY] = {scene.truth[kPrincipalY], 0.05};
  const auto estimate = Calibrate(scene.photograph, scene.list.numbers());
  ASSERT_TRUE(estimate.has_value()) << estimate.error().detail;
  const ParameterEstimate& skew = estimate->parameters[kSkew];
  EXPECT_FALSE(skew.determined);
  EXPECT_TRUE(skew.from_prior);
  EXPECT_GT(skew.shares.priors, 0);
  EXPECT_GT(estimate->parameters[kPrincipalY].shares.priors, skew.shares.priors);
  EXPECT_NEAR(estimate->camera[kSkew], scene.truth[kSkew], 4 * skew.sigma);
  // Where it stood is open all the same: nothing says how long anything is.
  EXPECT_TRUE(estimate->parameters[kX0].free());
}

TEST(Calibrate, ThePenaltyOfOneFacadeIsFlatOverTheSkew) {
  const Scene scene = OneFacade(11);
  CalibrateOptions options;
  options.profile = SkewRange{88 * kPi / 180, 0.5 * kPi / 180, 9};
  const auto estimate = Calibrate(scene.photograph, scene.list.numbers(), options);
  ASSERT_TRUE(estimate.has_value());
  ASSERT_EQ(estimate->profile.size(), 9u);
  // So the camera that was taken is on the floor of the valley, too: what had to be assumed to
  // find one has not bent it.
  for (const ProfilePoint& point : estimate->profile) {
    EXPECT_NEAR(point.chi2, estimate->chi2, 1e-6);
  }
  // Eight of the camera's parameters, as many as a homography has, and the second window's place.
  EXPECT_EQ(estimate->dof, 16 + 3 - 8 - 2);
  EXPECT_LT(estimate->chi2, estimate->dof + 4 * std::sqrt(2.0 * estimate->dof));
}

TEST(Calibrate, EstimatedNoiseIsTheTrueOneAndIntervalsAreStudents) {
  // Traced with 0.8 px and declared with 0.5.
  Scene scene = Townhouse();
  scenes::Noise noise(4);
  double sum = 0;
  const int trials = 30;
  for (int i = 0; i < trials; ++i) {
    Scene traced = scene;
    for (Trace& trace : traced.photograph.traces) {
      std::visit(
          [&](auto& t) {
            if constexpr (requires { t.line; }) {
              t.line.a_px += 0.8 * noise.Draw2();
              t.line.b_px += 0.8 * noise.Draw2();
            } else if constexpr (requires { t.dots_px; }) {
              for (Vec2& dot : t.dots_px) dot += 0.8 * noise.Draw2();
            } else {
              t.dot_px += 0.8 * noise.Draw2();
            }
          },
          trace);
    }
    CalibrateOptions options;
    options.noise_is_estimated = true;
    const auto estimate = Calibrate(traced.photograph, traced.list.numbers(), options);
    ASSERT_TRUE(estimate.has_value()) << estimate.error().detail;
    EXPECT_TRUE(estimate->noise_is_estimated);
    EXPECT_GT(estimate->quantile95, 2.0);
    sum += estimate->noise_px * estimate->noise_px;
  }
  EXPECT_NEAR(std::sqrt(sum / trials), 0.8, 0.06);
}

TEST(Calibrate, TrialsAgreeWithTheAnalyticDeviations) {
  const Cuboid& cuboid = CuboidOf("B2");
  const TracedCuboid traced = TraceCuboid(cuboid, {.sigma_px = 0.25, .seed = 6});
  CalibrateOptions options;
  options.trials = 400;
  const auto estimate = Calibrate(traced.photograph, traced.numbers, options);
  ASSERT_TRUE(estimate.has_value());
  EXPECT_EQ(estimate->trials.trials, 400);
  for (int i = 0; i < kParameters; ++i) {
    const double sigma = estimate->parameters[i].sigma;
    EXPECT_NEAR(estimate->trials.deviation[i], sigma, 0.15 * sigma) << kParameterNames[i];
    EXPECT_NEAR(estimate->trials.mean[i], estimate->camera.parameters[i], 0.2 * sigma);
  }
  const auto again = Calibrate(traced.photograph, traced.numbers, options);
  EXPECT_EQ(again->trials.mean, estimate->trials.mean);
}

TEST(Calibrate, TheProfileIsLeastAtTheEstimateAndAsWideAsItsDeviation) {
  const Cuboid& cuboid = CuboidOf("B1");
  const TracedCuboid traced = TraceCuboid(cuboid, {.sigma_px = 0.5, .seed = 5});
  const auto plain = Calibrate(traced.photograph, traced.numbers);
  ASSERT_TRUE(plain.has_value());
  const double best = plain->camera[kSkew], sigma = plain->parameters[kSkew].sigma;
  CalibrateOptions options;
  options.profile = SkewRange{best - 3 * sigma, 0.5 * sigma, 13};
  const auto estimate = Calibrate(traced.photograph, traced.numbers, options);
  ASSERT_TRUE(estimate.has_value());
  ASSERT_EQ(estimate->profile.size(), 13u);
  for (const ProfilePoint& point : estimate->profile) {
    const double away = (point.alpha_rad - best) / sigma;
    EXPECT_NEAR(point.chi2 - estimate->chi2, away * away, 0.05 * away * away + 1e-6);
  }
}

TEST(Calibrate, ARobustLossNamesTheTraceItDoubts) {
  Scene scene = Townhouse();
  std::get<EdgeTrace>(scene.photograph.traces[1]).line.a_px.x() += 30;
  CalibrateOptions options;
  options.loss = Loss::kCauchy;
  const auto estimate = Calibrate(scene.photograph, scene.list.numbers(), options);
  ASSERT_TRUE(estimate.has_value()) << estimate.error().detail;
  for (const TraceResidual& residual : estimate->residuals) {
    EXPECT_EQ(residual.weight < 0.5, residual.trace == 1) << residual.trace;
  }
}

TEST(Calibrate, WarnsOfTiltOutsideItsRange) {
  Scene level = Townhouse();
  level.photograph.traces.clear();
  level.truth[kOmega] = 1 * kPi / 180;
  level.Edge({0, 0, 0}, {10, 0, 0});
  level.Edge({10, 0, 0}, {10, 0, 8});
  level.Edge({0, 0, 8}, {10, 0, 8});
  level.Edge({0, 0, 0}, {0, 0, 8});
  level.Edge({10, 0, 8}, {10, 12, 8});
  level.Edge({10, 0, 0}, {10, 12, 0});
  level.Edge({10, 12, 0}, {10, 12, 8});
  const auto estimate = Calibrate(level.photograph, level.list.numbers());
  ASSERT_TRUE(estimate.has_value()) << estimate.error().detail;
  EXPECT_TRUE(Mentions(estimate->warnings, "tilt of 1.00°"));
  EXPECT_FALSE(Mentions(estimate->warnings, "pan of"));
}

TEST(Calibrate, ARectanglesHomographyTakesItsCornersToTheirDots) {
  Scene scene = OneFacade(3);
  scene.Rectangle({Vec3(10, 0, 0), kPi / 2, 1}, 2, 1, 1.5, 2.5);
  const Numbers numbers = scene.list.numbers();
  const auto estimate = Calibrate(scene.photograph, numbers);
  ASSERT_TRUE(estimate.has_value()) << estimate.error().detail;
  ASSERT_EQ(estimate->rectangles.size(), 3u);
  for (const RectangleView& view : estimate->rectangles) {
    const auto& window = std::get<RectangleTrace>(scene.photograph.traces[view.trace]);
    const double a = numbers.values[window.a], b = numbers.values[window.b];
    const Vec2 corners[4] = {{0, 0}, {a, 0}, {a, b}, {0, b}};
    for (int i = 0; i < 4; ++i) {
      const Vec2 dot = (view.dot_from_metres * corners[i].homogeneous()).hnormalized();
      EXPECT_LT((dot - window.dots_px[i]).norm(), 2.0) << view.trace;
    }
  }
}

TEST(Calibrate, FindsLevelCamerasThatLookStraightAtTheFront) {
  for (const char* name : {"B1", "B2", "B3", "B4"}) {
    for (const double degrees : {1.0, 0.1, 0.0}) {
      SCOPED_TRACE(std::string(name) + " " + std::to_string(degrees));
      Cuboid tilted = CuboidOf(name), panned = CuboidOf(name);
      tilted.truth[kOmega] = degrees * kPi / 180;
      panned.truth[kPhi] = degrees * kPi / 180;
      for (const Cuboid& cuboid : {tilted, panned}) {
        const TracedCuboid traced = TraceCuboid(cuboid, {});
        const auto estimate = Calibrate(traced.photograph, traced.numbers);
        ASSERT_TRUE(estimate.has_value()) << estimate.error().detail;
        ExpectSame(estimate->camera, cuboid.truth, 1e-8);
        EXPECT_TRUE(estimate->determined());
        EXPECT_FALSE(estimate->warnings.empty());
      }
    }
  }
}

// A small window seen from far away, by a camera that is known but for its pose.
Scene FarWindow(double distance_m) {
  Scene scene;
  scene.truth.parameters << 200, 1, 0, 0, kPi / 2, 0.3, 0.35, 0.01, 0, 0, 0;
  scene.truth.parameters.tail<3>() = distance_m * Vec3(std::sin(0.35), -std::cos(0.35), -0.3);
  scene.Rectangle({Vec3(0, 0, 0), 0, 0}, 0, 0, 1.2, 2.1);
  for (int i = 0; i < kIntrinsics; ++i) {
    scene.photograph.priors[i] = {scene.truth.parameters[i], i == kFocal ? 0.1 : 1e-4};
  }
  return scene;
}

TEST(Calibrate, ASmallWindowHasTwoPosesAndANearOneHasOne) {
  const Scene far = FarWindow(150);
  const auto estimate = Calibrate(far.photograph, far.list.numbers());
  ASSERT_TRUE(estimate.has_value()) << estimate.error().detail;
  ASSERT_EQ(estimate->alternatives.size(), 1u);
  ExpectSame(estimate->camera, far.truth, 1e-5);
  const Estimate& other = estimate->alternatives[0];
  ASSERT_EQ(other.covariance.rows(), kParameters);
  EXPECT_GT(other.covariance.diagonal().minCoeff(), 0);
  // The pose is another one, and so are its deviations.
  EXPECT_GT((other.covariance - estimate->covariance).norm(), 1e-3 * estimate->covariance.norm());
  EXPECT_LT(other.chi2, estimate->chi2 + 9);
  EXPECT_EQ(other.covariance.rows(), kParameters);
  // The window's normal is mirrored about the line of sight: seen from the other side.
  EXPECT_LT(other.camera[kX0] * far.truth[kX0], 0);
  EXPECT_LT(other.camera[kY0], 0);
  const Scene near = FarWindow(12);
  const auto only = Calibrate(near.photograph, near.list.numbers());
  ASSERT_TRUE(only.has_value());
  EXPECT_TRUE(only->alternatives.empty());
  ExpectSame(only->camera, near.truth, 1e-5);
}

// A beam stands out of a far window by an unknown length, which is as long to the other side in the
// other pose: both are found, and the likelier one is given, wherever its length starts.
TEST(Calibrate, AnUnknownHidesNoSecondPose) {
  Scene far = FarWindow(150);
  scenes::Noise noise(5);
  far.photograph.traces.clear();
  for (const double right : {0.0, 0.6, 1.2}) {
    far.Point({right, 0, 0});
    far.Point({right, 0, 2.1});
  }
  far.Point({0.6, 1, 1});
  for (Trace& trace : far.photograph.traces) {
    if (auto* point = std::get_if<PointTrace>(&trace)) {
      point->dot_px += 0.5 * Vec2(noise.Draw(), noise.Draw());
    }
  }
  const int end = std::get<PointTrace>(far.photograph.traces.back()).at + 1;
  std::vector<Estimate> found;
  for (const double start : {1.0, -1.0, 3.0}) {
    const auto estimates =
        Calibrate(std::vector{far.photograph}, std::vector<Unknown>{{"beam", start, 0, -5, 5}},
                  [&](const Eigen::VectorXd& u) -> geom::Result<Numbers> {
                    Numbers numbers = far.list.numbers(1);
                    numbers.values[end] = u[0];
                    numbers.by_unknown(end, 0) = 1;
                    return numbers;
                  });
    ASSERT_TRUE(estimates.has_value()) << estimates.error().detail;
    found.push_back(estimates->front());
    const Estimate& one = found.back();
    ASSERT_EQ(one.alternatives.size(), 1u) << start << ": " << one.chi2;
    EXPECT_LT(one.alternatives[0].unknowns[0].value * one.unknowns[0].value, 0);
    EXPECT_GE(one.alternatives[0].chi2, one.chi2);
    EXPECT_NEAR(one.unknowns[0].value, found[0].unknowns[0].value, 1e-4);
  }
}

// A photograph of which one line is traced says nothing of its camera, and of the others' as much
// as they do alone.
TEST(Calibrate, AnOpenPhotographLeavesTheOthersAsTheyAre) {
  const Scene sound = Townhouse();
  Photograph open;
  open.frame = sound.photograph.frame;
  open.traces = {sound.photograph.traces[5]};
  const auto estimates = Calibrate(
      std::vector{sound.photograph, open}, {},
      [&](const Eigen::VectorXd&) -> geom::Result<Numbers> { return sound.list.numbers(); });
  ASSERT_TRUE(estimates.has_value()) << estimates.error().detail;
  EXPECT_TRUE(estimates->front().determined());
  EXPECT_TRUE(estimates->front().undetermined.empty());
  EXPECT_FALSE(estimates->back().determined());
  EXPECT_TRUE(Mentions(estimates->back().undetermined, "focal length"));
}

// One rectangle and the usual priors: a camera that may be used, and that the data do not
// determine.
TEST(Calibrate, WhatOnlyAPriorHoldsIsNotDetermined) {
  const Scene far = FarWindow(12);
  const auto estimate = Calibrate(far.photograph, far.list.numbers());
  ASSERT_TRUE(estimate.has_value());
  EXPECT_TRUE(estimate->complete());
  EXPECT_FALSE(estimate->determined());
}

TEST(Calibrate, ASecondPoseIsToldOfAnOpenCameraToo) {
  Scene far = FarWindow(150);
  for (const Parameter p : {kFocal, kPrincipalX, kPrincipalY}) far.photograph.priors[p] = {};
  const auto estimate = Calibrate(far.photograph, far.list.numbers());
  ASSERT_TRUE(estimate.has_value()) << estimate.error().detail;
  EXPECT_FALSE(estimate->determined());
  ASSERT_EQ(estimate->alternatives.size(), 1u);
  EXPECT_LT(estimate->alternatives[0].camera[kX0] * estimate->camera[kX0], 0);
  // Of directions alone every camera could as well look the other way: no second pose is told.
  const auto turned = Calibrate(OneRatio(7, false).photograph, OneRatio(7, false).list.numbers());
  ASSERT_TRUE(turned.has_value());
  EXPECT_TRUE(turned->alternatives.empty());
}

TEST(Calibrate, PhotographsOfOneBuildingAnswerEachOther) {
  // The second photograph shows two corners of which only the first one's edges tell the height.
  const Cuboid& from_right = CuboidOf("B4");
  Cuboid from_left = from_right;
  from_left.truth[kX0] = -25, from_left.truth[kPhi] = -30 * kPi / 180;
  const TracedCuboid first = TraceCuboid(from_right, {.sigma_px = 0.5, .seed = 1});
  const TracedCuboid second = TraceCuboid(from_left, {.sigma_px = 0.5, .seed = 2});
  std::vector<Unknown> unknowns;
  for (int i = 0; i < 3; ++i) {
    // The width is measured, and the others are guessed.
    const double start = from_right.dimensions_m[i];
    unknowns.push_back({i == 0   ? "width"
                        : i == 1 ? "depth"
                                 : "height",
                        i == 0 ? start : 1.02 * start, i == 0 ? 0.001 : 0.0});
  }
  std::vector<Photograph> photographs{first.photograph, second.photograph};
  // One camera and one film: square dots at right angles.
  for (Photograph& photograph : photographs) {
    photograph.priors[kAspect] = {from_right.truth[kAspect], 1e-4};
    photograph.priors[kSkew] = {from_right.truth[kSkew], 1e-4};
  }
  const auto estimates =
      Calibrate(photographs, unknowns, [&](const Eigen::VectorXd& u) -> geom::Result<Numbers> {
        return benchmark::NumbersOf(from_right, u, 3);
      });
  ASSERT_TRUE(estimates.has_value()) << estimates.error().detail;
  ASSERT_EQ(estimates->size(), 2u);
  const Camera truths[] = {from_right.truth, from_left.truth};
  for (int p = 0; p < 2; ++p) {
    const Estimate& estimate = (*estimates)[p];
    for (int i = 0; i < kParameters; ++i) {
      ASSERT_FALSE(estimate.parameters[i].free()) << kParameterNames[i];
      EXPECT_NEAR(estimate.camera.parameters[i], truths[p].parameters[i],
                  4.5 * estimate.parameters[i].sigma)
          << p << " " << kParameterNames[i];
    }
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(estimate.unknowns[i].value, from_right.dimensions_m[i],
                  4.5 * estimate.unknowns[i].sigma);
    }
  }
  EXPECT_EQ((*estimates)[0].chi2, (*estimates)[1].chi2);
  // One adjustment: both cameras vary with the width that they share.
  const Eigen::MatrixXd &one = (*estimates)[0].deviations, &two = (*estimates)[1].deviations;
  for (const Estimate& estimate : *estimates) {
    const Eigen::MatrixXd product = estimate.deviations * estimate.deviations.transpose();
    const Eigen::VectorXd sigma = estimate.covariance.diagonal().cwiseSqrt();
    const Eigen::MatrixXd apart = (product - estimate.covariance).cwiseAbs();
    EXPECT_LT((apart.array() / (sigma * sigma.transpose()).array()).maxCoeff(), 1e-10);
  }
  ASSERT_EQ(one.cols(), two.cols());
  EXPECT_LT((one.bottomRows(3) - two.bottomRows(3)).norm(), 1e-12 * one.bottomRows(3).norm());
  const double correlation =
      one.row(kX0).dot(two.row(kX0)) /
      ((*estimates)[0].parameters[kX0].sigma * (*estimates)[1].parameters[kX0].sigma);
  EXPECT_GT(std::abs(correlation), 0.05);
  EXPECT_LT(std::abs(correlation), 1);
}

TEST(Calibrate, AnUnknownThatNothingShowsIsNamed) {
  const Cuboid& cuboid = CuboidOf("B1");
  const TracedCuboid traced = TraceCuboid(cuboid, {.sigma_px = 0.5, .seed = 8});
  const std::vector<Unknown> unknowns{{"rise", 4}};
  const auto estimates = Calibrate(std::vector{traced.photograph}, unknowns,
                                   [&](const Eigen::VectorXd&) -> geom::Result<Numbers> {
                                     Numbers numbers = traced.numbers;
                                     numbers.by_unknown =
                                         Eigen::MatrixXd::Zero(numbers.values.size(), 1);
                                     return numbers;
                                   });
  ASSERT_TRUE(estimates.has_value()) << estimates.error().detail;
  const auto without = Calibrate(traced.photograph, traced.numbers);
  ASSERT_TRUE(without.has_value());
  ExpectSame(estimates->front().camera, without->camera, 1e-7);
  EXPECT_FALSE(estimates->front().unknowns[0].determined);
  EXPECT_TRUE(Mentions(estimates->front().undetermined, "`rise` is not seen"));
  EXPECT_TRUE(estimates->front().determined());
}

TEST(Calibrate, AdvisesNoPriorWhereOneIsGiven) {
  Scene scene = OneFacade(2);
  const auto open = Calibrate(scene.photograph, scene.list.numbers());
  ASSERT_TRUE(open.has_value());
  EXPECT_TRUE(Mentions(open->undetermined, "a prior on the principal point"));
  scene.photograph.priors[kPrincipalX] = scene.photograph.priors[kPrincipalY] = {0, 1};
  const auto with = Calibrate(scene.photograph, scene.list.numbers());
  ASSERT_TRUE(with.has_value());
  EXPECT_TRUE(Mentions(with->undetermined, "a third dimension"));
  EXPECT_FALSE(Mentions(with->undetermined, "a prior on the principal point"));
}

TEST(Calibrate, FindsTheCameraOfCurvesAlone) {
  // Arches on two walls; a camera without skew, off by the priors' deviations from the usual one.
  Scene scene;
  scene.truth = Townhouse().truth;
  scene.truth[kSkew] = kPi / 2, scene.truth[kAspect] = 1;
  const scenes::Wall front{Vec3(0, 0, 0), 0, 0}, east{Vec3(10, 0, 0), kPi / 2, 1};
  for (const double right : {2.0, 5.0, 8.0}) scene.Arch(front, right, 1, 1.2, 24);
  for (const double right : {2.0, 6.0, 10.0}) scene.Arch(east, right, 2, 1.5, 24);
  scene.photograph.priors[kAspect] = {1, 0.01};
  scene.photograph.priors[kSkew] = {kPi / 2, 0.5 * kPi / 180};
  const auto estimate = Calibrate(scene.photograph, scene.list.numbers());
  ASSERT_TRUE(estimate.has_value()) << estimate.error().detail;
  ExpectSame(estimate->camera, scene.truth, 1e-6);
}

TEST(Calibrate, LeavesNothingToExceptions) {
  const Scene scene = Townhouse();
  const auto thrown = Calibrate(
      std::vector{scene.photograph}, std::vector<Unknown>{{"depth", 3}},
      [&](const Eigen::VectorXd&) -> geom::Result<Numbers> { throw std::runtime_error("oh"); });
  EXPECT_FALSE(thrown.has_value());
}

}  // namespace
}  // namespace tranos::camera
