// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/homography.h"

#include <gtest/gtest.h>

#include <array>

namespace tranos::camera {
namespace {

using Dots = std::array<Vec2, 4>;

Mat3 Reference() {
  Mat3 h;
  h << 90, 12, 400, -8, -110, 700, 0.02, 0.005, 1;
  return h;
}

Vec2 Map(const Mat3& h, double x, double y) { return (h * Vec3(x, y, 1)).hnormalized(); }

TEST(Homography, OfARectangleIsItsFirstLemma) {
  const Mat3 h = Reference();
  const Dots dots = {Map(h, 0, 0), Map(h, 1.2, 0), Map(h, 1.2, 2.1), Map(h, 0, 2.1)};
  const auto found = HomographyOfRectangle(dots, 1.2, 2.1);
  ASSERT_TRUE(found);
  EXPECT_LT((*found - h).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Homography, OfTheRectanglesCornersAgreesWithTheLinearTransformation) {
  const Mat3 h = Reference();
  const std::array<Vec2, 4> points = {Vec2(0, 0), Vec2(3, 0), Vec2(3, 2), Vec2(0, 2)};
  Dots dots;
  for (size_t i = 0; i < 4; ++i) dots[i] = Map(h, points[i].x(), points[i].y());
  dots[2] += Vec2(3, -2);
  const auto exact = HomographyOfRectangle(dots, 3, 2);
  const auto fitted = FitHomography(points, dots);
  ASSERT_TRUE(exact && fitted);
  EXPECT_LT((exact->normalized() - *fitted).cwiseAbs().maxCoeff(), 1e-12);
  for (size_t i = 0; i < 4; ++i)
    EXPECT_LT((Map(*exact, points[i].x(), points[i].y()) - dots[i]).norm(), 1e-9);
}

TEST(Homography, RefusesWhatIsNoPictureOfARectangle) {
  const Dots fine = {Vec2(0, 10), Vec2(10, 11), Vec2(9, 0), Vec2(1, 1)};
  EXPECT_TRUE(HomographyOfRectangle(fine, 1, 1));
  EXPECT_FALSE(HomographyOfRectangle(Dots{fine[0], fine[2], fine[1], fine[3]}, 1, 1));  // crossed
  EXPECT_FALSE(HomographyOfRectangle(Dots{fine[0], fine[1], Vec2(2, 6), fine[3]}, 1, 1));
  EXPECT_FALSE(HomographyOfRectangle(Dots{fine[0], fine[1], Vec2(20, 12), fine[3]}, 1, 1));
  EXPECT_FALSE(HomographyOfRectangle(Dots{fine[0], fine[0], fine[0], fine[0]}, 1, 1));
  const auto zero = HomographyOfRectangle(fine, 0, 1);
  ASSERT_FALSE(zero);
  EXPECT_EQ(zero.error().code, geom::ErrorCode::kOutOfRange);
}

TEST(Homography, NeedsFourPointsNotOnALine) {
  const std::array<Vec2, 5> line = {Vec2(0, 0), Vec2(1, 1), Vec2(2, 2), Vec2(3, 3), Vec2(0, 1)};
  EXPECT_FALSE(FitHomography(std::span(line).first(3), std::span(line).first(3)));
  EXPECT_FALSE(FitHomography(line, line));
}

}  // namespace
}  // namespace tranos::camera
