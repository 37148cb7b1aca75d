// SPDX-License-Identifier: GPL-3.0-or-later
// Circles seen obliquely, from dots with noise. bench/camera_benchmark has the figures of a
// thousand seeds.
#include "camera/circle_fit.h"

#include <gtest/gtest.h>

#include "tests/camera/circle_trials.h"

namespace tranos::camera {
namespace {

using scenes::CircleTrials;
using scenes::CircleView;
using scenes::TrialsOf;

#ifdef TRANOS_SANITIZED
constexpr int kSeeds = 40;
#else
constexpr int kSeeds = 400;
#endif

TEST(CircleFit, ExactDotsGiveTheCircle) {
  for (const double sweep_rad : {0.5 * kPi, kPi, 2 * kPi}) {
    const CircleView seen{.radius_px = 40, .dots = 7, .sweep_rad = sweep_rad};
    const auto fitted = FitCircleSeen(scenes::CircleCamera(), {}, scenes::kCirclePlane,
                                      scenes::DotsOf(seen, 0, 1), 0.5);
    ASSERT_TRUE(fitted);
    EXPECT_NEAR(fitted->radius_m, scenes::RadiusOf(seen), 1e-9);
    EXPECT_LT((fitted->centre_m - scenes::kCircleCentre).norm(), 1e-9);
    EXPECT_LT(fitted->chi2, 1e-12);
  }
}

TEST(CircleFit, ThreeDotsGiveTheCircleThroughThem) {
  const CircleView seen{.radius_px = 80, .dots = 3};
  const auto dots_px = scenes::DotsOf(seen, 0.5, 7);
  const auto fitted = FitCircleSeen(scenes::CircleCamera(), {}, scenes::kCirclePlane, dots_px, 0.5);
  ASSERT_TRUE(fitted);
  EXPECT_LT(fitted->chi2, 1e-12);
}

// Within five of the standard errors of a share.
double Slack(double share) { return 5 * std::sqrt(share * (1 - share) / kSeeds); }

TEST(CircleFit, RadiusOfAnArchIsWithinOnePerCent) {
  const CircleTrials trials = TrialsOf({.radius_px = 60, .dots = 9}, kSeeds);
  EXPECT_GE(trials.within_one_per_cent, 0.95 - Slack(0.95));
  EXPECT_NEAR(trials.within_95, 0.95, Slack(0.95));
}

TEST(CircleFit, SmallerOnesAreWithinTheirInterval) {
  for (const double radius_px : {8.0, 15.0, 30.0}) {
    const CircleTrials trials = TrialsOf({.radius_px = radius_px, .dots = 9}, kSeeds);
    EXPECT_NEAR(trials.within_95, 0.95, Slack(0.95)) << radius_px;
  }
}

TEST(CircleFit, DotsOnALineAreNoCircle) {
  const std::vector<Vec2> dots_px = {{1500, 1000}, {1520, 1010}, {1540, 1020.2}, {1560, 1030}};
  const auto fitted = FitCircleSeen(scenes::CircleCamera(), {}, scenes::kCirclePlane, dots_px, 0.5);
  ASSERT_FALSE(fitted);
  EXPECT_EQ(fitted.error().code, geom::ErrorCode::kDegenerate);
}

}  // namespace
}  // namespace tranos::camera
