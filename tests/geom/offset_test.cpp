// SPDX-License-Identifier: GPL-3.0-or-later
// Parallels by their areas and by how near they come to the curve.
#include "geom/offset.h"

#include "shapes.h"

namespace tranos::geom {
namespace {

const Vec3 kUp = Vec3::UnitZ();

Curve Rectangle(double width, double depth) {
  return Polyline{{{0, 0, 0}, {width, 0, 0}, {width, depth, 0}, {0, depth, 0}}, true};
}
std::vector<Curve> MustOffset(const Curve& curve, double distance_m,
                              OffsetJoin join = OffsetJoin::kMitred) {
  auto parallels = Offset(curve, kUp, distance_m, join);
  EXPECT_TRUE(parallels.has_value()) << parallels.error().detail;
  return parallels.value_or(std::vector<Curve>{});
}
double AreaOf(const std::vector<Curve>& curves) {
  double sum = 0;
  for (const Curve& curve : curves) {
    EXPECT_TRUE(IsClosed(curve));
    sum += EnclosedArea(curve).value_or(-1000);
  }
  return sum;
}

TEST(Offset, OfARectangle) {
  EXPECT_NEAR(AreaOf(MustOffset(Rectangle(6, 4), 1)), 4 * 2, 1e-9);
  EXPECT_NEAR(AreaOf(MustOffset(Rectangle(6, 4), -1)), 8 * 6, 1e-9);
  EXPECT_NEAR(AreaOf(MustOffset(Rectangle(6, 4), -1, OffsetJoin::kRounded)), 24 + 20 + kPi, 1e-9);
  EXPECT_TRUE(std::holds_alternative<Polyline>(MustOffset(Rectangle(6, 4), 1)[0]));
  EXPECT_EQ(std::get<Polyline>(MustOffset(Rectangle(6, 4), 1)[0]).vertices.size(), 4u);
  EXPECT_TRUE(MustOffset(Rectangle(6, 4), 2.5).empty());
  EXPECT_TRUE(MustOffset(Rectangle(6, 4), 2).empty());  // nothing but a seam
}

TEST(Offset, OfRoundCurvesIsRound) {
  const auto outer = MustOffset(Circle{Frame{}, 3}, -1);
  ASSERT_EQ(outer.size(), 1u);
  EXPECT_EQ(std::get<Circle>(outer[0]).radius, 4);
  EXPECT_TRUE(MustOffset(Circle{Frame{}, 3}, 3).empty());
  const auto arc = MustOffset(Arc{Frame{}, 3, 1}, 1);
  ASSERT_EQ(arc.size(), 1u);
  EXPECT_EQ(std::get<Arc>(arc[0]).radius, 2);
}

TEST(Offset, OfAChainGoesOnFromLineToArc) {
  // A stadium: its parallels are stadiums.
  Frame right, left;
  right.origin = {4, 0, 0}, right.x = -Vec3::UnitY(), right.y = Vec3::UnitX();
  left.x = Vec3::UnitY(), left.y = -Vec3::UnitX();
  const Chain stadium{{Line{{0, -2, 0}, {4, -2, 0}}, Arc{right, 2, kPi}, Line{{4, 2, 0}, {0, 2, 0}},
                       Arc{left, 2, kPi}},
                      true};
  EXPECT_NEAR(AreaOf(MustOffset(stadium, 1)), 8 + kPi, 1e-9);
  EXPECT_NEAR(AreaOf(MustOffset(stadium, -1)), 24 + 9 * kPi, 1e-9);
}

TEST(Offset, OfAWaistFallsIntoTwo) {
  // Two rooms with a passage a metre wide between them.
  const Curve rooms = Polyline{{{0, 0, 0},
                                {4, 0, 0},
                                {4, 1.5, 0},
                                {6, 1.5, 0},
                                {6, 0, 0},
                                {10, 0, 0},
                                {10, 4, 0},
                                {6, 4, 0},
                                {6, 2.5, 0},
                                {4, 2.5, 0},
                                {4, 4, 0},
                                {0, 4, 0}},
                               true};
  const auto inside = MustOffset(rooms, 1);
  ASSERT_EQ(inside.size(), 2u);
  EXPECT_NEAR(AreaOf(inside), 2 * 4, 1e-9);
}

TEST(Offset, OfAnOpenPathMitresAndRounds) {
  const Polyline path{{{0, 0, 0}, {4, 0, 0}, {4, 3, 0}}, false};
  const auto left = MustOffset(path, 1), right = MustOffset(path, -1);
  ASSERT_EQ(left.size(), 1u);
  EXPECT_NEAR(Length(left[0]), 3 + 2, 1e-9);
  EXPECT_NEAR(Length(right[0]), 5 + 4, 1e-9);
  EXPECT_NEAR(Length(MustOffset(path, -1, OffsetJoin::kRounded)[0]), 4 + 3 + kPi / 2, 1e-9);
}

TEST(Offset, CutsSharpTipsOff) {
  const Polyline needle{{{0, 0, 0}, {10, 0, 0}, {0, 1, 0}}, false};
  const auto outside = MustOffset(needle, -1);
  ASSERT_EQ(outside.size(), 1u);
  const Box box = BoundingBox(outside[0]);
  EXPECT_LT(box.max.x(), 10 + 4.1);
  EXPECT_GT(box.max.x(), 10 + 3.9);
}

TEST(Offset, OfNearlyStraightCornersIsOne) {
  for (const double bend : {1e-9, 1e-7, 1e-5, 1e-3, 1e-1}) {
    const Polyline path{{{0, 0, 0}, {4, 0, 0}, {8, bend, 0}}, false};
    for (const double distance : {0.01, 1.0, -0.01, -1.0}) {
      EXPECT_EQ(MustOffset(path, distance).size(), 1u) << bend << " " << distance;
    }
  }
}

TEST(Offset, OfManyPiecesThatAllMeet) {
  Polyline round{{}, true};
  for (int i = 0; i < 600; ++i) {
    const double angle = 2 * kPi * i / 600;
    round.vertices.push_back({5 * std::cos(angle), 5 * std::sin(angle), 0});
  }
  const auto inside = MustOffset(round, 4.9);
  ASSERT_EQ(inside.size(), 1u);
  EXPECT_NEAR(AreaOf(inside), kPi * 0.01, 1e-4);
}

TEST(Offset, RefusesWhatHasNone) {
  EXPECT_EQ(Offset(ToBspline(Circle{Frame{}, 1}), kUp, 1, OffsetJoin::kMitred).error().code,
            ErrorCode::kOutOfRange);
  EXPECT_EQ(Offset(Rectangle(1, 1), kUp, 0, OffsetJoin::kMitred).error().code,
            ErrorCode::kOutOfRange);
  EXPECT_EQ(Offset(Rectangle(1, 1), Vec3::UnitX(), 1, OffsetJoin::kMitred).error().code,
            ErrorCode::kNotPlanar);
}

// Rounded parallels of any star lie at the distance and nowhere nearer.
RC_GTEST_PROP(Offset, RoundedKeepsItsDistance, ()) {
  Polyline star{{}, true};
  const int count = *rc::gen::inRange(3, 12);
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * kPi * i / count, radius = Within(2, 9);
    star.vertices.push_back(radius * Vec3(std::cos(angle), std::sin(angle), 0));
  }
  const double distance = Within(0.1, 2);
  for (const double side : {distance, -distance}) {
    for (const Curve& parallel : MustOffset(star, side, OffsetJoin::kRounded)) {
      RC_ASSERT(IsClosed(parallel));
      for (int i = 0; i < 50; ++i) {
        const double near_m = NearestPoint(star, PointAt(parallel, i / 50.0)).distance_m;
        RC_ASSERT(std::abs(near_m - distance) < 1e-5);
      }
    }
  }
}

}  // namespace
}  // namespace tranos::geom
