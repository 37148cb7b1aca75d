// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of numbers.
#include <algorithm>
#include <array>
#include <cmath>

#include "interp/value_support.h"

namespace tranos::interp {

using model::Dimension;
using model::Value;

namespace {

constexpr double kDegree = geom::kPi / 180;

// Whether the angle is k steps, up to rounding.
bool IsMultiple(double angle_rad, double step_rad, long* k) {
  const double ratio = angle_rad / step_rad;
  const double whole = std::round(ratio);
  if (std::abs(whole) > 1e9) return false;
  if (std::abs(ratio - whole) > 4e-16 * std::max(1.0, std::abs(whole))) return false;
  *k = static_cast<long>(whole);
  return true;
}

// Sines at multiples of 30° are 0, ±1/2 and ±1 where they are rational.
double Sine(double angle_rad) {
  long k = 0;
  if (!IsMultiple(angle_rad, 30 * kDegree, &k)) return std::sin(angle_rad);
  constexpr std::array kHalves = {0, 1, -3, 2, -3, 1, 0, -1, 3, -2, 3, -1};  // ±3: irrational
  const int half = kHalves[static_cast<std::size_t>(((k % 12) + 12) % 12)];
  if (std::abs(half) == 3) return std::copysign(std::sqrt(0.75), -half);
  return half / 2.0;
}

double Cosine(double angle_rad) {
  long k = 0;
  if (IsMultiple(angle_rad, 30 * kDegree, &k)) {
    return Sine(static_cast<double>(k % 12 + 3) * (30 * kDegree));
  }
  return std::cos(angle_rad);
}

double Tangent(double angle_rad) {
  long k = 0;
  if (!IsMultiple(angle_rad, 45 * kDegree, &k)) return std::tan(angle_rad);
  constexpr std::array kTangents = {0.0, 1.0, HUGE_VAL, -1.0};
  return kTangents[static_cast<std::size_t>(((k % 4) + 4) % 4)];
}

Value Abs(const CallContext&, Arguments a) {
  const Value& x = NumberArgument(a, 0);
  return Chain(x, std::abs(x.number()), x.number() < 0 ? -1 : 1, x.dimension());
}

Value Sign(const CallContext&, Arguments a) {
  const double x = NumberArgument(a, 0).number();
  return Value::Number(x > 0 ? 1 : x < 0 ? -1 : 0);
}

// 1.15m counted in metres may lie an ulp beside the number that was written.
double CountOf(double number, double step) {
  const double count = number / step;
  const double whole = std::round(count);
  return whole * step == number ? whole : count;
}

template <double (*kRound)(double)>
Value RoundedTo(const CallContext& context, Arguments a) {
  const Value& x = NumberArgument(a, 0);
  const double step = StepOf(x.dimension(), *context.arithmetic.unit);
  const double whole = kRound(CountOf(x.number(), step));
  return Combine(whole * step, x.dimension(), {});
}

double Floor(double x) { return std::floor(x); }
double Ceil(double x) { return std::ceil(x); }
double Trunc(double x) { return std::trunc(x); }

Value Round(const CallContext& context, Arguments a) {
  const Value& x = NumberArgument(a, 0);
  const double digits = a.size() > 1 ? PlainArgument(a, 1).number() : 0;
  if (digits != std::floor(digits) || std::abs(digits) > 300) {
    throw OpFailure{Code::kOutOfRange, "a number of digits is whole, from -300 to 300", "", "", 1};
  }
  const double step = StepOf(x.dimension(), *context.arithmetic.unit);
  const double power = std::pow(10, std::abs(digits));
  const double count = CountOf(x.number(), step);
  const double scaled = digits < 0 ? count / power : count * power;
  if (!std::isfinite(scaled)) return ValueOf(x);  // it has no digits so small
  const double whole = std::round(scaled);
  return Combine((digits < 0 ? whole * power : whole / power) * step, x.dimension(), {});
}

Value Sqrt(const CallContext&, Arguments a) {
  const Value& x = NumberArgument(a, 0);
  if (x.number() < 0) {
    throw OpFailure{Code::kNotFinite, "a negative number has no root", Shown(x), "", 0};
  }
  Dimension dimension = x.dimension();
  if (dimension.exponent % 2 != 0) {
    throw OpFailure{Code::kDimensionMismatch, "the root of " + Describe(x) + " has no dimension",
                    "", "", 0};
  }
  dimension.exponent = static_cast<std::int8_t>(dimension.exponent / 2);
  const double root = std::sqrt(x.number());
  return Chain(x, root, 0.5 / root, dimension);
}

Value Exp(const CallContext&, Arguments a) {
  const Value x = PlainArgument(a, 0);
  const double power = std::exp(x.number());
  return Chain(x, power, power, model::kPlain);
}

Value Logarithm(Arguments a, double (*log)(double), double scale) {
  const Value x = PlainArgument(a, 0);
  if (x.number() <= 0) {
    throw OpFailure{Code::kNotFinite, "only a positive number has a logarithm", Shown(x), "", 0};
  }
  return Chain(x, log(x.number()), scale / x.number(), model::kPlain);
}
Value Log(const CallContext&, Arguments a) { return Logarithm(a, std::log, 1); }
Value Log10(const CallContext&, Arguments a) {
  return Logarithm(a, std::log10, 0.43429448190325182765);
}

Value Sin(const CallContext& context, Arguments a) {
  const Value x = AngleArgument(context, a, 0);
  return Chain(x, Sine(x.number()), Cosine(x.number()), model::kPlain);
}
Value Cos(const CallContext& context, Arguments a) {
  const Value x = AngleArgument(context, a, 0);
  return Chain(x, Cosine(x.number()), -Sine(x.number()), model::kPlain);
}
Value Tan(const CallContext& context, Arguments a) {
  const Value x = AngleArgument(context, a, 0);
  const double tangent = Tangent(x.number());
  if (!std::isfinite(tangent)) {
    throw OpFailure{Code::kNotFinite, "a right angle has no tangent", Shown(x), "", 0};
  }
  return Chain(x, tangent, 1 + tangent * tangent, model::kPlain);
}

// A ratio of two sides that are one length comes out beyond 1 by a rounding error as often as not.
double UnitInterval(const Value& x, const char* of) {
  constexpr double kRounding = 1e-14;
  if (std::abs(x.number()) <= 1 + kRounding) return std::clamp(x.number(), -1.0, 1.0);
  throw OpFailure{Code::kNotFinite,
                  std::string("a ") + of + " lies from -1 to 1, but this is " + Shown(x), "", "",
                  0};
}

// In degrees where that is a whole number, so that asin(0.5) is 30deg to the bit.
double ArcSine(double x) {
  if (std::abs(x) == 0.5) return std::copysign(30 * kDegree, x);
  if (std::abs(x) == 1) return std::copysign(90 * kDegree, x);
  return std::asin(x);
}
double ArcCosine(double x) {
  if (std::abs(x) == 0.5) return (x > 0 ? 60 : 120) * kDegree;
  if (x == 0) return 90 * kDegree;
  return x == -1 ? 180 * kDegree : std::acos(x);
}

Value Asin(const CallContext&, Arguments a) {
  const Value x = PlainArgument(a, 0);
  const double sine = UnitInterval(x, "sine");
  return Chain(x, ArcSine(sine), 1 / std::sqrt((1 - sine) * (1 + sine)), model::kAngle);
}
Value Acos(const CallContext&, Arguments a) {
  const Value x = PlainArgument(a, 0);
  const double cosine = UnitInterval(x, "cosine");
  return Chain(x, ArcCosine(cosine), -1 / std::sqrt((1 - cosine) * (1 + cosine)), model::kAngle);
}
Value Atan(const CallContext&, Arguments a) {
  const Value x = PlainArgument(a, 0);
  return Chain(x, ArcTangent(x.number(), 1), 1 / (1 + x.number() * x.number()), model::kAngle);
}

Value Atan2(const CallContext& context, Arguments a) {
  std::vector<Value> yx = {NumberArgument(a, 0), NumberArgument(a, 1)};
  AlignAll(yx, *context.arithmetic.unit, "sides of one angle");
  const double y = yx[0].number(), x = yx[1].number();
  if (y == 0 && x == 0) throw OpFailure{Code::kNotFinite, "atan2(0, 0) is no direction"};
  const double r = std::hypot(x, y);
  return Combine(ArcTangent(y, x), model::kAngle, {{&yx[0], x / r / r}, {&yx[1], -y / r / r}});
}

Value Rad(const CallContext& context, Arguments a) {
  const Value x = AngleArgument(context, a, 0);
  return Chain(x, x.number(), 1, model::kPlain);
}

Value Deg(const CallContext& context, Arguments a) {
  const Value x = AngleArgument(context, a, 0);
  // Hundredths of a degree come back as they were written.
  const double degrees = x.number() / kDegree;
  const double hundredths = std::round(degrees * 100) / 100;
  return Chain(x, hundredths * kDegree == x.number() ? hundredths : degrees, 1 / kDegree,
               model::kPlain);
}

// The arguments, or the items of the one list; all numbers of one dimension, at least one.
std::vector<Value> Numbers(const CallContext& context, Arguments a, std::string_view doing) {
  std::vector<Value> numbers(a.begin(), a.end());
  if (a.size() == 1 && !a[0].is_number()) numbers = ItemsArgument(context, a, 0);
  if (numbers.empty()) {
    throw OpFailure{Code::kWrongCount, "at least one number is needed, but the list is empty", "",
                    "", 0};
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i].is_number()) continue;
    throw OpFailure{Code::kWrongType, "numbers are needed, but " + WhatIs(numbers[i]),
                    "expected numbers", "", a.size() == 1 ? 0 : static_cast<int>(i)};
  }
  AlignAll(numbers, *context.arithmetic.unit, doing);
  std::uint64_t steps = 0;
  for (const Value& number : numbers) steps += DeviationSteps(number);
  context.charge_items(steps);
  return numbers;
}

