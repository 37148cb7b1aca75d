// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes.h"

namespace tranos::geom {
namespace {

TEST(Arc, ThroughThreePointsPassesThroughThem) {
  const Arc arc = *ArcThrough({10, 0, 0}, {15, 0, 5}, {20, 0, 0});
  EXPECT_DOUBLE_EQ(arc.radius, 5);
  EXPECT_NEAR(arc.sweep_rad, kPi, 1e-15);
  EXPECT_TRUE(Near(arc.frame.origin, {15, 0, 0}, 1e-14));
  EXPECT_TRUE(Near(PointAt(arc, 0.5), {15, 0, 5}, 1e-14));
  EXPECT_NEAR(Length(arc), 5 * kPi, 1e-13);
}

RC_GTEST_PROP(Arc, AnyThreePointsNotOnALineAreOnTheirArc, ()) {
  const Vec3 a = DrawPoint(), b = DrawPoint(), c = DrawPoint();
  RC_PRE((b - a).cross(c - a).norm() > 1e-2 * (b - a).norm() * (c - a).norm());
  RC_PRE((c - b).norm() > 0.1);
  const Arc arc = *ArcThrough(a, b, c);
  const double slack = 1e-11 * (1 + arc.radius);
  RC_ASSERT((PointAt(arc, 0) - a).norm() < slack);
  RC_ASSERT((PointAt(arc, 1) - c).norm() < slack);
  RC_ASSERT(NearestPoint(arc, b).distance_m < slack);
}

TEST(Arc, CollinearOrCoincidentPointsAreRefused) {
  EXPECT_EQ(ArcThrough({0, 0, 0}, {1, 0, 0}, {3, 0, 0}).error().code, ErrorCode::kDegenerate);
  EXPECT_EQ(ArcThrough({0, 0, 0}, {1, 2, 0}, {0, 0, 0}).error().code, ErrorCode::kDegenerate);
  EXPECT_EQ(ArcThrough({0, 0, 0}, {0, 0, 0}, {1, 0, 0}).error().code, ErrorCode::kDegenerate);
}

TEST(Arc, AroundACentreTurnsCounterClockwiseAboutTheNormal) {
  const Arc quarter = *ArcAround({0, 0, 0}, {2, 0, 0}, {0, 7, 0}, {0, 0, 1});
  EXPECT_NEAR(quarter.sweep_rad, kPi / 2, 1e-15);
  const Arc rest = *ArcAround({0, 0, 0}, {2, 0, 0}, {0, 7, 0}, {0, 0, -1});
  EXPECT_NEAR(rest.sweep_rad, 1.5 * kPi, 1e-15);
  EXPECT_TRUE(Near(PointAt(rest, 1), {0, 2, 0}, 1e-14));
  EXPECT_EQ(ArcAround({0, 0, 0}, {2, 0, 0}, {0, 0, 3}, {0, 0, 1}).error().code,
            ErrorCode::kDegenerate);
}

TEST(Circle, QuarterPointsAreExact) {
  const Circle circle{{}, 3};
  EXPECT_EQ(PointAt(circle, 0), Vec3(3, 0, 0));
  EXPECT_EQ(PointAt(circle, 0.25), Vec3(0, 3, 0));
  EXPECT_EQ(PointAt(circle, 0.5), Vec3(-3, 0, 0));
  EXPECT_EQ(PointAt(circle, 0.75), Vec3(0, -3, 0));
}

TEST(Circle, AreaAndCentroidAreThoseOfADisc) {
  const Circle circle{{Vec3(1, 2, 3), Vec3(0, 1, 0), Vec3(0, 0, 1)}, 2.5};
  EXPECT_NEAR(*EnclosedArea(circle), kPi * 6.25, 1e-12);
  EXPECT_TRUE(Near(*Centroid(circle), {1, 2, 3}, 1e-12));
}

TEST(Region, HalfDiscHasItsCentroidFourThirdsOfTheRadiusOverPi) {
  const Arc half{{}, 3, kPi};
  const Chain region = *JoinChain({half, Line{{-3, 0, 0}, {3, 0, 0}}});
  EXPECT_NEAR(*EnclosedArea(region), 4.5 * kPi, 1e-12);
  EXPECT_TRUE(Near(*Centroid(region), {0, 4 / kPi, 0}, 1e-12));
}

TEST(Region, OpenOrTwistedCurvesHaveNoArea) {
  EXPECT_EQ(EnclosedArea(Line{{0, 0, 0}, {1, 0, 0}}).error().code, ErrorCode::kNotClosed);
  const Polyline saddle{{{0, 0, 0}, {1, 0, 1}, {1, 1, 0}, {0, 1, 1}}, true};
  EXPECT_EQ(EnclosedArea(saddle).error().code, ErrorCode::kNotPlanar);
  EXPECT_FALSE(PlaneOf(saddle));
}

TEST(Region, PlaneOfAPolygonHasItsOriginAtTheStartAndRunsCounterClockwise) {
  const Polyline square{{{1, 1, 5}, {1, 3, 5}, {3, 3, 5}, {3, 1, 5}}, true};
  const Frame plane = *PlaneOf(square);
  EXPECT_EQ(plane.origin, Vec3(1, 1, 5));
  EXPECT_TRUE(Near(plane.z(), {0, 0, -1}, 1e-15));
  EXPECT_NEAR(*EnclosedArea(square), 4, 1e-14);
  EXPECT_TRUE(Near(*Centroid(square), {2, 2, 5}, 1e-14));
}

RC_GTEST_PROP(AnyCurve, LengthScalesUnderASimilarity, ()) {
  const Curve curve = DrawCurve();
  double scale = 1;
  const Affine m = DrawSimilarity(&scale);
  const double length = Length(curve);
  RC_ASSERT(std::abs(Length(Transformed(curve, m)) - scale * length) <= 1e-9 * scale * length);
}

RC_GTEST_PROP(AnyCurve, TransformedPointsAreThePointsTransformed, ()) {
  const Curve curve = DrawCurve();
  const Affine m = DrawStretch();
  const Curve image = Transformed(curve, m);
  for (int i = 0; i <= 20; ++i) {
    RC_ASSERT(NearestPoint(image, m * PointAt(curve, i / 20.0)).distance_m < 1e-9);
  }
  const Curve back = Transformed(image, Affine(m.inverse()));
  for (int i = 0; i <= 20; ++i) {
    RC_ASSERT(NearestPoint(curve, PointAt(back, i / 20.0)).distance_m < 1e-9);
  }
}

RC_GTEST_PROP(AnyCurve, ReversedRunsBackwardsAndTwiceIsTheSame, ()) {
  const Curve curve = DrawCurve();
  const Curve reversed = Reversed(curve), twice = Reversed(reversed);
  for (int i = 0; i <= 16; ++i) {
    const double t = i / 16.0;
    RC_ASSERT((PointAt(reversed, 1 - t) - PointAt(curve, t)).norm() < 1e-10);
    RC_ASSERT((PointAt(twice, t) - PointAt(curve, t)).norm() < 1e-10);
  }
}

RC_GTEST_PROP(AnyCurve, BsplineFormHasTheSamePointsAndLength, ()) {
  const Curve curve = DrawCurve();
  const Curve spline = ToBspline(curve);
  RC_ASSERT(Check(spline).has_value());
  const double length = Length(curve);
  RC_ASSERT(std::abs(Length(spline) - length) <= 1e-9 * (1e-3 + length));
  for (int i = 0; i <= 20; ++i) {
    RC_ASSERT(NearestPoint(curve, PointAt(spline, i / 20.0)).distance_m < 1e-10);
    RC_ASSERT(NearestPoint(spline, PointAt(curve, i / 20.0)).distance_m < 1e-9);
  }
}

RC_GTEST_PROP(AnyCurve, BoxHoldsItsPointsAndIsTouchedOnEverySide, ()) {
  const Curve curve = DrawCurve();
  const Box box = BoundingBox(curve);
  Box seen;
  for (int i = 0; i <= 2000; ++i) seen.Add(PointAt(curve, i / 2000.0));
  for (int axis = 0; axis < 3; ++axis) {
    RC_ASSERT(seen.max[axis] <= box.max[axis] + 1e-9);
    RC_ASSERT(seen.min[axis] >= box.min[axis] - 1e-9);
    // Samples lie a second-order distance from the extreme; a box that is not tight shows.
    RC_ASSERT(seen.max[axis] >= box.max[axis] - 0.02 * (1 + Length(curve)) / 50);
    RC_ASSERT(seen.min[axis] <= box.min[axis] + 0.02 * (1 + Length(curve)) / 50);
  }
}

RC_GTEST_PROP(AnyCurve, NothingSampledIsNearerThanTheNearestPoint, ()) {
  const Curve curve = DrawCurve();
  const Vec3 p = DrawPoint(30);
  const Nearest nearest = NearestPoint(curve, p);
  RC_ASSERT((PointAt(curve, nearest.t) - nearest.point).norm() < 1e-9);
  RC_ASSERT(std::abs((nearest.point - p).norm() - nearest.distance_m) < 1e-12);
  for (int i = 0; i <= 500; ++i) {
    RC_ASSERT((PointAt(curve, i / 500.0) - p).norm() >= nearest.distance_m - 1e-9);
  }
}

RC_GTEST_PROP(AnyCurve, FractionsOfTheLengthAreReachedInOrder, ()) {
  const Curve curve = DrawCurve();
  const double length = Length(curve);
  double walked = 0;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    const double step = (PointAtFraction(curve, (i + 1.0) / kSteps) -
                         PointAtFraction(curve, static_cast<double>(i) / kSteps))
                            .norm();
    RC_ASSERT(step <= length / kSteps * (1 + 1e-9) + 1e-12);
    walked += step;
  }
  RC_ASSERT(walked >= 0.9 * length);
}

RC_GTEST_PROP(AnyCurve, TangentIsTheDirectionOfTravel, ()) {
  const Curve curve = DrawCurve();
  const double t = Within(0.01, 0.99);
  const Vec3 ahead = PointAt(curve, t + 1e-7) - PointAt(curve, t);
  const Vec3 behind = PointAt(curve, t) - PointAt(curve, t - 1e-7);
  RC_PRE(ahead.norm() > 1e-9 && behind.norm() > 1e-9);
  RC_PRE(ahead.normalized().dot(behind.normalized()) > 1 - 1e-9);
  RC_ASSERT(TangentAt(curve, t).dot(ahead.normalized()) > 1 - 1e-5);
}

TEST(Bspline, EllipseFromAStretchedCircleHasItsAreaAndBox) {
  const Curve ellipse = Transformed(Circle{{}, 1}, Moved(Vec3(4, 2, 1).asDiagonal(), {1, 1, 0}));
  ASSERT_TRUE(std::holds_alternative<BsplineCurve>(ellipse));
  EXPECT_NEAR(*EnclosedArea(ellipse), 8 * kPi, 8 * kPi * 1e-12);
  // 4·a·E(e) of a = 4, b = 2.
  EXPECT_NEAR(Length(ellipse), 16 * std::comp_ellint_2(std::sqrt(0.75)), 1e-10);
  EXPECT_TRUE(Near(BoundingBox(ellipse).max, {5, 3, 0}, 1e-9));
  EXPECT_TRUE(Near(BoundingBox(ellipse).min, {-3, -1, 0}, 1e-9));
}

TEST(Bspline, TurnedEllipseHasATightBox) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3::UnitZ()).toRotationMatrix();
  const Curve ellipse =
      Transformed(Circle{{}, 1}, Moved(turn * Vec3(4, 2, 1).asDiagonal(), Vec3::Zero()));
  const double reach = std::hypot(4 * std::cos(0.7), 2 * std::sin(0.7));
  EXPECT_NEAR(BoundingBox(ellipse).max.x(), reach, 1e-9);
  EXPECT_NEAR(BoundingBox(ellipse).min.x(), -reach, 1e-9);
}

