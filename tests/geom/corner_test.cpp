// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/corner.h"

#include "shapes.h"

namespace tranos::geom {
namespace {

Curve Rectangle(double width, double depth) {
  return Polyline{{{0, 0, 0}, {width, 0, 0}, {width, depth, 0}, {0, depth, 0}}, true};
}

TEST(Rounded, RoundsEveryCornerOfARectangle) {
  const Curve rounded = *Rounded(Rectangle(6, 4), 1);
  EXPECT_TRUE(IsClosed(rounded));
  EXPECT_NEAR(*EnclosedArea(rounded), 24 - 4 + kPi, 1e-9);
  EXPECT_NEAR(Length(rounded), 20 - 8 + 2 * kPi, 1e-9);
  EXPECT_TRUE(CornersOf(rounded).empty());
}

TEST(Rounded, UpToWhereSidesAreUsedUp) {
  const Curve slot = *Rounded(Rectangle(6, 4), 2);
  EXPECT_NEAR(*EnclosedArea(slot), 24 - 16 + 4 * kPi, 1e-9);
  const auto beyond = Rounded(Rectangle(6, 4), 2.0001);
  ASSERT_FALSE(beyond.has_value());
  EXPECT_EQ(beyond.error().code, ErrorCode::kOutOfRange);
}

TEST(Rounded, OnlyTheCornerGiven) {
  const Curve rectangle = Rectangle(6, 4);
  const Curve rounded = *Rounded(rectangle, 1, CornersOf(rectangle)[1]);
  EXPECT_EQ(CornersOf(rounded).size(), 3u);
  EXPECT_NEAR(*EnclosedArea(rounded), 24 - 1 + kPi / 4, 1e-9);
}

// The arc begins and ends along its neighbours, at both kinds of corner.
RC_GTEST_PROP(Rounded, IsSmooth, ()) {
  const Frame frame = DrawFrame();
  const double angle = Within(0.2, 2.9), radius = Within(0.05, 0.3);
  const bool left = *rc::gen::arbitrary<bool>();
  const Vec3 corner = frame.origin;
  const Line in{corner - 5 * frame.x, corner};
  const Vec3 out = std::cos(angle) * frame.x + (left ? 1 : -1) * std::sin(angle) * frame.y;
  const Polyline path{{in.start, corner, corner + 5 * out}, false};
  RC_PRE(radius * std::tan(angle / 2) < 4.9);
  const Curve rounded = *Rounded(path, radius);
  RC_ASSERT(CornersOf(rounded).empty());
  RC_ASSERT(Near(PointAt(rounded, 0), in.start, 1e-9));
  RC_ASSERT(Near(PointAt(rounded, 1), path.vertices[2], 1e-9));
  RC_ASSERT(std::abs(Length(rounded) - (10 - 2 * radius * std::tan(angle / 2) + radius * angle)) <
            1e-8);
}

TEST(Rounded, BetweenALineAndAnArc) {
  // A half disc: the corners between the diameter and the arc.
  const Chain half{{Line{{-5, 0, 0}, {5, 0, 0}}, Arc{Frame{}, 5, kPi}}, true};
  const Curve rounded = *Rounded(half, 1);
  EXPECT_TRUE(CornersOf(rounded).empty());
  EXPECT_LT(*EnclosedArea(rounded), kPi * 12.5);
  EXPECT_GT(*EnclosedArea(rounded), kPi * 12.5 - 2);
  EXPECT_FALSE(Rounded(half, 2.6).has_value());
}

TEST(Rounded, RefusesWhatHasNoCorner) {
  EXPECT_EQ(Rounded(Circle{Frame{}, 1}, 0.1).error().code, ErrorCode::kDegenerate);
  EXPECT_EQ(Rounded(Rectangle(1, 1), 0).error().code, ErrorCode::kDegenerate);
  const Polyline back{{{0, 0, 0}, {4, 0, 0}, {1, 0, 0}}, false};
  EXPECT_EQ(Rounded(back, 0.1).error().code, ErrorCode::kOutOfRange);
}

TEST(CutOff, TakesTrianglesOff) {
  EXPECT_NEAR(*EnclosedArea(*CutOff(Rectangle(6, 4), 1, 2)), 24 - 4, 1e-12);
  EXPECT_NEAR(*EnclosedArea(*CutOff(Rectangle(6, 4), 2, 2)), 24 - 8, 1e-12);
  EXPECT_FALSE(CutOff(Rectangle(6, 4), 2, 2.1).has_value());
  EXPECT_FALSE(CutOff(Rectangle(6, 4), 5, 0.5).has_value());
}

TEST(RoundedBetween, LeadsLinesToTheirCorner) {
  const Line a{{0, 0, 0}, {4, 0, 0}}, b{{6, 1, 0}, {6, 5, 0}};
  const Joint joint = *RoundedBetween(a, b, 1);
  EXPECT_TRUE(Near(PointAt(joint.a, 0), {0, 0, 0}, 1e-9));
  EXPECT_TRUE(Near(PointAt(joint.a, 1), {5, 0, 0}, 1e-9));
  EXPECT_TRUE(Near(PointAt(joint.b, 0), {6, 1, 0}, 1e-9));
  EXPECT_NEAR(Length(joint.between), kPi / 2, 1e-9);
  // Directions are kept, and the shorter ends are cut off.
  const Joint crossed = *RoundedBetween(Line{{9, 0, 0}, {0, 0, 0}}, Line{{2, -1, 0}, {2, 5, 0}}, 1);
  EXPECT_TRUE(Near(PointAt(crossed.a, 0), {9, 0, 0}, 1e-9));
  EXPECT_TRUE(Near(PointAt(crossed.a, 1), {3, 0, 0}, 1e-9));
  EXPECT_TRUE(Near(PointAt(crossed.b, 0), {2, 1, 0}, 1e-9));
}

TEST(RoundedBetween, RefusesParallelsAndTooLargeRadii) {
  const Line a{{0, 0, 0}, {4, 0, 0}};
  EXPECT_EQ(RoundedBetween(a, Line{{0, 1, 0}, {4, 1, 0}}, 1).error().code, ErrorCode::kDoNotMeet);
  EXPECT_EQ(RoundedBetween(a, Line{{4, 0, 0}, {4, 3, 0}}, 3.1).error().code,
            ErrorCode::kOutOfRange);
}

}  // namespace
}  // namespace tranos::geom
