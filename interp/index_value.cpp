// SPDX-License-Identifier: GPL-3.0-or-later
// list[i], list[a..b], and an interface read back from a value.
#include <cmath>

#include "interp/arithmetic.h"
#include "interp/failure.h"
#include "interp/functions.h"

namespace tranos::interp {

using model::Value;

namespace {

// A whole number from 0 to below `size`.
std::size_t WholeIndex(double index, std::size_t size, int operand) {
  if (index != std::floor(index)) {
    throw OpFailure{Code::kIndexOutside, "an index is a whole number", "", "", operand};
  }
  if (index < 0 || index >= static_cast<double>(size)) {
    const std::string held = size == 0 ? "is empty" : "goes from 0 to " + std::to_string(size - 1);
    throw OpFailure{Code::kIndexOutside, "the list " + held, "outside the list", "", operand};
  }
  return static_cast<std::size_t>(index);
}

}  // namespace

Value IndexInto(const Value& list, const Value& index) {
  if (!list.is_list())
    throw OpFailure{Code::kWrongType, Describe(list) + " has no items", "", "", 0};
  const auto& items = list.list();
  if (index.is_number() && index.dimension().plain())
    return items[WholeIndex(index.number(), items.size(), 1)];
  if (index.kind() != Value::Kind::kRange || !index.dimension().plain()) {
    throw OpFailure{Code::kWrongType,
                    "an index is a whole number or a range, not " + Describe(index), "", "", 1};
  }
  if (index.range().to < index.range().from) return Value::List({});
  const auto first = static_cast<std::ptrdiff_t>(WholeIndex(index.range().from, items.size(), 1));
  const auto last = static_cast<std::ptrdiff_t>(WholeIndex(index.range().to, items.size(), 1));
  return Value::List(std::vector<Value>(items.begin() + first, items.begin() + last + 1));
}

model::Interface InterfaceOf(const Value& value) {
  if (value.kind() != Value::Kind::kRecord || value.record().type != "interface") {
    throw OpFailure{Code::kWrongType, "`on=` takes an interface, and this is " + Describe(value),
                    "expected an interface such as crossing.crown"};
  }
  model::Interface out;
  for (const auto& [name, member] : value.record().members) {
    if (name == "name") {
      out.name = member.string();
    } else if (name == "plane") {
      out.frame = member.plane();
    } else if (name != "at" && name != "axis" && name != "dir" && name != "of") {
      out.measures.emplace_back(name, member);
    }
  }
  return out;
}

}  // namespace tranos::interp
