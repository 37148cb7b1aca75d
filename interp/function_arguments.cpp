// SPDX-License-Identifier: GPL-3.0-or-later
// Checks that the built-in functions share.
#include <algorithm>
#include <cmath>

#include "interp/value_support.h"

namespace tranos::interp {

using model::Value;

namespace {

constexpr double kMostItems = 1e8;  // sixteen bytes each

}  // namespace

void FailArgument(Arguments arguments, int index, std::string_view expected) {
  const Value& value = arguments[static_cast<std::size_t>(index)];
  const std::string what(expected);
  throw OpFailure{Code::kWrongType, what + " is needed, but " + WhatIs(value), "expected " + what,
                  "", index};
}

const Value& NumberArgument(Arguments arguments, int index) {
  const Value& value = arguments[static_cast<std::size_t>(index)];
  if (!value.is_number()) FailArgument(arguments, index, "a number");
  return value;
}

Value PlainArgument(Arguments arguments, int index) {
  const Value& value = NumberArgument(arguments, index);
  if (!value.dimension().plain()) {
    const std::string help =
        value.dimension() == model::kAngle ? "rad(a) is an angle's plain number" : "";
    throw OpFailure{Code::kDimensionMismatch, "a plain number is needed, but " + WhatIs(value),
                    "expected a plain number", help, index};
  }
  return value;
}

Value AngleArgument(const CallContext& context, Arguments arguments, int index) {
  const Value value =
      ReadBare(NumberArgument(arguments, index), model::kAngle, *context.arithmetic.unit);
  if (value.dimension() != model::kAngle) {
    throw OpFailure{Code::kDimensionMismatch, "an angle is needed, but " + WhatIs(value),
                    "expected an angle such as 30deg", "", index};
  }
  return value;
}

bool IsVector(const Value& value) {
  if (!value.is_list()) return false;
  const std::vector<Value>& items = value.list();
  if (items.size() != 2 && items.size() != 3) return false;
  return std::all_of(items.begin(), items.end(),
                     [](const Value& item) { return item.is_number(); });
}

void AlignAll(std::vector<Value>& numbers, const Unit& unit, std::string_view doing) {
  const auto measured = std::find_if(numbers.begin(), numbers.end(), [](const Value& number) {
    return !number.dimension().plain();
  });
  if (measured == numbers.end()) return;
  Value pattern = *measured;
  for (Value& number : numbers) {
    if (Align(&number, &pattern, unit)) continue;
    throw OpFailure{Code::kDimensionMismatch, Describe(pattern) + " and " + Describe(number) +
                                                  " cannot be " + std::string(doing)};
  }
}

std::vector<Value> VectorArgument(const CallContext& context, Arguments arguments, int index) {
  const Value& value = arguments[static_cast<std::size_t>(index)];
  if (!IsVector(value)) FailArgument(arguments, index, "a point or direction such as [1,0,0]");
  std::vector<Value> items = value.list();
  AlignAll(items, *context.arithmetic.unit, "parts of one vector");
  if (items.size() == 2) items.push_back(Value::Number(0, items[0].dimension()));
  return items;
}

const std::vector<Value>& ListArgument(Arguments arguments, int index) {
  const Value& value = arguments[static_cast<std::size_t>(index)];
  if (!value.is_list()) FailArgument(arguments, index, "a list");
  return value.list();
}

model::ElementPtr ElementArgument(const CallContext& context, Arguments arguments, int index) {
  const Value& value = arguments[static_cast<std::size_t>(index)];
  if (!value.is_element()) FailArgument(arguments, index, "an element");
  const model::ElementPtr element = CurrentElement(*context.state, value.element());
  context.evaluate(*element);
  return element;
}

std::vector<Value> Progression(const CallContext& context, double from, double step, double count,
                               model::Dimension dimension) {
  if (!(count >= 1)) return {};
  context.charge_items(count < 1e18 ? static_cast<std::uint64_t>(count) : std::uint64_t{1} << 60);
  if (count > kMostItems) {
    throw OpFailure{Code::kMemoryLimit, "a list of " + Digits(count) + " numbers is too long"};
  }
  std::vector<Value> items;
  items.reserve(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    items.push_back(Value::Number(from + static_cast<double>(i) * step, dimension));
  }
  return items;
}

std::vector<Value> ItemsArgument(const CallContext& context, Arguments arguments, int index) {
  const Value& value = arguments[static_cast<std::size_t>(index)];
  if (value.is_list()) {
    context.charge_items(value.list().size());
    return value.list();
  }
  if (value.kind() != Value::Kind::kRange) FailArgument(arguments, index, "a list");
  const double step = StepOf(value.dimension(), *context.arithmetic.unit);
  const auto [from, to] = value.range();
  return Progression(context, from, step, std::floor((to - from) / step * (1 + 1e-12)) + 1,
                     value.dimension());
}

Value Norm(std::span<const Value> numbers) {
  double largest = 0;
  for (const Value& number : numbers) largest = std::max(largest, std::abs(number.number()));
  // A power of two scales without rounding, and keeps the squares from overflowing.
  const double scale = largest > 0 ? std::exp2(std::min(std::ilogb(largest), 1000)) : 1;
  double norm = 0;
  for (const Value& number : numbers) {
    const double scaled = number.number() / scale;
    norm += scaled * scaled;
  }
  norm = scale * std::sqrt(norm);
  std::vector<Term> terms;
  for (const Value& number : numbers) terms.push_back({&number, number.number() / norm});
  return Combine(norm, numbers.empty() ? model::kPlain : numbers[0].dimension(), terms);
}

}  // namespace tranos::interp
