// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/curve_part.h"

#include "geom/crossing.h"
#include "shapes.h"

namespace tranos::geom {
namespace {

RC_GTEST_PROP(PartOf, RunsAlongTheCurveFromEndToEnd, ()) {
  const Curve curve = DrawCurve();
  RC_PRE(Length(curve) > 0.5);
  const double from = ParameterAtFraction(curve, Within(0, 0.45));
  const double to = ParameterAtFraction(curve, Within(0.55, 1));
  const Curve part = *PartOf(curve, from, to);
  const double size = 1e-9 * (1 + Length(curve));
  RC_ASSERT(Near(PointAt(part, 0), PointAt(curve, from), size));
  RC_ASSERT(Near(PointAt(part, 1), PointAt(curve, to), size));
  for (int i = 0; i <= 20; ++i) {
    RC_ASSERT(NearestPoint(curve, PointAt(part, i / 20.0)).distance_m < 10 * size);
  }
}

RC_GTEST_PROP(Divided, PartsMakeUpTheWhole, ()) {
  const Curve curve = DrawCurve();
  RC_PRE(Length(curve) > 0.5);
  const int count = *rc::gen::inRange(2, 7);
  const std::vector<Curve> parts = Divided(curve, EqualParameters(curve, count));
  RC_ASSERT(parts.size() == static_cast<std::size_t>(count));
  for (const Curve& part : parts) {
    RC_ASSERT(std::abs(Length(part) - Length(curve) / count) < 1e-7 * Length(curve));
  }
}

TEST(PartOf, RunsThroughTheStartOfAClosedCurve) {
  const Curve part = *PartOf(Circle{Frame{}, 1}, 0.75, 0.25);
  EXPECT_NEAR(Length(part), kPi, 1e-12);
  EXPECT_TRUE(Near(PointAt(part, 0.5), {1, 0, 0}, 1e-12));
  EXPECT_FALSE(PartOf(Line{{0, 0, 0}, {1, 0, 0}}, 0.75, 0.25).has_value());
  EXPECT_FALSE(PartOf(Line{{0, 0, 0}, {1, 0, 0}}, 0.5, 0.5).has_value());
}

TEST(PartOf, KeepsKinds) {
  const Curve square = Polyline{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, true};
  EXPECT_TRUE(std::holds_alternative<Line>(*PartOf(square, 0.05, 0.2)));
  EXPECT_TRUE(std::holds_alternative<Polyline>(*PartOf(square, 0.05, 0.6)));
  EXPECT_TRUE(std::holds_alternative<Arc>(*PartOf(Circle{Frame{}, 1}, 0.1, 0.6)));
}

TEST(Lengthened, GoesOnStraightOrRound) {
  const Line line{{0, 0, 0}, {3, 4, 0}};
  EXPECT_TRUE(Near(PointAt(*LengthenedBy(line, CurveEnd::kEnd, 5), 1), {6, 8, 0}, 1e-12));
  EXPECT_TRUE(Near(PointAt(*LengthenedBy(line, CurveEnd::kStart, 5), 0), {-3, -4, 0}, 1e-12));
  const Arc quarter{Frame{}, 2, kPi / 2};
  EXPECT_TRUE(Near(PointAt(*LengthenedBy(quarter, CurveEnd::kEnd, kPi), 1), {-2, 0, 0}, 1e-12));
  EXPECT_TRUE(Near(PointAt(*LengthenedBy(quarter, CurveEnd::kStart, kPi), 0), {0, -2, 0}, 1e-12));
  EXPECT_FALSE(LengthenedBy(quarter, CurveEnd::kEnd, 4 * kPi).has_value());
  EXPECT_FALSE(LengthenedBy(line, CurveEnd::kEnd, 0).has_value());
  EXPECT_FALSE(LengthenedBy(Circle{Frame{}, 1}, CurveEnd::kEnd, 1).has_value());
}

TEST(Lengthened, StopsAtTheFirstThatItMeets) {
  const Line line{{0, 0, 0}, {1, 0, 0}};
  const Curve near = Line{{5, -1, 0}, {5, 1, 0}}, far = Line{{9, -1, 0}, {9, 1, 0}};
  const Curve behind = Line{{-3, -1, 0}, {-3, 1, 0}};
  EXPECT_NEAR(Length(*LengthenedTo(line, CurveEnd::kEnd, {far, behind, near})), 5, 1e-12);
  EXPECT_NEAR(Length(*LengthenedTo(line, CurveEnd::kStart, {far, behind, near})), 4, 1e-12);
  const auto missed = LengthenedTo(line, CurveEnd::kEnd, {behind});
  ASSERT_FALSE(missed.has_value());
  EXPECT_EQ(missed.error().code, ErrorCode::kDoNotMeet);
  // From a line that stands on it already, it goes on to the next.
  const Curve here = Line{{1, -1, 0}, {1, 1, 0}};
  EXPECT_NEAR(Length(*LengthenedTo(line, CurveEnd::kEnd, {here, far})), 9, 1e-12);
}

}  // namespace
}  // namespace tranos::geom