bool IsLess(const Value& a, const Value& b) { return a.number() < b.number(); }

Value Min(const CallContext& context, Arguments a) {
  const std::vector<Value> numbers = Numbers(context, a, "compared");
  return *std::min_element(numbers.begin(), numbers.end(), IsLess);
}
Value Max(const CallContext& context, Arguments a) {
  const std::vector<Value> numbers = Numbers(context, a, "compared");
  return *std::max_element(numbers.begin(), numbers.end(), IsLess);
}

Value SumOfPoints(const CallContext& context, const std::vector<Value>& items) {
  Value sum = items[0];
  for (std::size_t i = 1; i < items.size(); ++i) {
    context.charge_items(DeviationSteps(sum));
    sum = Binary(Op::kAdd, sum, items[i], context.arithmetic);
  }
  return sum;
}

Value Sum(const CallContext& context, Arguments a) {
  if (a.size() == 1 && a[0].is_list()) {
    const std::vector<Value>& items = a[0].list();
    if (items.empty()) return Value::Number(0);
    if (std::all_of(items.begin(), items.end(), IsVector)) {
      context.charge_items(items.size());
      return SumOfPoints(context, items);
    }
  }
  const std::vector<Value> numbers = Numbers(context, a, "added");
  double sum = 0;
  std::vector<Term> terms;
  for (const Value& number : numbers) {
    sum += number.number();
    if (number.derivatives()) terms.push_back({&number, 1.0});
  }
  return Combine(sum, numbers[0].dimension(), terms);
}