TEST(Bspline, ArcStaysAnArcUnderASimilarityAndUnderAMirror) {
  const Arc arc{{Vec3(1, 0, 0)}, 2, 1};
  const Curve image = Transformed(arc, Moved(Vec3(-3, 3, 3).asDiagonal(), Vec3::Zero()));
  ASSERT_TRUE(std::holds_alternative<Arc>(image));
  EXPECT_DOUBLE_EQ(std::get<Arc>(image).radius, 6);
  EXPECT_TRUE(Near(PointAt(image, 1), {-3 - 6 * std::cos(1.0), 6 * std::sin(1.0), 0}, 1e-14));
}

TEST(Bspline, HalfCircleIsTwoSpansAndFullCircleFour) {
  EXPECT_EQ(ToBspline(Arc{{}, 1, kPi}).knots, (std::vector<double>{0, 0, 0, 1, 1, 2, 2, 2}));
  EXPECT_EQ(ToBspline(Circle{{}, 1}).knots,
            (std::vector<double>{0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}));
}

TEST(Bspline, NearestPointsOfACurveWithTwoFeetIsTheNearerFoot) {
  // The parabola (t, t²) over [-2, 2], seen from (0.1, 3): two feet, the one to the right nearer.
  const BsplineCurve parabola{2, {0, 0, 0, 1, 1, 1}, {{-2, 4, 0}, {0, -4, 0}, {2, 4, 0}}, {}};
  const Nearest nearest = NearestPoint(parabola, {0.1, 3, 0});
  const double x = nearest.point.x();
  EXPECT_GT(x, 0);
  EXPECT_NEAR(nearest.point.y(), x * x, 1e-12);
  EXPECT_NEAR((x - 0.1) + 2 * x * (x * x - 3), 0, 1e-8);
}

}  // namespace
}  // namespace tranos::geom
