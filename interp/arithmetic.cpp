// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/arithmetic.h"

#include <algorithm>
#include <cmath>

#include "interp/value_support.h"

namespace tranos::interp {

using model::Dimension;
using model::Value;

namespace {

using Terms = std::vector<std::pair<model::SourceId, double>>;

double FiniteOr(double value, const char* message) {
  if (!std::isfinite(value)) throw OpFailure{Code::kNotFinite, message};
  return value;
}

// Terms with the same source added, those that cancel left out.
Terms Merged(Terms terms) {
  std::stable_sort(terms.begin(), terms.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  Terms merged;
  for (const auto& [source, slope] : terms) {
    if (merged.empty() || merged.back().first != source) {
      if (!merged.empty() && merged.back().second == 0) merged.pop_back();
      merged.emplace_back(source, slope);
    } else {
      merged.back().second += slope;
    }
  }
  if (!merged.empty() && merged.back().second == 0) merged.pop_back();
  for (const auto& [source, slope] : merged) {
    FiniteOr(slope, "the result's deviation is not finite");
  }
  return merged;
}

}  // namespace

Value Combine(double value, Dimension dimension, std::span<const Term> terms) {
  FiniteOr(value, "the result is not a finite number");
  Terms all;
  for (const auto& [number, slope] : terms) {
    const model::Derivatives* derivatives = number->derivatives();
    if (!derivatives) continue;
    for (const auto& [source, own] : derivatives->terms) all.emplace_back(source, slope * own);
  }
  if (all.empty()) return Value::Number(value, dimension);
  all = Merged(std::move(all));
  if (all.empty()) return Value::Number(value, dimension);
  return Value::Uncertain({value, {std::move(all)}}, dimension);
}

double FactorOf(Dimension dimension, const Unit& unit) {
  if (dimension.base != Dimension::kLength) return 1;
  return std::pow(unit.factor, dimension.exponent);
}

double BareFactor(Dimension dimension, const Unit& unit) {
  if (dimension == model::kLength) return unit.factor;
  if (dimension == model::kAngle) return geom::kPi / 180;
  return 1;
}

Unit WithShares(Unit unit) {
  // 0.3048 is 3048/10000: both are exact, and so is the product with a short decimal's numerator.
  for (double shares = 1; shares <= 1e15; shares *= 10) {
    const double whole = std::round(unit.factor * shares);
    if (whole < 1 || std::abs(whole / shares - unit.factor) > 1e-15 * unit.factor) continue;
    unit.shares = shares;
    break;
  }
  return unit;
}

double InSi(double number, const Unit& unit) {
  if (unit.shares == 0) return number * unit.factor;
  return number * std::round(unit.factor * unit.shares) / unit.shares;
}

Value ReadBare(const Value& number, Dimension dimension, const Unit& unit) {
  if (!number.dimension().plain()) return number;
  if (dimension != model::kLength && dimension != model::kAngle && dimension != model::kPixel) {
    return number;
  }
  const double factor = BareFactor(dimension, unit);
  const double value = dimension == model::kLength ? InSi(number.number(), unit) : number.number() * factor;
  return Combine(value, dimension, {{&number, factor}});
}

bool Align(Value* left, Value* right, const Unit& unit) {
  if (left->dimension() == right->dimension()) return true;
  const auto read = [&](Value* bare, const Value& beside) {
    if (beside.dimension() != model::kLength && beside.dimension() != model::kAngle) return;
    *bare = ReadBare(*bare, beside.dimension(), unit);
  };
  if (left->dimension().plain()) {
    read(left, *right);
  } else if (right->dimension().plain()) {
    read(right, *left);
  }
  return left->dimension() == right->dimension();
}

Value Chain(const Value& x, double value, double derivative, Dimension dimension) {
  return Combine(value, dimension, {{&x, derivative}});
}

double Sigma(const Value& number, const SourceList& sources) {
  const model::Derivatives* derivatives = number.derivatives();
  if (!derivatives) return 0;
  double sigma = 0;
  for (const auto& [source, slope] : derivatives->terms) {
    if (source < sources.size()) sigma = std::hypot(sigma, slope * sources[source].sigma);
  }
  return FiniteOr(sigma, "the deviation is not a finite number");
}

Value PlusMinus(const Value& value, const Value& deviation, bool relative, const Context& context) {
  for (const Value* operand : {&value, &deviation}) {
    if (operand->is_number()) continue;
    throw OpFailure{Code::kWrongType,
                    "a deviation belongs to a number, but this is " + WhatIs(*operand),
                    "expected a number", "", operand == &value ? 0 : 1};
  }
  Value number = value, sigma = ValueOf(deviation);
  double sigma_si = 0;
  if (relative) {
    if (!sigma.dimension().plain()) {
      throw OpFailure{Code::kDimensionMismatch, "a relative deviation is a plain number", "", "",
                      1};
    }
    sigma_si = std::abs(number.number()) * sigma.number();
  } else {
    if (!Align(&number, &sigma, *context.unit)) {
      throw OpFailure{Code::kDimensionMismatch,
                      Describe(value) + " cannot have " + Describe(deviation) + " as its deviation",
                      "", "a per cent is taken of the value: +- 2%", 1};
    }
    sigma_si = sigma.number();
  }
  if (sigma_si < 0) {
    throw OpFailure{Code::kOutOfRange, "a standard deviation is not negative", "", "", 1};
  }
  FiniteOr(sigma_si, "the deviation is not a finite number");
  const auto source = static_cast<model::SourceId>(context.sources->size());
  context.sources->push_back({sigma_si, ""});
  Terms terms;
  if (const model::Derivatives* derivatives = number.derivatives()) terms = derivatives->terms;
  terms.emplace_back(source, 1.0);  // the newest source is the last
  return Value::Uncertain({number.number(), {std::move(terms)}}, number.dimension());
}

}  // namespace tranos::interp
