// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of lists and texts.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "interp/value_support.h"

namespace tranos::interp {

using model::Value;

namespace {

// Rounding must not drop the last number of a range such as 0..1 in steps of 0.1.
double StepsIn(double span, double step) {
  const double steps = span / step;
  return std::floor(steps + 1e-9 * std::max(1.0, std::abs(steps)));
}

Value Len(const CallContext& context, Arguments a) {
  const Value& value = a[0];
  if (value.is_list()) return Value::Number(static_cast<double>(value.list().size()));
  if (value.is_string()) {
    const auto starts = std::count_if(value.string().begin(), value.string().end(), [](char c) {
      return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    });
    return Value::Number(static_cast<double>(starts));
  }
  if (value.kind() != Value::Kind::kRange) FailArgument(a, 0, "a list or a string");
  const double step = StepOf(value.dimension(), *context.arithmetic.unit);
  const double steps = std::floor((value.range().to - value.range().from) / step * (1 + 1e-12));
  return Combine(std::max(0.0, steps + 1), model::kPlain, {});
}

Value RangeOfCount(const CallContext& context, Arguments a) {
  const double count = PlainArgument(a, 0).number();
  if (count != std::floor(count) || count < 0) FailArgument(a, 0, "a whole number");
  return Value::List(Progression(context, 0, 1, count, model::kPlain));
}

Value Range(const CallContext& context, Arguments a) {
  if (a.size() == 1) {
    if (a[0].is_number()) return RangeOfCount(context, a);
    return Value::List(ItemsArgument(context, a, 0));
  }
  std::vector<Value> numbers;
  for (std::size_t i = 0; i < a.size(); ++i) {
    numbers.push_back(ValueOf(NumberArgument(a, static_cast<int>(i))));
  }
  if (a.size() == 2) {
    const bool plain = numbers[0].dimension().plain() && numbers[1].dimension().plain();
    numbers.push_back(Value::Number(1));
    if (!plain) AlignAll(numbers, *context.arithmetic.unit, "ends of one range");
  }
  AlignAll(numbers, *context.arithmetic.unit, "ends and step of one range");
  const double from = numbers[0].number(), to = numbers[1].number(), step = numbers[2].number();
  if (step == 0)
    throw OpFailure{Code::kOutOfRange, "the step of a range cannot be zero", "", "", 2};
  const double count = StepsIn(to - from, step) + 1;
  if (std::isnan(count)) throw OpFailure{Code::kNotFinite, "the range is too long to be counted"};
  return Value::List(Progression(context, from, step, count, numbers[0].dimension()));
}

const Value& FunctionArgument(Arguments a, int index) {
  const Value& value = a[static_cast<std::size_t>(index)];
  if (value.kind() != Value::Kind::kClosure) FailArgument(a, index, "a function such as x => x^2");
  return value;
}

Value Map(const CallContext& context, Arguments a) {
  const Value& function = FunctionArgument(a, 1);
  std::vector<Value> items = ItemsArgument(context, a, 0);
  for (Value& item : items) item = context.call(function, std::span<const Value>(&item, 1));
  return Value::List(std::move(items));
}

Value Filter(const CallContext& context, Arguments a) {
  const Value& function = FunctionArgument(a, 1);
  std::vector<Value> kept;
  for (Value& item : ItemsArgument(context, a, 0)) {
    const Value keeps = context.call(function, std::span<const Value>(&item, 1));
    if (!keeps.is_boolean()) {
      throw OpFailure{Code::kNotBoolean, "filter's function gives " + Describe(keeps),
                      "expected true or false", "", 1};
    }
    if (keeps.boolean()) kept.push_back(std::move(item));
  }
  return Value::List(std::move(kept));
}

// The order of keys that are all numbers or all strings; equal ones stay as they stood.
std::vector<std::size_t> OrderOf(const CallContext& context, std::vector<Value> keys) {
  std::vector<std::size_t> order(keys.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto all = [&](auto is) {
    return std::all_of(keys.begin(), keys.end(), [&](const Value& key) { return is(key); });
  };
  if (all([](const Value& key) { return key.is_number(); })) {
    AlignAll(keys, *context.arithmetic.unit, "compared");
    std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
      return keys[i].number() < keys[j].number();
    });
  } else if (all([](const Value& key) { return key.is_string(); })) {
    std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
      return keys[i].string() < keys[j].string();
    });
  } else {
    throw OpFailure{Code::kWrongType, "only numbers, or only strings, have an order", "",
                    "sort(list, x => …) sorts by what the function gives"};
  }
  return order;
}

Value Sort(const CallContext& context, Arguments a) {
  const std::vector<Value> items = ItemsArgument(context, a, 0);
  std::vector<Value> keys = items;
  if (a.size() > 1) {
    const Value& function = FunctionArgument(a, 1);
    for (Value& key : keys) key = context.call(function, std::span<const Value>(&key, 1));
  }
  std::vector<Value> sorted;
  sorted.reserve(items.size());
  for (const std::size_t i : OrderOf(context, std::move(keys))) sorted.push_back(items[i]);
  return Value::List(std::move(sorted));
}

Value Reverse(const CallContext& context, Arguments a) {
  std::vector<Value> items = ItemsArgument(context, a, 0);
  std::reverse(items.begin(), items.end());
  return Value::List(std::move(items));
}

Value JoinText(const CallContext& context, const std::vector<Value>& items,
               const std::string& separator) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) text += separator;
    const Value& item = items[i];
    text += item.is_string() ? item.string() : Format(item, *context.arithmetic.unit, -1);
    if (text.size() > kLongestText) {
      throw OpFailure{Code::kMemoryLimit, "the joined text is longer than 64 MB"};
    }
  }
  context.charge_items(text.size() / 16);
  return Value::String(std::move(text));
}

Value JoinLists(const CallContext& context, Arguments lists) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < lists.size(); ++i) {
    count += ListArgument(lists, static_cast<int>(i)).size();
  }
  context.charge_items(count);
  std::vector<Value> items;
  items.reserve(count);
  for (const Value& list : lists) {
    items.insert(items.end(), list.list().begin(), list.list().end());
  }
  return Value::List(std::move(items));
}

Value Join(const CallContext& context, Arguments a) {
  if (a.size() == 2 && a[1].is_string()) {
    return JoinText(context, ItemsArgument(context, a, 0), a[1].string());
  }
  if (a.size() > 1) return JoinLists(context, a);
  const std::vector<Value> items = ItemsArgument(context, a, 0);
  const bool lists =
      std::all_of(items.begin(), items.end(), [](const Value& item) { return item.is_list(); });
  return lists ? JoinLists(context, items) : JoinText(context, items, "");
}

constexpr Builtin kList[] = {
    {"len(list)", "how many items a list has, or characters a string", 1, 1, Len},
    {"range(a, b, step)", "numbers from a to b, both ends in; range(n): the first n from 0", 1, 3,
     Range},
    {"map(list, f)", "what f gives for each item", 2, 2, Map},
    {"filter(list, f)", "the items for which f is true", 2, 2, Filter},
    {"sort(list, f)", "the items in rising order, of what f gives for each if given", 1, 2, Sort},
    {"reverse(list)", "the items in the opposite order", 1, 1, Reverse},
    {"join(list, separator)", "the items as one text; join(list, list): one list", 1, -1, Join},
};

}  // namespace

std::span<const Builtin> ListFunctions() { return kList; }

}  // namespace tranos::interp
