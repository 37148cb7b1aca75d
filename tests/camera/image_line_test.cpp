// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/image_line.h"

#include <gtest/gtest.h>

namespace tranos::camera {
namespace {

TEST(ImageLine, GoesThroughTwoDotsWithTheTraceOfBoth) {
  const auto line = FitImageLine({{10, 20}, {110, 70}}, 0.5);
  ASSERT_TRUE(line);
  EXPECT_LT((line->a_px - Vec2(10, 20)).norm(), 1e-12);
  EXPECT_LT((line->b_px - Vec2(110, 70)).norm(), 1e-12);
  // Centre: the mean of two offsets; tilt: their difference.
  EXPECT_NEAR(line->centre_sigma_px, 0.5 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(line->tilt_sigma_px, 0.5 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(line->coordinates().dot(Vec3(60, 45, 1)), 0, 1e-12);
  EXPECT_NEAR(line->coordinates().head<2>().norm(), 1, 1e-15);
}

TEST(ImageLine, WithSamplesIsThatOfAsManyPixelsSpreadEvenlyAlongIt) {
  const int count = 400;
  std::vector<Vec2> dots;
  for (int i = 0; i < count; ++i) dots.push_back(Vec2(3, 4) / 5 * (i + 0.5 - count / 2.0));
  const auto fitted = FitImageLine(dots, 0.4);
  const auto stated = FitImageLine({dots.front(), dots.back()}, 0.4, count);
  ASSERT_TRUE(fitted && stated);
  EXPECT_NEAR(fitted->centre_sigma_px, stated->centre_sigma_px, 1e-12);
  EXPECT_NEAR(fitted->tilt_sigma_px / stated->tilt_sigma_px, 1, 0.003);
}

TEST(ImageLine, MinimizesPerpendicularDistancesWhateverTheDirection) {
  // Two dots displaced to either side in a symmetric figure leave the line; turned with the figure.
  for (const double turn : {0.0, 0.7, kPi / 2, 2.5}) {
    const Eigen::Rotation2Dd rotation(turn);
    std::vector<Vec2> dots;
    for (const Vec2& dot : {Vec2(-10, 1), Vec2(-10, -1), Vec2(10, 1), Vec2(10, -1)})
      dots.push_back(rotation * dot + Vec2(100, 50));
    const auto line = FitImageLine(dots, 2);
    ASSERT_TRUE(line);
    const Vec2 along = (line->b_px - line->a_px).normalized();
    EXPECT_NEAR(std::abs(along.dot(rotation * Vec2::UnitX())), 1, 1e-12);
    EXPECT_LT((line->centre_px() - Vec2(100, 50)).norm(), 1e-12);
    EXPECT_NEAR(line->misfit, 4 * 0.25, 1e-12);  // (1/2)² each
  }
}

TEST(ImageLine, NeedsTwoDifferentDotsAndANoise) {
  EXPECT_FALSE(FitImageLine({}, 1));
  EXPECT_FALSE(FitImageLine({{5, 5}}, 1));
  EXPECT_FALSE(FitImageLine({{5, 5}, {5, 5}}, 1));
  EXPECT_FALSE(FitImageLine({{5, 5}, {6, 5}}, 0));
  EXPECT_FALSE(FitImageLine({{1, 0}, {0, 1}, {-1, 0}, {0, -1}}, 1));
  EXPECT_FALSE(FitImageLine({{1, 0}, {NAN, 1}}, 1));
}

}  // namespace
}  // namespace tranos::camera
