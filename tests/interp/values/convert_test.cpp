// SPDX-License-Identifier: GPL-3.0-or-later
#include "values.h"

namespace tranos::interp {
namespace {

model::ElementPtr LineElement() {
  return model::MakeElement(model::kNoElement,
                            std::make_shared<const geom::Curve>(geom::Line{{0, 0, 0}, {1, 0, 0}}),
                            std::make_shared<const model::Attributes>(), nullptr, {});
}

TEST(Convert, TakesWhatTheTypeTakes) {
  struct Row {
    Type type;
    Value value, expected;
    Unit unit = kMetre;
  };
  const Value element = Value::OfElement(LineElement());
  const Row rows[] = {
      {Type::kAny, S("x"), S("x")},
      {Type::kNumber, N(4.5), N(4.5)},
      {Type::kCount, N(4), N(4)},
      {Type::kCount, N(0), N(0)},
      {Type::kLength, M(4), M(4)},
      {Type::kLength, N(400), M(4), kCentimetre},
      {Type::kArea, M2(4), M2(4)},
      {Type::kVolume, M3(4), M3(4)},
      {Type::kAngle, N(30), Deg(30)},
      {Type::kAngle, Deg(30), Deg(30)},
      {Type::kPixel, N(24), Px(24)},
      {Type::kPixel, Px(24), Px(24)},
      {Type::kBoolean, B(true), B(true)},
      {Type::kString, S("x"), S("x")},
      {Type::kString, N(1917), S("1917")},
      {Type::kWord, S("shell"), S("shell")},
      {Type::kLabel, N(3), S("3")},
      {Type::kLabel, S("roof"), S("roof")},
      {Type::kColor, N(255), N(255)},
      {Type::kColor, S("#a0B0c0"), S("#a0B0c0")},
      {Type::kPoint, L({N(1), M(2)}), L({M(1), M(2)})},
      {Type::kPoint, L({N(100), M(2), N(300)}), P(1, 2, 3), kCentimetre},
      {Type::kPoints, L({L({N(1), N(2)}), P(1, 2, 3)}), L({L({M(1), M(2)}), P(1, 2, 3)})},
      {Type::kElement, element, element},
      {Type::kElements, element, L({element})},
      {Type::kElements, L({element, L({element, L({})})}), L({element, element})},
      {Type::kRange, R(1, 2), R(1, 2)},
      {Type::kPlane, Value::Plane({}), Value::Plane({})},
      {Type::kScale, N(2), L({N(2), N(2), N(2)})},
      {Type::kScale, L({N(1), N(-1), N(2)}), L({N(1), N(-1), N(2)})},
      {Type::kSize, L({N(1280), N(960)}), L({N(1280), N(960)})},
      {Type::kSize, L({N(1), Px(16384)}), L({N(1), N(16384)})},
  };
  for (const Row& row : rows) {
    SCOPED_TRACE(Describe(row.type));
    ExpectSame(Convert(row.value, row.type, row.unit, "x"), row.expected);
  }
}

TEST(Convert, RefusesTheRest) {
  struct Row {
    Type type;
    Value value;
    Code code;
  };
  const Value element = Value::OfElement(LineElement());
  const Row rows[] = {
      {Type::kNumber, M(1), Code::kWrongType},
      {Type::kNumber, S("1"), Code::kWrongType},
      {Type::kCount, N(1.5), Code::kWrongType},
      {Type::kCount, N(-1), Code::kWrongType},
      {Type::kCount, N(1e300), Code::kOutOfRange},
      {Type::kLength, Deg(30), Code::kWrongType},
      {Type::kArea, N(5), Code::kWrongType},
      {Type::kVolume, M2(5), Code::kWrongType},
      {Type::kAngle, M(1), Code::kWrongType},
      {Type::kPixel, M(1), Code::kWrongType},
      {Type::kBoolean, N(1), Code::kWrongType},
      {Type::kString, M(1), Code::kWrongType},
      {Type::kWord, N(1), Code::kWrongType},
      {Type::kLabel, B(true), Code::kWrongType},
      {Type::kColor, N(256), Code::kOutOfRange},
      {Type::kColor, N(-1), Code::kOutOfRange},
      {Type::kColor, N(0.5), Code::kWrongType},
      {Type::kColor, S("red"), Code::kWrongType},
      {Type::kColor, S("#12345g"), Code::kWrongType},
      {Type::kPoint, N(1), Code::kWrongType},
      {Type::kPoint, L({N(1)}), Code::kWrongCount},
      {Type::kPoint, L({N(1), Deg(1)}), Code::kWrongType},
      {Type::kPoint, L({N(1), S("2")}), Code::kWrongType},
      {Type::kPoints, P(1, 2, 3), Code::kWrongType},
      {Type::kElement, L({element}), Code::kWrongType},
      {Type::kElements, L({element, N(1)}), Code::kWrongType},
      {Type::kRange, N(1), Code::kWrongType},
      {Type::kPlane, P(1, 2, 3), Code::kWrongType},
      {Type::kScale, N(0), Code::kOutOfRange},
      {Type::kScale, L({N(1), N(2)}), Code::kWrongCount},
      {Type::kScale, M(1), Code::kWrongType},
      {Type::kSize, L({N(0), N(1)}), Code::kOutOfRange},
      {Type::kSize, L({N(1), N(16385)}), Code::kOutOfRange},
      {Type::kSize, N(1), Code::kWrongType},
      {Type::kLength, Value(), Code::kWrongType},
  };
  for (const Row& row : rows) {
    SCOPED_TRACE(Describe(row.type));
    EXPECT_EQ(FailureOf([&] { Convert(row.value, row.type, kMetre, "x"); }).code, row.code)
        << Describe(row.value);
  }
}

TEST(Convert, SaysItAsTheManualDoes) {
  const OpFailure failure = FailureOf([] { Convert(Deg(30), Type::kLength, kMetre, "rise"); });
  EXPECT_EQ(failure.message, "`rise` is a length, but 30deg is an angle");
  EXPECT_EQ(failure.label, "expected a length such as 4.5m");
  EXPECT_EQ(FailureOf([] { Convert(N(1.5), Type::kCount, kMetre, "n"); }).message,
            "`n` is a count, but 1.5 is not a whole number");
  EXPECT_EQ(FailureOf([] { Convert(L({}), Type::kLength, kMetre, ""); }).message,
            "a length is needed, but it is given a list of 0");
}

TEST(Convert, KeepsDeviations) {
  Bench bench{.unit = kCentimetre};
  const Value x = bench.PlusMinus(N(100), N(2));
  const Value read = Convert(x, Type::kLength, kCentimetre, "x");
  EXPECT_DOUBLE_EQ(read.number(), 1);
  EXPECT_DOUBLE_EQ(bench.SigmaOf(read), 0.02);
  const Value point = Convert(L({x, N(1)}), Type::kPoint, kCentimetre, "p");
  EXPECT_DOUBLE_EQ(bench.SigmaOf(point.list()[0]), 0.02);
  EXPECT_TRUE(Convert(bench.PlusMinus(N(4), N(1)), Type::kCount, kMetre, "n").fast_number());
}

TEST(Convert, DoesNotRunAwayOnListsThatShareParts) {
  Value list = L({Value::OfElement(LineElement())});
  for (int i = 0; i < 60; ++i) list = L({list, list});
  EXPECT_EQ(FailureOf([&] { Convert(list, Type::kElements, kMetre, "of"); }).code,
            Code::kStepLimit);
}

TEST(PointOf, TakesAMissingHeightAsZero) {
  EXPECT_EQ(PointOf(L({M(1), M(2)})), geom::Vec3(1, 2, 0));
  EXPECT_EQ(PointOf(P(1, 2, 3)), geom::Vec3(1, 2, 3));
}

}  // namespace
}  // namespace tranos::interp
