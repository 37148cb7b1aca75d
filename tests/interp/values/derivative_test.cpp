// SPDX-License-Identifier: GPL-3.0-or-later
// Every derivative against a central difference.
#include <rapidcheck.h>

#include "values.h"

namespace tranos::interp {
namespace {

using Function = std::function<Value(Bench&, const std::vector<Value>&)>;

// ∂f/∂x_i as carried, for x_i with a deviation of one.
void CheckDerivatives(const Function& f, std::vector<Value> at) {
  for (std::size_t i = 0; i < at.size(); ++i) {
    Bench bench;
    std::vector<Value> x = at;
    x[i] = bench.PlusMinus(at[i], Value::Number(1, at[i].dimension()));
    const Value result = f(bench, x);
    const double carried = result.derivatives() ? result.derivatives()->terms.at(0).second : 0;
    const double h = 1e-6 * std::max(1.0, std::abs(at[i].number()));
    const auto value_at = [&](double shift) {
      std::vector<Value> moved = at;
      moved[i] = Value::Number(at[i].number() + shift, at[i].dimension());
      return f(bench, moved).number();
    };
    const double difference = (value_at(h) - value_at(-h)) / (2 * h);
    RC_ASSERT(std::abs(carried - difference) <= 1e-5 * (1 + std::abs(difference)));
  }
}

Function OfOp(Op op) {
  return [op](Bench& bench, const std::vector<Value>& x) { return bench.Op2(op, x[0], x[1]); };
}
Function OfCall(std::string_view name) {
  return [name](Bench& bench, const std::vector<Value>& x) { return bench.Call(name, x); };
}
// The functions of two vectors, their six coordinates as arguments.
Function OfVectors(std::string_view name, int component = -1) {
  return [=](Bench& bench, const std::vector<Value>& x) {
    const Value result = bench.Call(name, {L({x[0], x[1], x[2]}), L({x[3], x[4], x[5]})});
    return component < 0 ? result : result.list()[static_cast<std::size_t>(component)];
  };
}

double Between(double low, double high) {
  return low + (high - low) * (*rc::gen::inRange(0, 1'000'001)) / 1e6;
}

TEST(Derivatives, OfOperators) {
  rc::check("operators", [] {
    const double x = Between(-20, 20), y = Between(0.5, 20);
    for (const Op op : {Op::kAdd, Op::kSubtract, Op::kMultiply, Op::kDivide}) {
      CheckDerivatives(OfOp(op), {M(x), M(y)});
      CheckDerivatives(OfOp(op), {N(x), N(y)});
    }
    CheckDerivatives(OfOp(Op::kPower), {N(Between(0.5, 3)), N(Between(-3, 3))});
    const double fraction = std::abs(x / y - std::round(x / y));
    if (fraction > 1e-3) CheckDerivatives(OfOp(Op::kModulo), {M(x), M(y)});
  });
  rc::check("whole powers", [] {
    const double n = *rc::gen::inRange(-3, 5);
    const double x = Between(0.5, 3) * (*rc::gen::element(-1, 1));
    CheckDerivatives(
        [n](Bench& b, const std::vector<Value>& v) { return b.Op2(Op::kPower, v[0], N(n)); },
        {M(x)});
  });
}

TEST(Derivatives, OfFunctions) {
  rc::check("functions of one number", [] {
    for (const auto* name : {"abs", "exp", "atan"})
      CheckDerivatives(OfCall(name), {N(Between(0.1, 5))});
    for (const auto* name : {"sqrt", "log", "log10"})
      CheckDerivatives(OfCall(name), {N(Between(0.5, 9))});
    for (const auto* name : {"asin", "acos"})
      CheckDerivatives(OfCall(name), {N(Between(-0.9, 0.9))});
    for (const auto* name : {"sin", "cos", "rad", "deg"}) {
      CheckDerivatives(OfCall(name), {Value::Number(Between(-7, 7), model::kAngle)});
    }
    CheckDerivatives(OfCall("tan"), {Value::Number(Between(-1.2, 1.2), model::kAngle)});
    CheckDerivatives(OfCall("sqrt"), {M2(Between(0.5, 9))});
    CheckDerivatives(OfCall("sin"), {N(Between(-300, 300))});  // bare: degrees
  });
  rc::check("functions of several", [] {
    const double x = Between(0.5, 5), y = Between(-5, -0.5);
    for (const auto* name : {"atan2", "hypot", "min", "max", "sum"}) {
      CheckDerivatives(OfCall(name), {M(x), M(y)});
    }
  });
}

TEST(Derivatives, OfVectors) {
  rc::check("functions of vectors", [] {
    const std::vector<Value> x = {M(Between(1, 5)),   M(Between(-5, 5)), M(Between(-5, 5)),
                                  M(Between(-5, -1)), M(Between(-5, 5)), M(Between(6, 9))};
    CheckDerivatives(OfVectors("dot"), x);
    CheckDerivatives(OfVectors("distance"), x);
    CheckDerivatives(OfVectors("angle"), x);
    for (int i = 0; i < 3; ++i) CheckDerivatives(OfVectors("cross", i), x);
    CheckDerivatives([](Bench& b, const std::vector<Value>& v) { return b.Call("length", {L(v)}); },
                     {x[0], x[1], x[2]});
    for (std::size_t i = 0; i < 3; ++i) {
      CheckDerivatives(
          [i](Bench& b, const std::vector<Value>& v) {
            return b.Call("normalize", {L(v)}).list()[i];
          },
          {x[0], x[1], x[2]});
    }
  });
}

}  // namespace
}  // namespace tranos::interp
