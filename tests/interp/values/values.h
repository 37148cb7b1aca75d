// SPDX-License-Identifier: GPL-3.0-or-later
// Short names for values and calls, so that tests read as tables.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "interp/arithmetic.h"
#include "interp/failure.h"
#include "interp/functions.h"

namespace tranos::interp {

using model::Value;

inline const Unit kMetre{"m", model::kLength, 1};
inline const Unit kCentimetre{"cm", model::kLength, 0.01};

inline Value N(double x) { return Value::Number(x); }
inline Value M(double x) { return Value::Number(x, model::kLength); }
inline Value M2(double x) { return Value::Number(x, model::kArea); }
inline Value M3(double x) { return Value::Number(x, model::kVolume); }
inline Value Deg(double x) { return Value::Number(x * (geom::kPi / 180), model::kAngle); }
inline Value Px(double x) { return Value::Number(x, model::kPixel); }
inline Value S(std::string text) { return Value::String(std::move(text)); }
inline Value B(bool boolean) { return Value::Boolean(boolean); }
inline Value L(std::vector<Value> items) { return Value::List(std::move(items)); }
inline Value P(double x, double y, double z) { return Value::OfPoint({x, y, z}); }
inline Value R(double from, double to, model::Dimension dimension = model::kPlain) {
  return Value::Range({from, to}, dimension);
}

// A function value of C++, as the machine would make one of `x => …`.
using Callable = std::function<Value(std::span<const Value>)>;
inline Value F(Callable callable) {
  return Value::OfClosure({std::make_shared<const Callable>(std::move(callable))});
}

// Everything that a call needs, with the items charged so far.
struct Bench {
  Unit unit = kMetre;
  SourceList sources = {};
  model::State state = {};
  std::uint64_t charged = 0;
  std::uint64_t limit = 1'000'000;

  Context arithmetic() { return {&unit, &sources}; }
  CallContext context() {
    return {arithmetic(), &state,
            [](const Value& closure, std::span<const Value> arguments) {
              return (*static_cast<const Callable*>(closure.closure().code.get()))(arguments);
            },
            [this](std::uint64_t items) {
              charged += items;
              if (charged > limit) throw OpFailure{Code::kStepLimit, "too many items"};
            },
            [](const model::Element&) {}};
  }
  Value Op2(Op op, const Value& a, const Value& b) { return Binary(op, a, b, arithmetic()); }
  Value PlusMinus(const Value& value, const Value& sigma, bool relative = false) {
    return interp::PlusMinus(value, sigma, relative, arithmetic());
  }
  double SigmaOf(const Value& value) { return Sigma(value, sources); }
  Value Call(std::string_view name, std::vector<Value> arguments) {
    const int index = FindBuiltin(name);
    EXPECT_GE(index, 0) << name;
    return AllBuiltins()[static_cast<std::size_t>(index)].call(context(), arguments);
  }
  Value Get(const Value& value, std::string_view name) { return Member(context(), value, name); }
  Value GetCall(const Value& value, std::string_view name, std::vector<Value> arguments) {
    return CallMember(context(), value, name, arguments);
  }
};

// The failure of what should fail; a test failure if it does not.
template <class Action>
OpFailure FailureOf(const Action& action) {
  try {
    action();
  } catch (const OpFailure& failure) {
    return failure;
  }
  ADD_FAILURE() << "it did not fail";
  return {Code::kNotYet, ""};
}

// Equal to the bit.
inline void ExpectSame(const Value& value, const Value& expected) {
  EXPECT_TRUE(model::Same(value, expected))
      << Format(value, kMetre, -1) << " (" << Describe(value) << ") is not "
      << Format(expected, kMetre, -1) << " (" << Describe(expected) << ")";
}

}  // namespace tranos::interp
