// SPDX-License-Identifier: GPL-3.0-or-later
#include "values.h"

namespace tranos::interp {
namespace {

struct Row {
  Op op;
  Value left, right, expected;
  Unit unit = kMetre;
};

TEST(Binary, FollowsDimensions) {
  const Row rows[] = {
      {Op::kAdd, N(1), N(2), N(3)},
      {Op::kAdd, M(1), N(2), M(3)},
      {Op::kAdd, N(200), M(1), M(3), kCentimetre},
      {Op::kSubtract, M(5), N(2), M(3)},
      {Op::kAdd, Deg(90), N(90), Deg(180)},
      {Op::kMultiply, M(2), M(3), M2(6)},
      {Op::kMultiply, M2(2), M(3), M3(6)},
      {Op::kMultiply, N(2), M(3), M(6)},
      {Op::kMultiply, N(2), Deg(15), Deg(30)},
      {Op::kDivide, M(6), M(3), N(2)},
      {Op::kDivide, M3(6), M(3), M2(2)},
      {Op::kDivide, N(6), M(3), Value::Number(2, {model::Dimension::kLength, -1})},
      {Op::kDivide, Deg(180), Deg(90), N(2)},
      {Op::kDivide, M(6), N(3), M(2)},
      {Op::kPower, M(3), N(2), M2(9)},
      {Op::kPower, M2(9), N(0.5), M(3)},
      {Op::kPower, M3(8), N(0), N(1)},
      {Op::kPower, N(0), N(0), N(1)},
      {Op::kPower, N(2), N(-2), N(0.25)},
      {Op::kPower, N(-2), N(3), N(-8)},
      {Op::kModulo, N(5), N(3), N(2)},
      {Op::kModulo, N(-5), N(3), N(1)},
      {Op::kModulo, N(5), N(-3), N(-1)},
      {Op::kModulo, N(-5), N(-3), N(-2)},
      {Op::kModulo, M(5), N(3), M(2)},
      {Op::kAdd, P(1, 2, 3), P(1, 1, 1), P(2, 3, 4)},
      {Op::kAdd, P(1, 2, 3), L({N(1), N(1), N(1)}), P(2, 3, 4)},
      {Op::kMultiply, N(2), P(1, 2, 3), P(2, 4, 6)},
      {Op::kMultiply, P(1, 2, 3), N(2), P(2, 4, 6)},
      {Op::kDivide, P(2, 4, 6), M(2), L({N(1), N(2), N(3)})},
      {Op::kMultiply, L({N(1), N(2)}), L({N(3), N(4)}), L({N(3), N(8)})},
      {Op::kMakeRange, M(1), N(2), R(1, 2, model::kLength)},
      {Op::kMakeRange, N(3), N(1), R(3, 1)},
  };
  for (const Row& row : rows) {
    Bench bench{.unit = row.unit};
    ExpectSame(bench.Op2(row.op, row.left, row.right), row.expected);
  }
}

TEST(Binary, RefusesWhatHasNoMeaning) {
  struct Bad {
    Op op;
    Value left, right;
    Code code;
  };
  const Bad rows[] = {
      {Op::kAdd, M(1), Deg(1), Code::kDimensionMismatch},
      {Op::kAdd, M2(1), N(1), Code::kDimensionMismatch},
      {Op::kAdd, Px(1), N(1), Code::kDimensionMismatch},
      {Op::kMultiply, M(1), Deg(1), Code::kDimensionMismatch},
      {Op::kMultiply, M(1), Px(1), Code::kDimensionMismatch},
      {Op::kMultiply, Deg(1), Deg(1), Code::kDimensionMismatch},
      {Op::kDivide, N(1), Deg(1), Code::kDimensionMismatch},
      {Op::kPower, M(1), N(0.5), Code::kDimensionMismatch},
      {Op::kPower, M(2), M(1), Code::kDimensionMismatch},
      {Op::kPower, M(2), N(1000), Code::kDimensionMismatch},
      {Op::kPower, Deg(2), N(2), Code::kDimensionMismatch},
      {Op::kDivide, N(1), N(0), Code::kNotFinite},
      {Op::kModulo, N(1), N(0), Code::kNotFinite},
      {Op::kPower, N(0), N(-1), Code::kNotFinite},
      {Op::kPower, N(-1), N(0.5), Code::kNotFinite},
      {Op::kMultiply, N(1e200), N(1e200), Code::kNotFinite},
      {Op::kAdd, S("a"), S("b"), Code::kWrongType},
      {Op::kAdd, P(1, 2, 3), M(1), Code::kWrongType},
      {Op::kDivide, M(1), P(1, 2, 3), Code::kWrongType},
      {Op::kAdd, P(1, 2, 3), L({M(1), M(2)}), Code::kWrongCount},
      {Op::kMultiply, L({N(1)}), N(2), Code::kWrongType},
      {Op::kMakeRange, M(1), Deg(2), Code::kDimensionMismatch},
      {Op::kMakeRange, S("a"), N(2), Code::kWrongType},
  };
  for (const Bad& row : rows) {
    Bench bench;
    EXPECT_EQ(FailureOf([&] { bench.Op2(row.op, row.left, row.right); }).code, row.code)
        << Describe(row.left) << ", " << Describe(row.right);
  }
}

TEST(Binary, SaysWhatWasTriedAndOffersAWay) {
  Bench bench;
  EXPECT_EQ(FailureOf([&] { bench.Op2(Op::kAdd, M(1), Deg(1)); }).message,
            "a length and an angle cannot be added");
  const OpFailure product = FailureOf([&] { bench.Op2(Op::kMultiply, M(1), Deg(1)); });
  EXPECT_NE(product.help.find("rad(a)"), std::string::npos) << product.help;
  EXPECT_EQ(FailureOf([&] { bench.Op2(Op::kDivide, N(1), N(0)); }).operand, 1);
  EXPECT_EQ(FailureOf([&] { bench.Op2(Op::kMultiply, S("a"), N(1)); }).operand, 0);
  EXPECT_EQ(FailureOf([&] { bench.Op2(Op::kMultiply, N(1), S("a")); }).operand, 1);
}

TEST(Compare, AgreesOrRefuses) {
  struct Truth {
    Op op;
    Value left, right;
    bool expected;
  };
  const Truth rows[] = {
      {Op::kEqual, M(2), N(2), true},
      {Op::kEqual, Deg(90), N(90), true},
      {Op::kNotEqual, N(2), N(3), true},
      {Op::kEqual, S("a"), S("a"), true},
      {Op::kEqual, B(true), B(false), false},
      {Op::kEqual, P(1, 2, 3), L({N(1), N(2), N(3)}), true},
      {Op::kEqual, P(1, 2, 3), L({N(1), N(2)}), false},
      {Op::kEqual, L({S("a"), L({N(1)})}), L({S("a"), L({N(1)})}), true},
      {Op::kEqual, R(1, 2, model::kLength), R(1, 2), true},
      {Op::kEqual, Value(), N(1), false},
      {Op::kEqual, Value(), Value(), true},
      {Op::kLess, M(1), N(2), true},
      {Op::kLessEqual, N(2), N(2), true},
      {Op::kGreater, M(1), N(2), false},
      {Op::kGreaterEqual, N(2), N(2), true},
      {Op::kLess, S("a"), S("b"), true},
      {Op::kWithin, M(2), R(2, 8, model::kLength), true},
      {Op::kWithin, M(8), R(2, 8), true},
      {Op::kWithin, N(9), R(2, 8, model::kLength), false},
      {Op::kWithin, N(5), R(8, 2), false},
  };
  for (const Truth& row : rows) {
    Bench bench;
    EXPECT_EQ(bench.Op2(row.op, row.left, row.right).boolean(), row.expected)
        << Describe(row.left) << ", " << Describe(row.right);
  }
  Bench bench;
  const auto code = [&](Op op, const Value& a, const Value& b) {
    return FailureOf([&] { bench.Op2(op, a, b); }).code;
  };
  EXPECT_EQ(code(Op::kEqual, M(1), Deg(1)), Code::kDimensionMismatch);
  EXPECT_EQ(code(Op::kEqual, M(1), S("a")), Code::kWrongType);
  EXPECT_EQ(code(Op::kLess, M2(1), N(1)), Code::kDimensionMismatch);
  EXPECT_EQ(code(Op::kLess, B(true), B(false)), Code::kWrongType);
  EXPECT_EQ(code(Op::kWithin, M(1), M(1)), Code::kWrongType);
  EXPECT_EQ(code(Op::kWithin, P(1, 2, 3), R(1, 2)), Code::kWrongType);
  EXPECT_EQ(code(Op::kConsistent, S("a"), N(1)), Code::kWrongType);
}

TEST(Compare, DoesNotRunAwayOnListsThatShareParts) {
  Value a = N(1), b = N(1);
  for (int i = 0; i < 60; ++i) {
    a = L({a, a});
    b = L({b, b});
  }
  Bench bench;
  EXPECT_TRUE(bench.Op2(Op::kEqual, a, a).boolean());  // the same lists: nothing to compare
  EXPECT_EQ(FailureOf([&] { bench.Op2(Op::kEqual, a, b); }).code, Code::kStepLimit);
}

TEST(Deviation, IsMadeAndTakenApart) {
  Bench bench;
  const Value x = bench.PlusMinus(M(35.5), N(0.02), true);
  EXPECT_DOUBLE_EQ(bench.SigmaOf(x), 0.71);
  ExpectSame(bench.Get(x, "value"), M(35.5));
  ExpectSame(bench.Get(x, "sigma"), M(0.02 * 35.5));
  ExpectSame(bench.Get(M(3), "sigma"), M(0));
  bench.unit = kCentimetre;
  EXPECT_DOUBLE_EQ(bench.SigmaOf(bench.PlusMinus(M(10), N(5))), 0.05);  // bare: in the working unit
  EXPECT_DOUBLE_EQ(bench.SigmaOf(bench.PlusMinus(Deg(30), N(1))), geom::kPi / 180);
  EXPECT_EQ(bench.sources.size(), 3u);
  EXPECT_EQ(FailureOf([&] { bench.PlusMinus(M(1), Deg(1)); }).code, Code::kDimensionMismatch);
  EXPECT_EQ(FailureOf([&] { bench.PlusMinus(M(1), M(-1)); }).code, Code::kOutOfRange);
  EXPECT_EQ(FailureOf([&] { bench.PlusMinus(S("a"), M(1)); }).code, Code::kWrongType);
  EXPECT_EQ(FailureOf([&] { bench.PlusMinus(M(1), M(1), true); }).code, Code::kDimensionMismatch);
  EXPECT_EQ(bench.sources.size(), 3u);
}

TEST(Deviation, OneSourceVariesWithItself) {
  Bench bench;
  const Value x = bench.PlusMinus(M(10), M(0.1)), y = bench.PlusMinus(M(10), M(0.1));
  EXPECT_DOUBLE_EQ(bench.SigmaOf(bench.Op2(Op::kAdd, x, x)), 0.2);
  EXPECT_DOUBLE_EQ(bench.SigmaOf(bench.Op2(Op::kAdd, x, y)), std::hypot(0.1, 0.1));
  const Value nothing = bench.Op2(Op::kSubtract, x, x);
  EXPECT_TRUE(nothing.fast_number());  // it depends on nothing any more
  ExpectSame(bench.Op2(Op::kDivide, x, x), N(1));
  EXPECT_TRUE(bench.Op2(Op::kMultiply, M(2), M(3)).fast_number());
  EXPECT_DOUBLE_EQ(bench.SigmaOf(Negate(x)), 0.1);
}

TEST(Deviation, WithinIsAHardBoundAndConsistentIsNot) {
  Bench bench;
  const Value a = bench.PlusMinus(M(35.5), N(0.02), true);
  EXPECT_TRUE(bench.Op2(Op::kWithin, M(36.2), a).boolean());
  EXPECT_FALSE(bench.Op2(Op::kWithin, M(36.3), a).boolean());
  EXPECT_TRUE(bench.Op2(Op::kWithin, N(35.5), a).boolean());
  const Value x = bench.PlusMinus(M(10), M(0.3)), y = bench.PlusMinus(M(11.4), M(0.4));
  EXPECT_TRUE(bench.Op2(Op::kConsistent, x, y).boolean());  // 1.4 ≤ 3·0.5
  EXPECT_FALSE(bench.Op2(Op::kConsistent, x, bench.PlusMinus(M(11.6), M(0.4))).boolean());
  // The same source on both sides: the difference is exact.
  EXPECT_FALSE(bench.Op2(Op::kConsistent, x, bench.Op2(Op::kAdd, x, M(0.01))).boolean());
  EXPECT_TRUE(bench.Op2(Op::kConsistent, M(1), N(1)).boolean());
}

TEST(Deviation, NeverBecomesInfinite) {
  Bench bench;
  const Value zero = bench.PlusMinus(N(0), N(0.1));
  EXPECT_EQ(FailureOf([&] { bench.Call("sqrt", {zero}); }).code, Code::kNotFinite);
  EXPECT_EQ(FailureOf([&] { bench.Call("asin", {bench.PlusMinus(N(1), N(0.1))}); }).code,
            Code::kNotFinite);
  ExpectSame(bench.Call("sqrt", {N(0)}), N(0));
  ExpectSame(bench.Call("asin", {N(1)}), Deg(90));
}

TEST(Align, ReadsBareNumbersBesideLengthsAndAngles) {
  const auto aligned = [](Value a, Value b) { return Align(&a, &b, kCentimetre); };
  EXPECT_TRUE(aligned(N(1), M(1)));
  EXPECT_TRUE(aligned(Deg(1), N(1)));
  EXPECT_TRUE(aligned(M2(1), M2(1)));
  EXPECT_FALSE(aligned(N(1), M2(1)));
  EXPECT_FALSE(aligned(M(1), Deg(1)));
  Bench bench;
  const Value bare = bench.PlusMinus(N(10), N(2));
  const Value read = ReadBare(bare, model::kLength, kCentimetre);
  EXPECT_DOUBLE_EQ(read.number(), 0.1);
  EXPECT_DOUBLE_EQ(bench.SigmaOf(read), 0.02);
  ExpectSame(ReadBare(M(1), model::kAngle, kMetre), M(1));
}

}  // namespace
}  // namespace tranos::interp
