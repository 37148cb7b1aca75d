// SPDX-License-Identifier: GPL-3.0-or-later
// Arithmetic on values: dimensions are checked, bare numbers beside a length are read in the
// working unit, and derivatives are carried to first order. All throw OpFailure.
#pragma once

#include <string>
#include <vector>

#include "interp/program.h"
#include "interp/type.h"
#include "model/value.h"

namespace tranos::interp {

// A source of uncertainty: an unknown, or one evaluation of a `+-` literal.
struct Source {
  double sigma = 0;  // in SI
  std::string name;  // of an unknown, else ""
  double tried = 0;  // error of a literal that a trial of the adjustment has added to its value
};
using SourceList = std::vector<Source>;

// What arithmetic needs of its surroundings.
struct Context {
  const Unit* unit;  // in which bare numbers are read where a length is meant
  SourceList* sources;
};

model::Value Binary(Op op, const model::Value& left, const model::Value& right,
                    const Context& context);
model::Value Negate(const model::Value& value);
// value ± deviation: a new source with that standard deviation; `relative` takes it as a share of
// the value.
model::Value PlusMinus(const model::Value& value, const model::Value& deviation, bool relative,
                       const Context& context);
// The standard deviation of a number: 0 for one without sources.
double Sigma(const model::Value& number, const SourceList& sources);
// The number as its literals state it: to first order without the errors that a trial of the
// adjustment has added to them.
double Stated(const model::Value& number, const SourceList& sources);
// What carrying the deviation of a number or a point through one operation counts for.
std::uint64_t DeviationSteps(const model::Value& value);
// f(x) with its derivative, for functions of one number.
model::Value Chain(const model::Value& x, double value, double derivative,
                   model::Dimension dimension);
// Brings two numbers to one dimension as `+` does; true where that is possible.
bool Align(model::Value* left, model::Value* right, const Unit& unit);
// The unit with its `shares`, so that InSi rounds but once.
Unit WithShares(Unit unit);
// A number of units in SI: 12ft is 144in to the last bit, and 0.3m is 30cm.
double InSi(double number, const Unit& unit);
// `number` read as what `dimension` says if it is bare.
model::Value ReadBare(const model::Value& number, model::Dimension dimension, const Unit& unit);
// The value as the type a parameter, key or setting declares; `name` for the message.
model::Value Convert(const model::Value& value, Type type, const Unit& unit, std::string_view name);
// "a length", "a list of 3", "a line", … for messages.
std::string Describe(const model::Value& value);
// Text for print and "{…}": lengths in the unit with its name; decimals < 0 for as many as needed.
// With the sources, deviations are shown: "35.5 m ± 0.71 m".
std::string Format(const model::Value& value, const Unit& unit, int decimals,
                   const SourceList* sources = nullptr);
// A key-in's text of a value that reads back as the same value: `3.5m`, `[1m,2m,3m]`, `"text"`.
std::string KeyInText(const model::Value& value);
geom::Vec3 PointOf(const model::Value& value);  // of one converted to kPoint

}  // namespace tranos::interp
