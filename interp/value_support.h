// SPDX-License-Identifier: GPL-3.0-or-later
// What the files that compute with values share. Internal to interp.
#pragma once

#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interp/arithmetic.h"
#include "interp/failure.h"
#include "interp/functions.h"

namespace tranos::interp {

// One number that a result depends on, with ∂result/∂number.
struct Term {
  const model::Value* number;
  double slope;
};
// The result with its dependence on the sources of the terms; a plain number if there is none.
// kNotFinite for what is not finite.
model::Value Combine(double value, model::Dimension dimension, std::span<const Term> terms);
inline model::Value Combine(double value, model::Dimension dimension,
                            std::initializer_list<Term> terms) {
  return Combine(value, dimension, std::span<const Term>(terms.begin(), terms.size()));
}
// What one source adds to a number's deviation.
double ShareOf(const std::pair<model::SourceId, double>& term, const SourceList& sources);
// The number without its deviation.
inline model::Value ValueOf(const model::Value& number) {
  return model::Value::Number(number.number(), number.dimension());
}

// What one of the unit's kind measures in SI, for a number of this dimension: 1 for angles.
double FactorOf(model::Dimension dimension, const Unit& unit);
// A bare number's factor where `dimension` is meant; 1 where bare numbers are not read so.
double BareFactor(model::Dimension dimension, const Unit& unit);
// What counting and rounding go by: one of the working unit's kind, of angles the degree.
double StepOf(model::Dimension dimension, const Unit& unit);

// The value in a few words for a message, as it might be written: `30deg`, `"abc"`, `a list of 3`.
std::string Shown(const model::Value& value);
// "it is a length": with the value itself where that is short.
std::string WhatIs(const model::Value& value);
std::string WithArticle(std::string_view noun);
// The shortest digits that read back as the number.
std::string Digits(double number);

// Text may not grow beyond this in one step, whatever it is made of.
inline constexpr std::size_t kLongestText = std::size_t{64} << 20;
// Values visited in one comparison or conversion, for lists may share parts and so be vast.
inline constexpr std::size_t kMostVisited = 10'000'000;

// Comparison, in compare.cpp.
bool AreEqual(const model::Value& left, const model::Value& right, const Unit& unit);
model::Value Compare(Op op, const model::Value& left, const model::Value& right,
                     const Context& context);

// Brings all to one dimension, as `+` does; kDimensionMismatch naming what was to be done with
// them.
void AlignAll(std::vector<model::Value>& numbers, const Unit& unit, std::string_view doing);

// Arguments of functions, in function_arguments.cpp. `index` is the argument's, for the message.
using Arguments = std::span<const model::Value>;
const model::Value& NumberArgument(Arguments arguments, int index);
model::Value PlainArgument(Arguments arguments, int index);
model::Value AngleArgument(const CallContext& context, Arguments arguments, int index);
// A list of two or three numbers of one dimension.
std::vector<model::Value> VectorArgument(const CallContext& context, Arguments arguments,
                                         int index);
const std::vector<model::Value>& ListArgument(Arguments arguments, int index);
model::ElementPtr ElementArgument(const CallContext& context, Arguments arguments, int index);
// The items of a list, or the numbers of a range, one apart.
std::vector<model::Value> ItemsArgument(const CallContext& context, Arguments arguments, int index);
// Whole numbers from `from` on; the count is charged before anything is allocated.
std::vector<model::Value> Progression(const CallContext& context, double from, double step,
                                      double count, model::Dimension dimension);
bool IsVector(const model::Value& value);  // a list of two or three numbers
// f of a number; of a point, the point with f of each of its coordinates.
template <class F>
model::Value ForEachCoordinate(const model::Value& value, F&& f) {
  if (!IsVector(value)) return f(value);
  std::vector<model::Value> items;
  for (const model::Value& item : value.list()) items.push_back(f(item));
  return model::Value::List(std::move(items));
}
// √Σx² with its derivatives.
model::Value Norm(std::span<const model::Value> numbers);
// The angle of the direction (x, y) in radians; multiples of 45° as `45deg` gives them.
double ArcTangent(double y, double x);
[[noreturn]] void FailArgument(Arguments arguments, int index, std::string_view expected);

// Elements, in element_measures.cpp.
OpFailure FromGeomError(const geom::Error& error, std::string what);
double LengthOf(const model::Element& element);
double AreaOf(const model::Element& element);
double VolumeOf(const model::Element& element);
double FilledVolumeOf(const model::Element& element);  // what its solids share counts once
double VolumeUnder(const model::Element& element, double z_m);
const geom::Curve* CurveOf(const model::Element& element);      // null if it is none
const geom::Surface* SurfaceOf(const model::Element& element);  // null if it is none
const geom::Solid* SolidOf(const model::Element& element);      // null if it is none
const geom::Region* RegionOf(const model::Element& element);    // null if it is none

// Between the nearest points of two elements.
double DistanceBetween(const CallContext& context, const model::Element& a,
                       const model::Element& b);

// The families of functions.
std::span<const Builtin> MathFunctions();
std::span<const Builtin> ListFunctions();
std::span<const Builtin> VectorFunctions();
std::span<const Builtin> GeometryFunctions();

// Members of elements, in member_element.cpp.
model::Value ElementMember(const CallContext& context, const model::ElementPtr& element,
                           std::string_view name);
model::Value ElementMethod(const CallContext& context, const model::ElementPtr& element,
                           std::string_view name, Arguments arguments);
[[noreturn]] void FailMember(std::string_view what, std::string_view name,
                             const std::vector<std::string>& members);

}  // namespace tranos::interp
