// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes.h"

namespace tranos::geom {
namespace {

double DistanceToPath(const Vec3& p, const std::vector<Vec3>& path, bool closed) {
  return NearestPoint(Polyline{path, closed}, p).distance_m;
}

RC_GTEST_PROP(CurveFacets, NoPointOfTheCurveIsFartherThanTheTolerance, ()) {
  const Curve curve = DrawCurve();
  const double chord_m = std::pow(10.0, -Within(0, 4));
  const auto points = *Tessellate(curve, {chord_m, 0});
  for (int i = 0; i <= 300; ++i) {
    RC_ASSERT(DistanceToPath(PointAt(curve, i / 300.0), points, IsClosed(curve)) <=
              chord_m * (1 + 1e-9) + 1e-12);
  }
  for (const Vec3& p : points) RC_ASSERT(NearestPoint(curve, p).distance_m < 1e-9);
}

TEST(CurveFacets, CircleByCountStartsAtItsAngleZeroAndIsExactAtQuarters) {
  const auto points = *Tessellate(Circle{{}, 2}, {1e-3, 8});
  ASSERT_EQ(points.size(), 8u);
  EXPECT_EQ(points[0], Vec3(2, 0, 0));
  EXPECT_EQ(points[2], Vec3(0, 2, 0));
  EXPECT_EQ(points[4], Vec3(-2, 0, 0));
  EXPECT_EQ(points[6], Vec3(0, -2, 0));
}

TEST(CurveFacets, ArcByCountHasItsShareOfTheTurn) {
  EXPECT_EQ(Tessellate(Arc{{}, 2, kPi}, {1e-3, 6})->size(), 4u);
  EXPECT_EQ(Tessellate(Arc{{}, 2, kPi / 2}, {1e-3, 6})->size(), 3u);
  EXPECT_EQ(Tessellate(Circle{{}, 2}, {1e-3, 1})->size(), 3u);
}

TEST(CurveFacets, CircleByChordIsNotFinerThanItMustBe) {
  const double chord_m = 1e-3;
  const auto points = *Tessellate(Circle{{}, 5}, {chord_m, 0});
  const double coarser = static_cast<double>(points.size()) - 1;
  EXPECT_GT(5 * (1 - std::cos(kPi / coarser)), chord_m);
}

TEST(CurveFacets, JointsOfAChainAreThereOnce) {
  const auto points = *Tessellate(Fig6Edge({0, 0, 0}, {1, 0, 0}), {1e-3, 8});
  ASSERT_EQ(points.size(), 7u);
  EXPECT_EQ(points[0], Vec3(0, 0, 0));
  EXPECT_TRUE(Near(points[1], {10, 0, 0}, 1e-14));
  EXPECT_TRUE(Near(points[3], {15, 0, 5}, 1e-14));
}

TEST(CurveFacets, TooManyPointsAreRefusedBeforeTheyAreMade) {
  EXPECT_EQ(Tessellate(Circle{{}, 1}, {1e-300, 0}).error().code, ErrorCode::kTooLarge);
  const BsplineCurve parabola{2, {0, 0, 0, 1, 1, 1}, {{-2, 4, 0}, {0, -4, 0}, {2, 4, 0}}, {}};
  EXPECT_EQ(Tessellate(parabola, {1e-300, 0}).error().code, ErrorCode::kTooLarge);
  EXPECT_EQ(Tessellate(Line{{0, 0, 0}, {1, 1, 1}}, {1e-300, 0})->size(), 2u);
}

}  // namespace
}  // namespace tranos::geom
