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

// Each scaled by its own factor; both are sorted by source.
Terms Merged(const Terms& a, double factor_a, const Terms& b, double factor_b) {
  Terms merged;
  merged.reserve(a.size() + b.size());
  const auto add = [&](model::SourceId source, double slope) {
    if (slope != 0)
      merged.emplace_back(source, FiniteOr(slope, "the result's deviation is not finite"));
  };
  auto from_a = a.begin();
  auto from_b = b.begin();
  while (from_a != a.end() || from_b != b.end()) {
    if (from_b == b.end() || (from_a != a.end() && from_a->first < from_b->first)) {
      add(from_a->first, factor_a * from_a->second);
      ++from_a;
    } else if (from_a == a.end() || from_b->first < from_a->first) {
      add(from_b->first, factor_b * from_b->second);
      ++from_b;
    } else {
      add(from_a->first, factor_a * from_a->second + factor_b * from_b->second);
      ++from_a;
      ++from_b;
    }
  }
  return merged;
}

struct Scaled {
  const Terms* terms;
  double factor;
};

// By halves, so that the sum of many takes little more than their terms.
Terms SumOf(std::span<const Scaled> parts) {
  static const Terms kNone;
  if (parts.empty()) return {};
  if (parts.size() == 1) return Merged(*parts[0].terms, parts[0].factor, kNone, 0);
  if (parts.size() == 2)
    return Merged(*parts[0].terms, parts[0].factor, *parts[1].terms, parts[1].factor);
  const std::size_t half = parts.size() / 2;
  return Merged(SumOf(parts.first(half)), 1, SumOf(parts.subspan(half)), 1);
}

}  // namespace

Value Combine(double value, Dimension dimension, std::span<const Term> terms) {
  FiniteOr(value, "the result is not a finite number");
  std::vector<Scaled> parts;
  for (const auto& [number, slope] : terms) {
    if (const model::Derivatives* derivatives = number->derivatives())
      parts.push_back({&derivatives->terms, slope});
  }
  if (parts.empty()) return Value::Number(value, dimension);
  Terms all = SumOf(parts);
  if (all.empty()) return Value::Number(value, dimension);
  return Value::Uncertain({value, {std::move(all)}}, dimension);
}

std::uint64_t DeviationSteps(const Value& value) {
  constexpr std::uint64_t kTermsPerStep = 8;
  if (const model::Derivatives* derivatives = value.derivatives())
    return derivatives->terms.size() / kTermsPerStep;
  std::uint64_t steps = 0;
  if (IsVector(value)) {
    for (const Value& item : value.list()) steps += DeviationSteps(item);
  }
  return steps;
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

double StepOf(Dimension dimension, const Unit& unit) {
  return dimension == model::kAngle ? BareFactor(dimension, unit) : FactorOf(dimension, unit);
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
  const double value =
      dimension == model::kLength ? InSi(number.number(), unit) : number.number() * factor;
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

double ShareOf(const std::pair<model::SourceId, double>& term, const SourceList& sources) {
  const auto& [source, slope] = term;
  return source < sources.size() ? std::abs(slope) * sources[source].sigma : 0;
}

double Sigma(const Value& number, const SourceList& sources) {
  const model::Derivatives* derivatives = number.derivatives();
  if (!derivatives) return 0;
  double sigma = 0;
  for (const auto& term : derivatives->terms) sigma = std::hypot(sigma, ShareOf(term, sources));
  return FiniteOr(sigma, "the deviation is not a finite number");
}

double Stated(const Value& number, const SourceList& sources) {
  double stated = number.number();
  if (!number.derivatives()) return stated;
  for (const auto& [source, slope] : number.derivatives()->terms) {
    if (source < sources.size()) stated -= slope * sources[source].tried;
  }
  return stated;
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
  return Value::Uncertain({number.number(), {std::move(terms), true}}, number.dimension());
}

}  // namespace tranos::interp
