// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of elements.
#include "elements.h"

namespace tranos::interp {
namespace {

TEST(Measures, OfElements) {
  Bench bench;
  ExpectSame(bench.Call("length", {LineOf({0, 0, 0}, {3, 4, 0})}), M(5));
  const Value square = ShapeOf({{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}});
  EXPECT_NEAR(bench.Call("area", {square}).number(), 6, 1e-12);
  EXPECT_EQ(bench.Call("area", {square}).dimension(), model::kArea);
  const auto code = [&](std::string_view name, std::vector<Value> arguments) {
    return FailureOf([&] { bench.Call(name, std::move(arguments)); }).code;
  };
  EXPECT_EQ(code("area", {LineOf({0, 0, 0}, {3, 4, 0})}), Code::kNotClosed);
  EXPECT_EQ(code("area", {ShapeOf({{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 1}})}),
            Code::kNotPlanar);
  EXPECT_EQ(code("volume", {square}), Code::kNotClosed);
  EXPECT_EQ(code("length", {PointOfElement({0, 0, 0})}), Code::kWrongElement);
  EXPECT_EQ(code("area", {N(1)}), Code::kWrongType);
}

TEST(Measures, VolumeUnderASurface) {
  Bench bench;
  const Value roof = RuledOf({{0, 0, 2}, {4, 0, 2}}, {{0, 3, 4}, {4, 3, 4}});
  EXPECT_NEAR(bench.Call("volume_under", {roof}).number(), 36, 1e-9);
  EXPECT_NEAR(bench.Call("volume_under", {roof, N(1)}).number(), 24, 1e-9);
  const Value wall = RuledOf({{0, 0, 0}, {4, 0, 0}}, {{0, 0, 4}, {4, 0, 4}});
  EXPECT_EQ(FailureOf([&] { bench.Call("volume_under", {wall}); }).code, Code::kNotAGraph);
  EXPECT_EQ(FailureOf([&] {
              bench.Call("volume_under", {LineOf({0, 0, 0}, {1, 0, 0})});
            }).code,
            Code::kWrongElement);
  // Side by side they add up; over one another they are refused.
  const Value beside = RuledOf({{4, 0, 2}, {8, 0, 2}}, {{4, 3, 4}, {8, 3, 4}});
  EXPECT_NEAR(bench.Call("volume_under", {GroupOf({{"a", roof}, {"b", beside}})}).number(), 72,
              1e-9);
  EXPECT_EQ(FailureOf([&] {
              bench.Call("volume_under", {GroupOf({{"a", roof}, {"b", roof}})});
            }).code,
            Code::kNotAGraph);
}

TEST(Distance, IsExactBetweenLinesAndPoints) {
  Bench bench;
  const auto distance = [&](const Value& a, const Value& b) {
    return bench.Call("distance", {a, b}).number();
  };
  EXPECT_DOUBLE_EQ(distance(LineOf({0, 0, 0}, {0, 20, 0}), LineOf({35.5, 5, 0}, {35.5, 9, 0})),
                   35.5);
  EXPECT_DOUBLE_EQ(distance(LineOf({0, 0, 0}, {10, 0, 0}), LineOf({5, -5, 3}, {5, 5, 3})), 3);
  EXPECT_DOUBLE_EQ(distance(LineOf({0, 0, 0}, {1, 0, 0}), LineOf({4, 4, 0}, {4, 9, 0})), 5);
  EXPECT_EQ(distance(LineOf({0, 0, 0}, {2, 2, 0}), LineOf({0, 2, 0}, {2, 0, 0})), 0);
  EXPECT_DOUBLE_EQ(distance(LineOf({0, 0, 0}, {10, 0, 0}), P(5, 2, 0)), 2);
  EXPECT_DOUBLE_EQ(distance(P(-3, 4, 0), LineOf({0, 0, 0}, {10, 0, 0})), 5);
  EXPECT_DOUBLE_EQ(distance(PointOfElement({0, 0, 0}), PointOfElement({3, 4, 0})), 5);
  const Value moved = bench.PlusMinus(M(2), M(0.1));
  const Value to_line = bench.Call("distance", {LineOf({0, 0, 0}, {10, 0, 0}), L({M(5), moved})});
  EXPECT_DOUBLE_EQ(bench.SigmaOf(to_line), 0.1);
}

TEST(Distance, IsRefinedBetweenCurvesAndSurfaces) {
  Bench bench;
  const auto distance = [&](const Value& a, const Value& b) {
    return bench.Call("distance", {a, b}).number();
  };
  EXPECT_NEAR(distance(CircleOf({0, 0, 0}, 2), CircleOf({10, 0, 0}, 3)), 5, 1e-9);
  EXPECT_NEAR(distance(CircleOf({0, 0, 0}, 2), CircleOf({1, 7, 0}, 1)), std::sqrt(50.0) - 3, 1e-9);
  EXPECT_NEAR(distance(CircleOf({0, 0, 0}, 2), LineOf({-9, 3.3, 1}, {9, 3.1, 1})),
              distance(LineOf({-9, 3.3, 1}, {9, 3.1, 1}), CircleOf({0, 0, 0}, 2)), 1e-9);
  const Value floor = RuledOf({{0, 0, 0}, {4, 0, 0}}, {{0, 3, 0}, {4, 3, 0}});
  EXPECT_NEAR(distance(floor, CircleOf({2, 2, 5}, 1)), 5, 1e-9);
  const Value roof = RuledOf({{0, 0, 2}, {4, 0, 2}}, {{0, 3, 4}, {4, 3, 4}});
  EXPECT_NEAR(distance(floor, roof), 2, 1e-6);
  EXPECT_EQ(FailureOf([&] { distance(GroupOf({}), floor); }).code, Code::kWrongElement);
}

TEST(Intersection, OfLinesIsAPoint) {
  Bench bench;
  ExpectSame(
      bench.Call("intersection", {LineOf({0, 0, 1}, {4, 0, 1}), LineOf({1, -1, 1}, {1, 1, 1})}),
      P(1, 0, 1));
  const auto failure = [&](const Value& a, const Value& b) {
    return FailureOf([&] { bench.Call("intersection", {a, b}); });
  };
  const OpFailure apart = failure(LineOf({0, 0, 0}, {4, 0, 0}), LineOf({5, 1, 0}, {5, 2, 0}));
  EXPECT_EQ(apart.code, Code::kDoNotMeet);
  EXPECT_NE(apart.help.find("(5 m, 0 m, 0 m)"), std::string::npos) << apart.help;
  EXPECT_NE(
      failure(LineOf({0, 0, 0}, {4, 0, 0}), LineOf({0, 1, 0}, {4, 1, 0})).message.find("parallel"),
      std::string::npos);
  EXPECT_NE(
      failure(LineOf({0, 0, 0}, {4, 0, 0}), LineOf({1, -1, 2}, {1, 1, 2})).message.find("2 m"),
      std::string::npos);
  EXPECT_EQ(failure(LineOf({0, 0, 0}, {4, 0, 0}), PointOfElement({0, 0, 0})).code,
            Code::kWrongElement);
}

void ExpectPoints(const Value& list, const std::vector<geom::Vec3>& expected) {
  ASSERT_EQ(list.list().size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_LT((PointOf(list.list()[i]) - expected[i]).norm(), 1e-9) << Format(list, kMetre, -1);
  }
}

TEST(Intersection, OfRoundCurvesIsAList) {
  Bench bench;
  const auto meet = [&](const Value& a, const Value& b) {
    return bench.Call("intersection", {a, b});
  };
  ExpectPoints(meet(LineOf({-9, 3, 0}, {9, 3, 0}), CircleOf({0, 0, 0}, 5)),
               {{-4, 3, 0}, {4, 3, 0}});
  ExpectPoints(meet(CircleOf({0, 0, 0}, 5), LineOf({-9, 5, 0}, {9, 5, 0})), {{0, 5, 0}});
  ExpectPoints(meet(CircleOf({0, 0, 0}, 5), LineOf({-9, 6, 0}, {9, 6, 0})), {});
  ExpectPoints(meet(CircleOf({0, 0, 0}, 5), CircleOf({8, 0, 0}, 5)), {{4, 3, 0}, {4, -3, 0}});
  ExpectPoints(meet(CircleOf({0, 0, 0}, 5), LineOf({3, 4, -1}, {3, 4, 1})), {{3, 4, 0}});
  // Only the half of the circle that the arc is.
  ExpectPoints(meet(LineOf({0, -9, 0}, {0, 9, 0}), ArcOf({0, 0, 0}, 5, geom::kPi)), {{0, 5, 0}});
  // A corner of the shape belongs to two of its sides, and is one point.
  const Value square = ShapeOf({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  ExpectPoints(meet(square, LineOf({-1, -1, 0}, {3, 3, 0})), {{0, 0, 0}, {2, 2, 0}});
}

TEST(Intersection, OfCirclesAcrossOneAnother) {
  Bench bench;
  const geom::Frame upright{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
  const Value found =
      bench.Call("intersection", {CircleOf({0, 0, 0}, 5), ElementOf(geom::Circle{upright, 5})});
  ASSERT_EQ(found.list().size(), 2u);
  for (const Value& point : found.list()) {
    EXPECT_NEAR(std::abs(PointOf(point).x()), 5, 1e-9);
  }
}

TEST(Project, FallsOnLinesPlanesAndElements) {
  Bench bench;
  ExpectSame(bench.Call("project", {P(7, 3, 0), LineOf({0, 0, 0}, {4, 0, 0})}), P(7, 0, 0));
  ExpectSame(bench.Call("project", {P(7, 3, 5), Value::Plane({})}), P(7, 3, 0));
  const Value foot = bench.Call("project", {P(10, 0, 0), CircleOf({0, 0, 0}, 2)});
  EXPECT_LT((PointOf(foot) - geom::Vec3(2, 0, 0)).norm(), 1e-9);
  EXPECT_EQ(FailureOf([&] { bench.Call("project", {P(1, 2, 3), N(1)}); }).code, Code::kWrongType);
  EXPECT_EQ(FailureOf([&] {
              bench.Call("project", {N(1), Value::Plane({})});
            }).code,
            Code::kWrongType);
}

TEST(Angle, OfLines) {
  Bench bench;
  ExpectSame(bench.Call("angle", {LineOf({0, 0, 0}, {4, 0, 0}), LineOf({0, 0, 0}, {0, 4, 0})}),
             Deg(90));
  EXPECT_EQ(FailureOf([&] {
              bench.Call("angle", {CircleOf({0, 0, 0}, 1), P(1, 0, 0)});
            }).code,
            Code::kWrongElement);
}

}  // namespace
}  // namespace tranos::interp
