// SPDX-License-Identifier: GPL-3.0-or-later
// Equality, order, `within` and `consistent`.
#include <cmath>
#include <optional>

#include "interp/value_support.h"

namespace tranos::interp {

using model::Value;

namespace {

[[noreturn]] void FailPair(const Value& left, const Value& right) {
  const bool numbers = left.is_number() && right.is_number();
  throw OpFailure{numbers ? Code::kDimensionMismatch : Code::kWrongType,
                  Describe(left) + " and " + Describe(right) + " cannot be compared"};
}

bool NumbersAreEqual(Value left, Value right, const Unit& unit) {
  if (!Align(&left, &right, unit)) FailPair(left, right);
  return left.number() == right.number();
}

bool RangesAreEqual(const Value& a, const Value& b, const Unit& unit) {
  const auto end = [](const Value& range, double number) {
    return Value::Number(number, range.dimension());
  };
  return NumbersAreEqual(end(a, a.range().from), end(b, b.range().from), unit) &&
         NumbersAreEqual(end(a, a.range().to), end(b, b.range().to), unit);
}

// One that stands in the model is the same only as itself; a part of a placed one is told by what
// it is.
bool ElementsAreEqual(const model::Element& a, const model::Element& b) {
  if (a.id != model::kNoElement && b.id != model::kNoElement) return a.id == b.id;
  return a.id == b.id && a.hash == b.hash;
}

// Lists by their length alone; nothing if the two cannot be compared.
std::optional<bool> EqualButForItems(const Value& a, const Value& b, const Unit& unit) {
  if (a.is_number() && b.is_number()) return NumbersAreEqual(a, b, unit);
  if (a.is_none() || b.is_none()) return a.is_none() && b.is_none();
  if (a.kind() != b.kind()) return std::nullopt;
  switch (a.kind()) {
    case Value::Kind::kList:
      return a.list().size() == b.list().size();
    case Value::Kind::kRange:
      return RangesAreEqual(a, b, unit);
    case Value::Kind::kElement:
      return ElementsAreEqual(*a.element(), *b.element());
    default:
      return model::Same(a, b);
  }
}

Value Ordered(Op op, int order) {
  switch (op) {
    case Op::kLess:
      return Value::Boolean(order < 0);
    case Op::kLessEqual:
      return Value::Boolean(order <= 0);
    case Op::kGreater:
      return Value::Boolean(order > 0);
    default:
      return Value::Boolean(order >= 0);
  }
}

Value Order(Op op, Value left, Value right, const Unit& unit) {
  if (left.is_string() && right.is_string())
    return Ordered(op, left.string().compare(right.string()));
  if (!left.is_number() || !right.is_number() || !Align(&left, &right, unit)) FailPair(left, right);
  const double a = left.number(), b = right.number();
  return Ordered(op, a < b ? -1 : a > b ? 1 : 0);
}

Value WithinRange(Value left, const Value& right, const Unit& unit) {
  Value from = Value::Number(right.range().from, right.dimension());
  Value to = Value::Number(right.range().to, right.dimension());
  Value other = left;
  if (!Align(&left, &from, unit) || !Align(&other, &to, unit)) FailPair(left, from);
  const double x = left.number();
  return Value::Boolean(from.number() <= x && x <= to.number());
}

Value Within(Value left, Value right, const Context& context) {
  if (!left.is_number()) {
    throw OpFailure{Code::kWrongType, Describe(left) + " cannot lie within a range",
                    "expected a number", "", 0};
  }
  if (right.kind() == Value::Kind::kRange) return WithinRange(left, right, *context.unit);
  if (!right.derivatives()) {
    throw OpFailure{Code::kWrongType, "`within` takes a range, but this is " + WhatIs(right),
                    "expected a range such as 2m..8m, or 5m +- 10cm", "", 1};
  }
  const bool written = right.derivatives()->last_is_written;
  if (!Align(&left, &right, *context.unit)) FailPair(left, right);
  const auto& terms = right.derivatives()->terms;
  const double bound =
      written ? ShareOf(terms.back(), *context.sources) : Sigma(right, *context.sources);
  return Value::Boolean(std::abs(left.number() - right.number()) <= bound);
}

Value Consistent(Value left, Value right, const Context& context) {
  if (!left.is_number() || !right.is_number()) {
    const bool left_is_wrong = !left.is_number();
    throw OpFailure{
        Code::kWrongType,
        "`consistent` compares numbers, but this is " + WhatIs(left_is_wrong ? left : right),
        "expected a number such as 5m +- 10cm", "", left_is_wrong ? 0 : 1};
  }
  if (!Align(&left, &right, *context.unit)) FailPair(left, right);
  const Value difference =
      Combine(left.number() - right.number(), left.dimension(), {{&left, 1.0}, {&right, -1.0}});
  // What shares sources varies together, and the difference then deviates less.
  const double deviation = Sigma(difference, *context.sources);
  return Value::Boolean(std::abs(difference.number()) <= 3 * deviation);
}

}  // namespace

bool AreEqual(const Value& left, const Value& right, const Unit& unit) {
  std::vector<std::pair<const Value*, const Value*>> pending = {{&left, &right}};
  for (std::size_t visited = 0; !pending.empty(); ++visited) {
    if (visited > kMostVisited) {
      throw OpFailure{Code::kStepLimit, "the lists are too large to be compared"};
    }
    const auto [a, b] = pending.back();
    pending.pop_back();
    const std::optional<bool> equal = EqualButForItems(*a, *b, unit);
    if (!equal) FailPair(*a, *b);
    if (!*equal) return false;
    if (!a->is_list() || &a->list() == &b->list()) continue;
    for (std::size_t i = a->list().size(); i-- > 0;) {
      pending.emplace_back(&a->list()[i], &b->list()[i]);
    }
  }
  return true;
}

Value Compare(Op op, const Value& left, const Value& right, const Context& context) {
  switch (op) {
    case Op::kEqual:
      return Value::Boolean(AreEqual(left, right, *context.unit));
    case Op::kNotEqual:
      return Value::Boolean(!AreEqual(left, right, *context.unit));
    case Op::kWithin:
      return Within(left, right, context);
    case Op::kConsistent:
      return Consistent(left, right, context);
    default:
      return Order(op, left, right, *context.unit);
  }
}

}  // namespace tranos::interp
