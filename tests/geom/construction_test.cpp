// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/construction.h"

#include "shapes.h"

namespace tranos::geom {
namespace {

constexpr double kRounding = 1e-12;

RC_GTEST_PROP(Ellipse, HasItsPointsAtItsHalfAxes, ()) {
  const Frame frame = DrawFrame();
  const double a = Within(0.1, 9), b = Within(0.1, 9);
  const BsplineCurve ellipse = Ellipse(frame, a, b);
  for (int i = 0; i <= 40; ++i) {
    const Vec3 p = frame.ToLocal(PointAt(ellipse, i / 40.0));
    RC_ASSERT(std::abs(std::hypot(p.x() / a, p.y() / b) - 1) < 1e-11);
    RC_ASSERT(std::abs(p.z()) < 1e-11);
  }
  RC_ASSERT(Near(PointAt(ellipse, 0.25), frame.ToWorld({0, b, 0}), 1e-11));
  RC_ASSERT(std::abs(*EnclosedArea(ellipse) - kPi * a * b) < 1e-9 * a * b);
  RC_ASSERT(PlaneOf(ellipse)->z().dot(frame.z()) > 0);
}

TEST(RegularPolygon, HasEqualSides) {
  const Polyline polygon = RegularPolygon(Frame{}, 2, 7);
  ASSERT_EQ(polygon.vertices.size(), 7u);
  EXPECT_EQ(polygon.vertices[0], Vec3(2, 0, 0));
  EXPECT_NEAR(Length(polygon), 7 * 4 * std::sin(kPi / 7), kRounding);
  EXPECT_EQ(RegularPolygon(Frame{}, 3, 4).vertices[1], Vec3(0, 3, 0));
}

// Derivatives by the knots just before and after each inner point.
RC_GTEST_PROP(CurveThrough, RunsThroughItsPointsWithContinuousCurvature, ()) {
  std::vector<Vec3> points;
  const int count = *rc::gen::inRange(3, 9);
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * kPi * i / count;  // nowhere straight back
    points.push_back(5 * Vec3(std::cos(angle), std::sin(angle), 0) + 0.05 * DrawPoint());
  }
  const bool closed = *rc::gen::arbitrary<bool>();
  const BsplineCurve curve = *CurveThrough(points, closed);
  RC_ASSERT(Check(Curve(curve)).has_value());
  RC_ASSERT(curve.poles.size() == points.size() + (closed ? 3 : 2));
  for (const Vec3& p : points) RC_ASSERT(NearestPoint(curve, p).distance_m < 1e-9);
  RC_ASSERT(IsClosed(curve) == closed);
  if (closed) RC_ASSERT(Near(TangentAt(curve, 0), TangentAt(curve, 1), 1e-9));
  // Inner knots are simple, and a cubic with simple knots has continuous second derivatives.
  for (std::size_t i = 4; i + 4 < curve.knots.size(); ++i) {
    RC_ASSERT(curve.knots[i] < curve.knots[i + 1]);
  }
}

TEST(CurveThrough, OfTwoPointsIsStraight) {
  const BsplineCurve curve = *CurveThrough({{0, 0, 0}, {4, 2, 0}}, false);
  EXPECT_TRUE(Near(PointAt(curve, 0.5), {2, 1, 0}, kRounding));
  EXPECT_NEAR(Length(curve), std::sqrt(20.0), kRounding);
}

TEST(CurveThrough, OfPointsOnACircleIsNearlyRound) {
  const Polyline polygon = RegularPolygon(Frame{}, 1, 16);
  const BsplineCurve curve = *CurveThrough(polygon.vertices, true);
  for (int i = 0; i < 100; ++i) EXPECT_NEAR(PointAt(curve, i / 100.0).norm(), 1, 1e-4);
}

TEST(CurveThrough, NamesAPointThatRepeatsTheOneBefore) {
  const auto open = CurveThrough({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}}, false);
  ASSERT_FALSE(open.has_value());
  EXPECT_EQ(open.error().part, 2);
  EXPECT_FALSE(CurveThrough({{0, 0, 0}, {1, 0, 0}}, true).has_value());
  EXPECT_FALSE(CurveThrough({{0, 0, 0}}, false).has_value());
  // So unevenly spaced that their parameters coincide.
  EXPECT_FALSE(CurveThrough({{0, 0, 0}, {1e9, 0, 0}, {1e9, 1e-8, 0}}, false).has_value());
}

TEST(CurveByPoles, StartsAndEndsAtPolesOrClosesSmoothly) {
  const std::vector<Vec3> poles = {{0, 0, 0}, {1, 3, 0}, {4, 3, 1}, {5, 0, 0}, {3, -2, 0}};
  const BsplineCurve open = *CurveByPoles(poles, 3, false);
  EXPECT_TRUE(Check(Curve(open)).has_value());
  EXPECT_TRUE(Near(PointAt(open, 0), poles.front(), kRounding));
  EXPECT_TRUE(Near(PointAt(open, 1), poles.back(), kRounding));
  const BsplineCurve closed = *CurveByPoles(poles, 3, true);
  EXPECT_TRUE(Check(Curve(closed)).has_value());
  EXPECT_TRUE(IsClosed(closed));
  EXPECT_TRUE(Near(TangentAt(closed, 0), TangentAt(closed, 1), 1e-9));
  // A uniform cubic passes through (1 4 1)/6 of its poles.
  const Vec3 knot_point = (poles[0] + 4 * poles[1] + poles[2]) / 6;
  EXPECT_LT(NearestPoint(closed, knot_point).distance_m, 1e-9);
}

TEST(CurveByPoles, LowersItsDegreeForFewPolesAndRefusesOthers) {
  EXPECT_EQ(CurveByPoles({{0, 0, 0}, {1, 0, 0}}, 3, false)->degree, 1);
  EXPECT_FALSE(CurveByPoles({{0, 0, 0}, {1, 0, 0}}, 0, false).has_value());
  EXPECT_FALSE(CurveByPoles({{0, 0, 0}, {1, 0, 0}}, 25, false).has_value());
  EXPECT_FALSE(CurveByPoles({{0, 0, 0}, {1, 0, 0}}, 2, true).has_value());
}

RC_GTEST_PROP(TangentArc, LeavesAlongTheTangentAndEndsAtThePoint, ()) {
  const Frame frame = DrawFrame();
  const Vec3 end = frame.ToWorld({Within(-9, 9), Within(0.1, 9), 0});
  const Curve arc = *TangentArc(frame.origin, frame.x, end);
  RC_ASSERT(Near(PointAt(arc, 0), frame.origin, 1e-9));
  RC_ASSERT(Near(TangentAt(arc, 0), frame.x, 1e-9));
  RC_ASSERT(Near(PointAt(arc, 1), end, 1e-7));
}

TEST(TangentArc, IsALineStraightAheadAndNothingStraightBehind) {
  EXPECT_TRUE(std::holds_alternative<Line>(*TangentArc({0, 0, 0}, {1, 0, 0}, {3, 0, 0})));
  EXPECT_FALSE(TangentArc({0, 0, 0}, {1, 0, 0}, {-3, 0, 0}).has_value());
  EXPECT_FALSE(TangentArc({0, 0, 0}, {1, 0, 0}, {0, 0, 0}).has_value());
}

}  // namespace
}  // namespace tranos::geom
