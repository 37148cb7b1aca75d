// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of numbers, vectors and lists: each with what it gives and what it refuses.
#include <set>

#include "values.h"

namespace tranos::interp {
namespace {

struct Row {
  std::string_view name;
  std::vector<Value> arguments;
  Value expected;
  Unit unit = kMetre;
};

// Equal to the bit.
TEST(Functions, GiveExactlyThis) {
  const Row rows[] = {
      {"abs", {M(-2)}, M(2)},
      {"sign", {M(-2)}, N(-1)},
      {"sign", {N(0)}, N(0)},
      {"floor", {N(-1.5)}, N(-2)},
      {"floor", {M(1.239)}, M(1.23), kCentimetre},
      {"ceil", {N(1.2)}, N(2)},
      {"ceil", {Deg(29.5)}, Deg(30)},
      {"trunc", {N(-1.7)}, N(-1)},
      {"round", {N(2.5)}, N(3)},
      {"round", {N(3.14159), N(2)}, N(3.14)},
      {"round", {N(1234), N(-2)}, N(1200)},
      {"round", {N(1e300), N(300)}, N(1e300)},
      {"sqrt", {N(9)}, N(3)},
      {"sqrt", {M2(9)}, M(3)},
      {"exp", {N(0)}, N(1)},
      {"log", {N(1)}, N(0)},
      {"log10", {N(1000)}, N(3)},
      {"sin", {N(0)}, N(0)},
      {"sin", {N(30)}, N(0.5)},
      {"sin", {Deg(90)}, N(1)},
      {"sin", {Deg(150)}, N(0.5)},
      {"sin", {Deg(180)}, N(0)},
      {"sin", {Deg(-30)}, N(-0.5)},
      {"sin", {Deg(270)}, N(-1)},
      {"sin", {Deg(360030)}, N(0.5)},
      {"cos", {Deg(60)}, N(0.5)},
      {"cos", {Deg(90)}, N(0)},
      {"cos", {Deg(120)}, N(-0.5)},
      {"cos", {Deg(180)}, N(-1)},
      {"cos", {Deg(-60)}, N(0.5)},
      {"tan", {Deg(45)}, N(1)},
      {"tan", {Deg(135)}, N(-1)},
      {"tan", {Deg(180)}, N(0)},
      {"asin", {N(0.5)}, Deg(30)},
      {"asin", {N(-1)}, Deg(-90)},
      {"acos", {N(0.5)}, Deg(60)},
      {"acos", {N(-0.5)}, Deg(120)},
      {"acos", {N(0)}, Deg(90)},
      {"atan", {N(1)}, Deg(45)},
      {"atan2", {M(1), N(-1)}, Deg(135)},
      {"atan2", {N(-1), N(0)}, Deg(-90)},
      {"atan2", {N(0), N(-2)}, Deg(180)},
      {"rad", {Deg(90)}, N(90 * (geom::kPi / 180))},
      {"rad", {N(90)}, N(90 * (geom::kPi / 180))},
      {"deg", {Deg(30)}, N(30)},
      {"deg", {Deg(57.29)}, N(57.29)},
      {"min", {N(3), N(1), N(2)}, N(1)},
      {"min", {L({M(3), N(1)})}, M(1)},
      {"max", {M(3), N(400)}, M(4), kCentimetre},
      {"sum", {L({M(1), N(2), M(3)})}, M(6)},
      {"sum", {L({})}, N(0)},
      {"sum", {L({P(1, 2, 3), P(1, 1, 1)})}, P(2, 3, 4)},
      {"sum", {R(1, 100)}, N(5050)},
      {"hypot", {M(3), N(4)}, M(5)},
      {"dot", {P(1, 2, 3), L({N(1), N(0), N(0)})}, M(1)},
      {"dot", {P(1, 2, 3), P(4, 5, 6)}, M2(32)},
      {"cross", {L({N(1), N(0), N(0)}), L({N(0), N(1), N(0)})}, L({N(0), N(0), N(1)})},
      {"length", {P(3, 4, 0)}, M(5)},
      {"length", {P(std::ldexp(3, 600), std::ldexp(4, 600), 0)}, M(std::ldexp(5, 600))},
      {"normalize", {P(0, 0, 3)}, L({N(0), N(0), N(1)})},
      {"normalize", {L({M(0), M(2)})}, L({N(0), N(1)})},
      {"angle", {P(1, 0, 0), P(0, 1, 0)}, Deg(90)},
      {"angle", {P(1, 0, 0), P(2, 0, 0)}, Deg(0)},
      {"angle", {P(1, 0, 0), P(-2, 0, 0)}, Deg(180)},
      {"distance", {P(0, 0, 0), L({N(3), N(4)})}, M(5)},
      {"len", {L({N(1), N(2)})}, N(2)},
      {"len", {S("Ἅγιος")}, N(5)},
      {"len", {R(1, 7)}, N(7)},
      {"len", {R(7, 1)}, N(0)},
      {"range", {N(3)}, L({N(0), N(1), N(2)})},
      {"range", {N(0)}, L({})},
      {"range", {N(2), N(4)}, L({N(2), N(3), N(4)})},
      {"range", {N(4), N(2)}, L({})},
      {"range", {N(4), N(2), N(-1)}, L({N(4), N(3), N(2)})},
      {"range", {M(0), M(1), N(0.5)}, L({M(0), M(0.5), M(1)})},
      {"range", {R(1, 2)}, L({N(1), N(2)})},
      {"map", {L({N(1), N(2)}), F([](auto a) { return N(a[0].number() * 2); })}, L({N(2), N(4)})},
      {"map", {R(1, 2), F([](auto a) { return N(-a[0].number()); })}, L({N(-1), N(-2)})},
      {"filter", {L({N(1), N(2)}), F([](auto a) { return B(a[0].number() > 1); })}, L({N(2)})},
      {"sort", {L({M(3), N(1), M(2)})}, L({M(3), N(1), M(2)})},  // see SortsStably for the order
      {"reverse", {L({N(1), S("a")})}, L({S("a"), N(1)})},
      {"join", {L({S("a"), N(2), M(3)}), S(", ")}, S("a, 2, 3 m")},
      {"join", {L({}), S(", ")}, S("")},
      {"join", {L({S("a"), S("b")})}, S("ab")},
      {"join", {L({N(1)}), L({N(2)})}, L({N(1), N(2)})},
      {"join", {L({L({N(1)}), L({}), L({N(2)})})}, L({N(1), N(2)})},
  };
  std::set<std::string_view> tried;
  for (const Row& row : rows) {
    SCOPED_TRACE(row.name);
    tried.insert(row.name);
    if (row.name == "sort") continue;
    Bench bench{.unit = row.unit};
    ExpectSame(bench.Call(row.name, row.arguments), row.expected);
  }
  for (const Builtin& builtin : AllBuiltins()) {
    const bool geometric = builtin.name() == "area" || builtin.name() == "volume" ||
                           builtin.name() == "volume_under" || builtin.name() == "intersection" ||
                           builtin.name() == "project" || builtin.name() == "facade";
    EXPECT_NE(tried.contains(builtin.name()), geometric) << builtin.usage;
  }
}

TEST(Functions, RefuseTheRest) {
  struct Bad {
    std::string_view name;
    std::vector<Value> arguments;
    Code code;
  };
  const Bad rows[] = {
      {"abs", {S("a")}, Code::kWrongType},
      {"sign", {B(true)}, Code::kWrongType},
      {"floor", {S("a")}, Code::kWrongType},
      {"ceil", {L({})}, Code::kWrongType},
      {"trunc", {Value()}, Code::kWrongType},
      {"round", {N(1), N(0.5)}, Code::kOutOfRange},
      {"round", {N(1), M(1)}, Code::kDimensionMismatch},
      {"sqrt", {N(-1)}, Code::kNotFinite},
      {"sqrt", {M(4)}, Code::kDimensionMismatch},
      {"sqrt", {Deg(4)}, Code::kDimensionMismatch},
      {"exp", {N(1000)}, Code::kNotFinite},
      {"exp", {M(1)}, Code::kDimensionMismatch},
      {"log", {N(0)}, Code::kNotFinite},
      {"log10", {N(-1)}, Code::kNotFinite},
      {"sin", {M(1)}, Code::kDimensionMismatch},
      {"cos", {S("a")}, Code::kWrongType},
      {"tan", {Deg(90)}, Code::kNotFinite},
      {"tan", {Deg(-270)}, Code::kNotFinite},
      {"asin", {N(1.1)}, Code::kNotFinite},
      {"acos", {N(-1.1)}, Code::kNotFinite},
      {"atan", {Deg(1)}, Code::kDimensionMismatch},
      {"atan2", {N(0), N(0)}, Code::kNotFinite},
      {"atan2", {M(1), Deg(1)}, Code::kDimensionMismatch},
      {"rad", {M(1)}, Code::kDimensionMismatch},
      {"deg", {M(1)}, Code::kDimensionMismatch},
      {"min", {L({})}, Code::kWrongCount},
      {"max", {M(1), Deg(1)}, Code::kDimensionMismatch},
      {"sum", {L({N(1), S("a")})}, Code::kWrongType},
      {"sum", {L({M(1), M2(1)})}, Code::kDimensionMismatch},
      {"sum", {L({N(1e308), N(1e308)})}, Code::kNotFinite},
      {"hypot", {M(1), M2(1)}, Code::kDimensionMismatch},
      {"dot", {N(1), P(1, 2, 3)}, Code::kWrongType},
      {"cross", {P(1, 2, 3), L({N(1)})}, Code::kWrongType},
      {"length", {L({N(1)})}, Code::kWrongType},
      {"normalize", {P(0, 0, 0)}, Code::kNotFinite},
      {"angle", {P(0, 0, 0), P(1, 0, 0)}, Code::kNotFinite},
      {"distance", {P(0, 0, 0), N(1)}, Code::kWrongType},
      {"distance", {P(0, 0, 0), L({Deg(1), Deg(2)})}, Code::kWrongType},
      {"len", {N(1)}, Code::kWrongType},
      {"range", {N(1.5)}, Code::kWrongType},
      {"range", {N(-1)}, Code::kWrongType},
      {"range", {N(1), N(2), N(0)}, Code::kOutOfRange},
      {"range", {M(1), Deg(2)}, Code::kDimensionMismatch},
      {"map", {L({N(1)}), N(1)}, Code::kWrongType},
      {"map", {N(1), F([](auto) { return N(1); })}, Code::kWrongType},
      {"filter", {L({N(1)}), F([](auto) { return N(1); })}, Code::kNotBoolean},
      {"sort", {L({N(1), S("a")})}, Code::kWrongType},
      {"sort", {L({M(1), Deg(1)})}, Code::kDimensionMismatch},
      {"reverse", {N(1)}, Code::kWrongType},
      {"join", {N(1), S(",")}, Code::kWrongType},
      {"join", {L({N(1)}), N(1)}, Code::kWrongType},
  };
  for (const Bad& row : rows) {
    SCOPED_TRACE(row.name);
    Bench bench;
    EXPECT_EQ(FailureOf([&] { bench.Call(row.name, row.arguments); }).code, row.code);
  }
}

TEST(Functions, SortsStably) {
  Bench bench;
  ExpectSame(bench.Call("sort", {L({M(3), N(1), M(2)})}), L({N(1), M(2), M(3)}));
  ExpectSame(bench.Call("sort", {L({S("b"), S("a")})}), L({S("a"), S("b")}));
  const Value by_x = F([&](auto a) { return a[0].list()[0]; });
  const Value p = P(2, 9, 0), q = P(1, 1, 0), r = P(2, 1, 0);
  ExpectSame(bench.Call("sort", {L({p, q, r}), by_x}), L({q, p, r}));
}

TEST(Functions, RowsAreSoundAndNamedOnce) {
  std::set<std::string_view> names;
  for (const Builtin& row : AllBuiltins()) {
    EXPECT_TRUE(names.insert(row.name()).second) << row.name();
    EXPECT_TRUE(row.usage.ends_with(")")) << row.usage;
    EXPECT_FALSE(row.summary.empty()) << row.usage;
    EXPECT_TRUE(row.most < 0 || row.most >= row.least) << row.usage;
  }
  EXPECT_EQ(FindBuiltin("no_such_function"), -1);
  EXPECT_EQ(AllBuiltins()[static_cast<std::size_t>(FindBuiltin("sum"))].name(), "sum");
}

TEST(Functions, ChargeBeforeTheyAllocate) {
  Bench bench;
  EXPECT_EQ(FailureOf([&] { bench.Call("range", {N(1e12)}); }).code, Code::kStepLimit);
  EXPECT_EQ(FailureOf([&] {
              bench.Call("range", {N(0), N(1), N(1e-300)});
            }).code,
            Code::kStepLimit);
  EXPECT_EQ(FailureOf([&] { bench.Call("sum", {R(0, 1e300)}); }).code, Code::kStepLimit);
  Bench generous{.limit = ~std::uint64_t{0}};
  EXPECT_EQ(FailureOf([&] { generous.Call("range", {N(1e12)}); }).code, Code::kMemoryLimit);
  Value list = L({N(1)});
  EXPECT_EQ(FailureOf([&] {
              for (int i = 0; i < 60; ++i) list = bench.Call("join", {list, list});
            }).code,
            Code::kStepLimit);
  const Value text = S(std::string(1 << 20, 'x'));
  EXPECT_EQ(FailureOf([&] { generous.Call("join", {L(std::vector<Value>(100, text))}); }).code,
            Code::kMemoryLimit);
}

// A sum over many unknowns takes time in proportion to them.
TEST(Functions, SumsManyDeviations) {
  Bench bench;
  std::vector<Value> items;
  for (int i = 0; i < 100'000; ++i) items.push_back(bench.PlusMinus(M(1), M(0.1)));
  const Value sum = bench.Call("sum", {L(items)});
  EXPECT_DOUBLE_EQ(sum.number(), 100'000);
  EXPECT_NEAR(bench.SigmaOf(sum), 0.1 * std::sqrt(100'000), 1e-9);
}

TEST(Functions, SmallMultiplesOfThirtyDegreesAreNotConfusedWithNeighbours) {
  Bench bench;
  const double near = 30 * (geom::kPi / 180) * (1 + 1e-14);
  EXPECT_NE(bench.Call("sin", {Value::Number(near, model::kAngle)}).number(), 0.5);
  EXPECT_EQ(bench.Call("sin", {Value::Number(1e20, model::kAngle)}).number(), std::sin(1e20));
}

}  // namespace
}  // namespace tranos::interp
