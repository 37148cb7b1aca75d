// SPDX-License-Identifier: GPL-3.0-or-later
#include <rapidcheck.h>

#include <cstring>

#include "values.h"

namespace tranos::interp {
namespace {

TEST(Format, ReadsWell) {
  struct Row {
    Value value;
    std::string expected;
    int decimals = -1;
    Unit unit = kMetre;
  };
  const Row rows[] = {
      {M(35.5), "35.5 m"},
      {M(35.5), "3550 cm", -1, kCentimetre},
      {M2(12.5), "12.5 m2"},
      {M2(12.5), "125000 cm2", -1, kCentimetre},
      {M3(1), "1 m3"},
      {Value::Number(2, {model::Dimension::kLength, 4}), "2 m^4"},
      {Value::Number(2, {model::Dimension::kLength, -1}), "2 m^-1"},
      {Deg(30), "30 deg"},
      {Deg(30), "30.00 deg", 2},
      {Px(24), "24 px"},
      {N(0.1 + 0.2), "0.3"},
      {N(1.0 / 3), "0.333333333333"},
      {N(-0.0), "0"},
      {N(-0.001), "0.00", 2},
      {N(2.5), "2.50", 2},
      {M(2), "2.00 m", 2},
      {P(1, 2, 3), "(1 m, 2 m, 3 m)"},
      {L({N(1)}), "[1]"},
      {L({S("a"), B(true)}), "[\"a\", true]"},
      {S("a \"b\""), "a \"b\""},
      {B(false), "false"},
      {R(1, 2, model::kLength), "1 m..2 m"},
      {Value(), "nothing"},
  };
  for (const Row& row : rows) EXPECT_EQ(Format(row.value, row.unit, row.decimals), row.expected);
}

TEST(Format, ShowsDeviationsWithTheirSources) {
  Bench bench;
  const Value x = bench.PlusMinus(M(35.5), N(0.02), true);
  EXPECT_EQ(Format(x, kMetre, -1, &bench.sources), "35.5 m ± 0.71 m");
  EXPECT_EQ(Format(x, kMetre, 1, &bench.sources), "35.5 m ± 0.7 m");
  EXPECT_EQ(Format(x, kMetre, -1), "35.5 m");
}

TEST(Format, StaysBounded) {
  Value deep = N(1), wide = S(std::string(1000, 'x'));
  for (int i = 0; i < 100'000; ++i) deep = L({deep});
  EXPECT_LT(Format(deep, kMetre, -1).size(), 1000u);
  EXPECT_EQ(FailureOf([&] { KeyInText(deep); }).code, Code::kDepthLimit);
  for (int i = 0; i < 60; ++i) wide = L({wide, wide});
  EXPECT_EQ(FailureOf([&] { Format(wide, kMetre, -1); }).code, Code::kMemoryLimit);
  EXPECT_EQ(FailureOf([&] { KeyInText(wide); }).code, Code::kMemoryLimit);
  EXPECT_EQ(Format(N(1e308), kMetre, 255).size(), 309u + 1 + 255);
}

TEST(KeyInText, IsWhatOneWouldType) {
  EXPECT_EQ(KeyInText(M(3.5)), "3.5m");
  EXPECT_EQ(KeyInText(P(1, 2, 3)), "[1m,2m,3m]");
  EXPECT_EQ(KeyInText(Value::Number(0.5, model::kAngle)), "0.5rad");
  EXPECT_EQ(KeyInText(M2(12.5)), "12.5m2");
  EXPECT_EQ(KeyInText(Value::Number(5, {model::Dimension::kLength, 4})), "5*1m^4");
  EXPECT_EQ(KeyInText(R(1, 2, model::kLength)), "1m..2m");
  EXPECT_EQ(KeyInText(S("a{b}\"\\\n")), "\"a{{b}}\\\"\\\\\\n\"");
  EXPECT_EQ(KeyInText(B(true)), "true");
}

TEST(KeyInText, KeepsEveryBit) {
  rc::check("digits read back", [](std::uint64_t bits) {
    double number;
    std::memcpy(&number, &bits, sizeof number);
    RC_PRE(std::isfinite(number));
    const std::string text = KeyInText(M(number));
    RC_ASSERT(text.back() == 'm');
    RC_ASSERT(std::strtod(text.c_str(), nullptr) == number);
  });
}

TEST(Describe, NamesWithItsArticle) {
  EXPECT_EQ(Describe(M(1)), "a length");
  EXPECT_EQ(Describe(L({N(1), N(2), N(3)})), "a list of 3");
  const auto arc = model::MakeElement(model::kNoElement,
                                      std::make_shared<const geom::Curve>(geom::Arc{{}, 1, 1}),
                                      std::make_shared<const model::Attributes>(), nullptr, {});
  EXPECT_EQ(Describe(Value::OfElement(arc)), "an arc");
  EXPECT_EQ(Describe(F([](auto) { return N(1); })), "a function");
}

}  // namespace
}  // namespace tranos::interp
