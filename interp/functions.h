// SPDX-License-Identifier: GPL-3.0-or-later
// The built-in functions, a row each, and the members of values.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "interp/arithmetic.h"
#include "model/state.h"

namespace tranos::interp {

struct CallContext {
  Context arithmetic;
  const model::State* state;
  // Calls a function value.
  std::function<model::Value(const model::Value& closure, std::span<const model::Value>)> call;
  std::function<void(std::uint64_t)> charge_items;      // list elements made
  std::function<void(const model::Element&)> evaluate;  // its solids, before anything is measured
};

struct Builtin {
  std::string_view usage;  // "sqrt(x)"
  std::string_view summary;
  int least, most;  // arguments; most < 0: any number
  model::Value (*call)(const CallContext&, std::span<const model::Value>);
  std::string_view name() const { return usage.substr(0, usage.find('(')); }
};
std::span<const Builtin> AllBuiltins();
int FindBuiltin(std::string_view name);  // −1 if there is none

// value.name: a measure, a snap, a part, an interface, a coordinate. Throws OpFailure.
model::Value Member(const CallContext& context, const model::Value& value, std::string_view name);
// value.name(arguments): `line.at(0.3)`, `wall.face("south")`. Throws OpFailure.
model::Value CallMember(const CallContext& context, const model::Value& value,
                        std::string_view name, std::span<const model::Value> arguments);
// list[i], list[a..b]. Throws OpFailure.
model::Value IndexInto(const model::Value& list, const model::Value& index);
// The interface that a value stands for: a record of type "interface" with name, at, axis, dir,
// plane, the element that it is of, and its measures. Throws OpFailure for any other value.
model::Interface InterfaceOf(const model::Value& value);
// The element as it now stands in the model, for one that was named or chosen before it changed.
model::ElementPtr CurrentElement(const model::State& state, const model::ElementPtr& element);

}  // namespace tranos::interp