Value Hypot(const CallContext& context, Arguments a) {
  return Norm(Numbers(context, a, "sides of one triangle"));
}

constexpr Builtin kMath[] = {
    {"abs(x)", "the number without its sign", 1, 1, Abs},
    {"sign(x)", "-1, 0 or 1", 1, 1, Sign},
    {"floor(x)", "the next whole number below; of a length, in the working unit", 1, 1,
     RoundedTo<Floor>},
    {"ceil(x)", "the next whole number above; of a length, in the working unit", 1, 1,
     RoundedTo<Ceil>},
    {"trunc(x)", "the whole number towards zero; of a length, in the working unit", 1, 1,
     RoundedTo<Trunc>},
    {"round(x, digits)", "the nearest whole number, halves away from zero, or that many decimals",
     1, 2, Round},
    {"sqrt(x)", "the square root; of an area, a length", 1, 1, Sqrt},
    {"exp(x)", "e to the power x", 1, 1, Exp},
    {"log(x)", "the natural logarithm", 1, 1, Log},
    {"log10(x)", "the decimal logarithm", 1, 1, Log10},
    {"sin(a)", "the sine of an angle; a bare number is degrees", 1, 1, Sin},
    {"cos(a)", "the cosine of an angle; a bare number is degrees", 1, 1, Cos},
    {"tan(a)", "the tangent of an angle; a bare number is degrees", 1, 1, Tan},
    {"asin(x)", "the angle from -90deg to 90deg with this sine", 1, 1, Asin},
    {"acos(x)", "the angle from 0 to 180deg with this cosine", 1, 1, Acos},
    {"atan(x)", "the angle from -90deg to 90deg with this tangent", 1, 1, Atan},
    {"atan2(y, x)", "the angle of the direction x, y, from -180deg to 180deg", 2, 2, Atan2},
    {"rad(a)", "the plain number of an angle, in radians", 1, 1, Rad},
    {"deg(a)", "the number of degrees of an angle", 1, 1, Deg},
    {"min(a, b, …)", "the least of numbers, or of a list", 1, -1, Min},
    {"max(a, b, …)", "the greatest of numbers, or of a list", 1, -1, Max},
    {"sum(list)", "the sum of numbers, or of a list of numbers or points", 1, -1, Sum},
    {"hypot(a, b, …)", "the root of the sum of squares", 1, -1, Hypot},
};

}  // namespace

double ArcTangent(double y, double x) {
  if (x != 0 && std::abs(x) == std::abs(y)) {
    return std::copysign((x > 0 ? 45 : 135) * kDegree, y);
  }
  if (y == 0) return x < 0 ? 180 * kDegree : 0;  // half a turn is told as +180deg
  if (x == 0) return std::copysign(90 * kDegree, y);
  return std::atan2(y, x);
}

std::span<const Builtin> MathFunctions() { return kMath; }

}  // namespace tranos::interp
