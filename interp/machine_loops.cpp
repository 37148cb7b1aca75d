// SPDX-License-Identifier: GPL-3.0-or-later
// Loops: how many turns there are, and the value of each.
#include <algorithm>
#include <cmath>

#include "interp/machine.h"
#include "interp/value_support.h"

namespace tranos::interp {

using model::Value;

bool Machine::BeginCount(const Instruction& i, Value* r, Span span) {
  Value &from = r[i.a], &to = r[i.a + 1], &step = r[i.a + 2];
  if (!from.is_number() || !to.is_number() || !(step.is_none() || step.is_number())) {
    const Value& wrong = !from.is_number() ? from : !to.is_number() ? to : step;
    Fail(Code::kBadLoop, span, "a loop counts over numbers, not over " + Describe(wrong), "",
         "for x in LIST goes through a list");
  }
  if (unsolved_) {
    for (const Value* bound : {&from, &to, &step}) RefuseUnknown(*bound, span, "a loop's bound");
  }
  const Unit& unit = program_.measures[i.n];
  if (step.is_none()) step = Value::Number(BareFactor(from.dimension(), unit), from.dimension());
  if (!Align(&from, &to, unit) || !Align(&from, &step, unit) || !Align(&from, &to, unit)) {
    Fail(Code::kBadLoop, span,
         "the loop goes from " + Describe(from) + " to " + Describe(to) + " by " + Describe(step));
  }
  if (step.number() == 0) Fail(Code::kBadLoop, span, "the step of the loop is zero");
  // How many turns: a bound that is met but for rounding is met.
  const double turns = std::floor((to.number() - from.number()) / step.number() + 1e-9);
  if (!std::isfinite(turns)) Fail(Code::kBadLoop, span, "the loop's bounds are not finite");
  from = Value::Number(from.number(), from.dimension());
  to = Value::Number(turns);
  step = Value::Number(step.number());
  r[i.a + 3] = Value::Number(0);
  if (unsolved_) trail_.push_back({span, static_cast<std::uint32_t>(std::max(turns + 1, 0.0))});
  if (turns < 0) return false;
  budget_.ChargeSteps(1, span);
  turns_.push_back(0);
  turn_values_.push_back(&r[i.b]);
  r[i.b] = from;
  return true;
}

bool Machine::NextCount(const Instruction& i, Value* r, Span span) {
  const double turn = r[i.a + 3].fast_value() + 1;
  if (turn > r[i.a + 1].fast_value()) {
    turns_.pop_back();
    turn_values_.pop_back();
    return false;
  }
  budget_.ChargeSteps(1, span);
  r[i.a + 3] = Value::Number(turn);
  turns_.back() = static_cast<std::uint32_t>(turn);
  r[i.b] = Value::Number(r[i.a].fast_value() + turn * r[i.a + 2].fast_value(), r[i.a].dimension());
  return true;
}

bool Machine::BeginEach(const Instruction& i, Value* r, Span span) {
  Value& list = r[i.a];
  if (list.kind() == Value::Kind::kRange && list.dimension().plain()) {
    // a..b counts up by one.
    const double first = list.range().from, count = std::floor(list.range().to - first + 1e-9) + 1;
    if (count > 0)
      budget_.ChargeBytes(static_cast<std::uint64_t>(std::min(count, 1e18)) * sizeof(Value), span);
    std::vector<Value> items;
    for (double n = 0; n < count; ++n) {
      budget_.ChargeSteps(1, span);
      items.push_back(Value::Number(first + n));
    }
    list = Value::List(std::move(items));
  }
  if (!list.is_list()) {
    Fail(Code::kBadLoop, span, "a loop goes through a list, not through " + Describe(list), "",
         "for i = 1 to 8 counts");
  }
  if (unsolved_) trail_.push_back({span, static_cast<std::uint32_t>(list.list().size())});
  if (list.list().empty()) return false;
  turns_.push_back(0);
  turn_values_.push_back(&r[i.b]);
  r[i.a + 1] = Value::Number(-1);
  return NextEach(i, r, span);
}

bool Machine::NextEach(const Instruction& i, Value* r, Span span) {
  const double index = r[i.a + 1].fast_value() + 1;
  const auto& items = r[i.a].list();
  if (index >= static_cast<double>(items.size())) {
    turns_.pop_back();
    turn_values_.pop_back();
    return false;
  }
  budget_.ChargeSteps(1, span);
  turns_.back() = static_cast<std::uint32_t>(index);
  r[i.a + 1] = Value::Number(index);
  r[i.a + 2] = Value::Number(index);
  r[i.b] = items[static_cast<std::size_t>(index)];
  return true;
}

}  // namespace tranos::interp
