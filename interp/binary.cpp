// SPDX-License-Identifier: GPL-3.0-or-later
// The binary operators on numbers and on points.
#include <cmath>
#include <limits>
#include <optional>

#include "interp/value_support.h"

namespace tranos::interp {

using model::Dimension;
using model::Value;

namespace {

[[noreturn]] void FailMismatch(const Value& left, const Value& right, const std::string& verb) {
  std::string help;
  const Value& other = left.dimension().plain() ? right : left;
  if (left.dimension().plain() || right.dimension().plain()) {
    if (other.dimension() == model::kArea) help = "give the number its unit: 5m2";
    if (other.dimension() == model::kVolume) help = "give the number its unit: 5m3";
    if (other.dimension().base == Dimension::kPixel) help = "give the number its unit: 5px";
  }
  throw OpFailure{Code::kDimensionMismatch,
                  Describe(left) + " and " + Describe(right) + " cannot be " + verb, "", help};
}

[[noreturn]] void FailOperand(const Value& value, int operand, const std::string& verb) {
  std::string help;
  if (value.is_string() && verb == "added") help = "texts are joined inside one: \"{a}{b}\"";
  throw OpFailure{Code::kWrongType, Describe(value) + " cannot be " + verb, "expected a number",
                  help, operand};
}

std::string VerbOf(Op op) {
  switch (op) {
    case Op::kAdd:
      return "added";
    case Op::kSubtract:
      return "subtracted";
    case Op::kMultiply:
      return "multiplied";
    case Op::kModulo:
      return "divided with a remainder";
    case Op::kPower:
      return "raised to a power";
    default:
      return "divided";
  }
}

Value AddScaled(Op op, Value left, Value right, const Unit& unit) {
  const double sign = op == Op::kAdd ? 1 : -1;
  if (!Align(&left, &right, unit)) FailMismatch(left, right, VerbOf(op));
  return Combine(left.number() + sign * right.number(), left.dimension(),
                 {{&left, 1.0}, {&right, sign}});
}

// The dimension of left · right^sign.
Dimension ProductDimension(const Value& left, const Value& right, int sign) {
  const Dimension a = left.dimension(), b = right.dimension();
  if (a.base != b.base && !a.plain() && !b.plain()) {
    const bool angle = a.base == Dimension::kAngle || b.base == Dimension::kAngle;
    throw OpFailure{
        Code::kDimensionMismatch,
        Describe(left) + " and " + Describe(right) + " cannot be " +
            (sign > 0 ? "multiplied" : "divided"),
        "", angle ? "rad(a) is the plain number of an angle: an arc's length is r*rad(a)" : ""};
  }
  const int exponent = a.exponent + sign * b.exponent;
  if (exponent == 0) return model::kPlain;
  const Dimension::Base base = a.plain() ? b.base : a.base;
  if (base == Dimension::kAngle && exponent != 1) {
    throw OpFailure{
        Code::kDimensionMismatch,
        sign > 0 ? "an angle has no powers" : "nothing is measured by an angle's reciprocal", "",
        "rad(a) is the plain number of an angle"};
  }
  if (exponent < std::numeric_limits<std::int8_t>::min() ||
      exponent > std::numeric_limits<std::int8_t>::max()) {
    throw OpFailure{Code::kDimensionMismatch, "the power of a dimension is out of all bounds"};
  }
  return {base, static_cast<std::int8_t>(exponent)};
}

Value Multiply(const Value& left, const Value& right) {
  const Dimension dimension = ProductDimension(left, right, 1);
  const double a = left.number(), b = right.number();
  return Combine(a * b, dimension, {{&left, b}, {&right, a}});
}

void CheckDivisor(const Value& right) {
  if (right.number() == 0)
    throw OpFailure{Code::kNotFinite, "division by zero", "this is 0", "", 1};
}

Value Divide(const Value& left, const Value& right) {
  const Dimension dimension = ProductDimension(left, right, -1);
  CheckDivisor(right);
  const double b = right.number(), quotient = left.number() / b;
  return Combine(quotient, dimension, {{&left, 1 / b}, {&right, -quotient / b}});
}

// The remainder has the divisor's sign, as a turn of an angle or a step of a pattern wants it.
Value Modulo(Value left, Value right, const Unit& unit) {
  if (!Align(&left, &right, unit)) FailMismatch(left, right, VerbOf(Op::kModulo));
  CheckDivisor(right);
  const double a = left.number(), b = right.number();
  double remainder = std::fmod(a, b);
  if (remainder != 0 && (remainder < 0) != (b < 0)) remainder += b;
  return Combine(remainder, left.dimension(), {{&left, 1.0}, {&right, -std::floor(a / b)}});
}

Dimension PowerDimension(const Value& base, const Value& exponent) {
  const Dimension dimension = base.dimension();
  if (dimension.plain()) return dimension;
  if (exponent.derivatives()) {
    throw OpFailure{Code::kDimensionMismatch,
                    "the exponent of " + Describe(base) + " cannot have a deviation", "", "", 1};
  }
  const double power = dimension.exponent * exponent.number();
  const double whole = std::round(power);
  if (std::abs(power - whole) > 1e-12 ||
      std::abs(whole) > std::numeric_limits<std::int8_t>::max()) {
    throw OpFailure{
        Code::kDimensionMismatch,
        Describe(base) + " to the power " + Digits(exponent.number()) + " has no dimension", "", "",
        1};
  }
  if (whole == 0) return model::kPlain;
  if (dimension.base == Dimension::kAngle && whole != 1) {
    throw OpFailure{Code::kDimensionMismatch, "an angle has no powers", "",
                    "rad(a) is the plain number of an angle"};
  }
  return {dimension.base, static_cast<std::int8_t>(whole)};
}

double PowerOf(double x, double exponent) {
  if (exponent == 2) return x * x;
  if (exponent == 3) return x * x * x;
  if (exponent == 0.5) return std::sqrt(x);
  return std::pow(x, exponent);
}

Value Power(const Value& base, const Value& exponent) {
  if (!exponent.dimension().plain()) {
    throw OpFailure{Code::kDimensionMismatch,
                    "an exponent is a plain number, and this is " + Describe(exponent), "", "", 1};
  }
  const Dimension dimension = PowerDimension(base, exponent);
  const double x = base.number(), n = exponent.number();
  if (x == 0 && n < 0) throw OpFailure{Code::kNotFinite, "zero has no negative power"};
  if (x < 0 && n != std::round(n)) {
    throw OpFailure{Code::kNotFinite, "a negative number has only whole powers"};
  }
  const double power = PowerOf(x, n);
  const double by_base = n == 0 ? 0 : n * PowerOf(x, n - 1);
  // 0^n stays 0 for every n near it.
  const double by_exponent = x == 0 ? 0 : power * std::log(x);
  return Combine(power, dimension, {{&base, by_base}, {&exponent, by_exponent}});
}

Value Arithmetic(Op op, const Value& left, const Value& right, const Unit& unit) {
  switch (op) {
    case Op::kAdd:
    case Op::kSubtract:
      return AddScaled(op, left, right, unit);
    case Op::kMultiply:
      return Multiply(left, right);
    case Op::kDivide:
      return Divide(left, right);
    case Op::kModulo:
      return Modulo(left, right, unit);
    default:
      return Power(left, right);
  }
}

Value Componentwise(Op op, const Value& left, const Value& right, const Unit& unit) {
  if (left.list().size() != right.list().size()) {
    throw OpFailure{Code::kWrongCount,
                    Describe(left) + " and " + Describe(right) + " cannot be " + VerbOf(op)};
  }
  std::vector<Value> items;
  for (std::size_t i = 0; i < left.list().size(); ++i) {
    items.push_back(Arithmetic(op, left.list()[i], right.list()[i], unit));
  }
  return Value::List(std::move(items));
}

// On a point: with another one by components, or scaled by a number.
std::optional<Value> PointArithmetic(Op op, const Value& left, const Value& right,
                                     const Unit& unit) {
  if (op == Op::kModulo || op == Op::kPower) return std::nullopt;
  if (IsVector(left) && IsVector(right)) return Componentwise(op, left, right, unit);
  std::vector<Value> items;
  if (op == Op::kMultiply && left.is_number() && IsVector(right)) {
    for (const Value& item : right.list()) items.push_back(Multiply(left, item));
  } else if ((op == Op::kMultiply || op == Op::kDivide) && IsVector(left) && right.is_number()) {
    for (const Value& item : left.list()) items.push_back(Arithmetic(op, item, right, unit));
  } else {
    return std::nullopt;
  }
  return Value::List(std::move(items));
}

[[noreturn]] void FailOperands(Op op, const Value& left, const Value& right) {
  if (IsVector(left) && right.is_number() && (op == Op::kAdd || op == Op::kSubtract)) {
    throw OpFailure{Code::kWrongType, "a point and a number cannot be " + VerbOf(op),
                    "expected a point", "write [x, y, z]", 1};
  }
  const bool left_is_wrong = !left.is_number() && !IsVector(left);
  if (left_is_wrong || !left.is_number()) {
    if (left_is_wrong || right.is_number()) FailOperand(left, 0, VerbOf(op));
  }
  FailOperand(right, 1, VerbOf(op));
}

Value MakeRange(const Value& from, const Value& to, const Unit& unit) {
  for (const Value* end : {&from, &to}) {
    if (end->is_number()) continue;
    throw OpFailure{Code::kWrongType,
                    "a range goes from number to number, but this is " + WhatIs(*end),
                    "expected a number", "", end == &from ? 0 : 1};
  }
  Value left = ValueOf(from), right = ValueOf(to);
  if (!Align(&left, &right, unit)) FailMismatch(left, right, "the ends of one range");
  return Value::Range({left.number(), right.number()}, left.dimension());
}

}  // namespace

Value Binary(Op op, const Value& left, const Value& right, const Context& context) {
  switch (op) {
    case Op::kAdd:
    case Op::kSubtract:
    case Op::kMultiply:
    case Op::kDivide:
    case Op::kModulo:
    case Op::kPower:
      break;
    case Op::kMakeRange:
      return MakeRange(left, right, *context.unit);
    default:
      return Compare(op, left, right, context);
  }
  if (left.is_number() && right.is_number()) return Arithmetic(op, left, right, *context.unit);
  if (auto point = PointArithmetic(op, left, right, *context.unit)) return *std::move(point);
  FailOperands(op, left, right);
}

Value Negate(const Value& value) {
  if (value.is_number()) return Combine(-value.number(), value.dimension(), {{&value, -1.0}});
  if (!IsVector(value)) FailOperand(value, 0, "negated");
  std::vector<Value> items;
  for (const Value& item : value.list()) items.push_back(Negate(item));
  return Value::List(std::move(items));
}

}  // namespace tranos::interp
