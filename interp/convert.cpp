// SPDX-License-Identifier: GPL-3.0-or-later
// A value as the type that a parameter, key or setting declares.
#include <algorithm>
#include <cmath>

#include "interp/value_support.h"

namespace tranos::interp {

using model::Dimension;
using model::Value;

namespace {

constexpr double kMostExact = 9007199254740992;  // 2⁵³: above it, whole numbers have gaps
constexpr double kLargestSize = 16384;

std::string_view ExampleOf(Type type) {
  switch (type) {
    case Type::kNumber:
      return "a number such as 4.5";
    case Type::kCount:
      return "a whole number such as 4";
    case Type::kLength:
      return "a length such as 4.5m";
    case Type::kArea:
      return "an area such as 12.5m2";
    case Type::kVolume:
      return "a volume such as 12.5m3";
    case Type::kAngle:
      return "an angle such as 30deg";
    case Type::kPixel:
      return "a number of pixels such as 24px";
    case Type::kBoolean:
      return "true or false";
    case Type::kString:
    case Type::kName:
    case Type::kWord:
      return "a string such as \"north\"";
    case Type::kColor:
      return "a colour such as 3 or \"#a0b0c0\"";
    case Type::kPoint:
      return "a point such as 0,0,3m";
    case Type::kRange:
      return "a range such as 2m..8m";
    case Type::kPoints:
      return "points such as [[0,0],[5m,0]]";
    case Type::kSize:
      return "a size such as 1280,960";
    case Type::kDot:
      return "a dot such as 102.5,211";
    case Type::kScale:
      return "one or three numbers";
    default:
      return Describe(type);
  }
}

struct Target {
  Type type;
  const Unit& unit;
  std::string_view name;

  // "`rise` is a length, but 30deg is an angle"
  [[noreturn]] void Fail(const Value& value, Code code = Code::kWrongType) const {
    const std::string what = name.empty()
                                 ? std::string(Describe(type)) + " is needed"
                                 : "`" + std::string(name) + "` is " + std::string(Describe(type));
    throw OpFailure{code, what + ", but " + WhatIs(value),
                    "expected " + std::string(ExampleOf(type))};
  }
  [[noreturn]] void FailWith(Code code, const std::string& reason) const {
    const std::string what = name.empty()
                                 ? std::string(Describe(type)) + " is needed"
                                 : "`" + std::string(name) + "` is " + std::string(Describe(type));
    throw OpFailure{code, what + ", but " + reason, "expected " + std::string(ExampleOf(type))};
  }
};

Value ToDimension(const Target& target, const Value& value, Dimension dimension) {
  if (!value.is_number()) target.Fail(value);
  Value number = ReadBare(value, dimension, target.unit);
  if (number.dimension() != dimension) target.Fail(value);
  return number;
}

Value ToCount(const Target& target, const Value& value) {
  const double number = ToDimension(target, value, model::kPlain).number();
  if (number != std::floor(number)) {
    target.FailWith(Code::kWrongType, Shown(value) + " is not a whole number");
  }
  if (number < 0) target.FailWith(Code::kWrongType, Shown(value) + " is negative");
  if (number > kMostExact) target.FailWith(Code::kOutOfRange, Shown(value) + " is too large");
  return Value::Number(number);
}

bool IsHexColour(const std::string& text) {
  const auto is_digit = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
  };
  return text.size() == 7 && text[0] == '#' && std::all_of(text.begin() + 1, text.end(), is_digit);
}

Value ToColour(const Target& target, const Value& value) {
  if (value.is_string()) {
    if (!IsHexColour(value.string())) {
      target.FailWith(Code::kWrongType, Shown(value) + " is not \"#\" and six hexadecimal digits");
    }
    return value;
  }
  const double index = ToDimension(target, value, model::kPlain).number();
  if (index != std::floor(index)) {
    target.FailWith(Code::kWrongType, Shown(value) + " is not a whole number");
  }
  if (index < 0 || index > 255) {
    target.FailWith(Code::kOutOfRange, Shown(value) + " is not in the palette");
  }
  return Value::Number(index);
}

Value ToPoint(const Target& target, const Value& value) {
  if (!value.is_list()) target.Fail(value);
  const std::vector<Value>& items = value.list();
  if (items.size() != 2 && items.size() != 3) target.Fail(value, Code::kWrongCount);
  std::vector<Value> lengths;
  for (const Value& item : items) {
    if (!item.is_number())
      target.FailWith(Code::kWrongType, "a coordinate of it is " + WhatIs(item));
    lengths.push_back(ReadBare(item, model::kLength, target.unit));
    if (lengths.back().dimension() != model::kLength) {
      target.FailWith(Code::kWrongType, "its coordinate " + WhatIs(item));
    }
  }
  return Value::List(std::move(lengths));
}

Value ToPoints(const Target& target, const Value& value) {
  if (!value.is_list()) target.Fail(value);
  std::vector<Value> points;
  points.reserve(value.list().size());
  const Target each{Type::kPoint, target.unit, target.name};
  for (const Value& item : value.list()) points.push_back(ToPoint(each, item));
  return Value::List(std::move(points));
}

Value ToScale(const Target& target, const Value& value) {
  std::vector<Value> factors = value.is_list() ? value.list() : std::vector<Value>(3, value);
  if (factors.size() == 1) factors.resize(3, factors[0]);
  if (factors.size() != 3) target.Fail(value, Code::kWrongCount);
  for (const Value& factor : factors) {
    if (ToDimension(target, factor, model::kPlain).number() == 0) {
      target.FailWith(Code::kOutOfRange, "a scale of 0 would leave nothing");
    }
  }
  return Value::List(std::move(factors));
}

Value ToSize(const Target& target, const Value& value) {
  if (!value.is_list() || value.list().size() != 2) target.Fail(value);
  std::vector<Value> sides;
  for (const Value& item : value.list()) {
    const bool pixels = item.is_number() && item.dimension() == model::kPixel;
    sides.push_back(ToCount(target, pixels ? Value::Number(item.number()) : item));
    if (sides.back().number() < 1 || sides.back().number() > kLargestSize) {
      target.FailWith(Code::kOutOfRange, Shown(item) + " is not from 1 to 16384");
    }
  }
  return Value::List(std::move(sides));
}

Value ToDot(const Target& target, const Value& value) {
  if (!value.is_list() || value.list().size() != 2) target.Fail(value);
  std::vector<Value> coordinates;
  for (const Value& item : value.list()) {
    coordinates.push_back(ToDimension(target, item, model::kPixel));
  }
  return Value::List(std::move(coordinates));
}

// Lists in lists (what a loop named, beside a single element) are laid out flat.
Value ToElements(const Target& target, const Value& value) {
  std::vector<Value> elements;
  std::vector<const Value*> pending = {&value};
  for (std::size_t visited = 0; !pending.empty(); ++visited) {
    if (visited > kMostVisited) target.FailWith(Code::kStepLimit, "the list is too large");
    const Value* next = pending.back();
    pending.pop_back();
    if (next->is_element()) {
      elements.push_back(*next);
    } else if (next->is_list()) {
      for (auto item = next->list().rbegin(); item != next->list().rend(); ++item) {
        pending.push_back(&*item);
      }
    } else {
      target.Fail(*next);
    }
  }
  return Value::List(std::move(elements));
}

Value OfKind(const Target& target, const Value& value, Value::Kind kind) {
  if (value.kind() != kind) target.Fail(value);
  return value;
}

// A number is taken by its digits: a level may be called 3.
Value ToText(const Target& target, const Value& value) {
  if (value.is_string()) return value;
  if (value.is_number() && value.dimension().plain()) return Value::String(Digits(value.number()));
  target.Fail(value);
}

}  // namespace

Value Convert(const Value& value, Type type, const Unit& unit, std::string_view name) {
  const Target target{type, unit, name};
  switch (type) {
    case Type::kAny:
      return value;
    case Type::kNumber:
      return ToDimension(target, value, model::kPlain);
    case Type::kCount:
      return ToCount(target, value);
    case Type::kLength:
      return ToDimension(target, value, model::kLength);
    case Type::kArea:
      return ToDimension(target, value, model::kArea);
    case Type::kVolume:
      return ToDimension(target, value, model::kVolume);
    case Type::kAngle:
      return ToDimension(target, value, model::kAngle);
    case Type::kPixel:
      return ToDimension(target, value, model::kPixel);
    case Type::kBoolean:
      return OfKind(target, value, Value::Kind::kBoolean);
    case Type::kWord:
    case Type::kName:
      return OfKind(target, value, Value::Kind::kString);
    case Type::kString:
    case Type::kLabel:
      return ToText(target, value);
    case Type::kColor:
      return ToColour(target, value);
    case Type::kPoint:
      return ToPoint(target, value);
    case Type::kPoints:
      return ToPoints(target, value);
    case Type::kElement:
      return OfKind(target, value, Value::Kind::kElement);
    case Type::kElements:
      return ToElements(target, value);
    case Type::kRange:
      return OfKind(target, value, Value::Kind::kRange);
    case Type::kPlane:
      return OfKind(target, value, Value::Kind::kPlane);
    case Type::kScale:
      return ToScale(target, value);
    case Type::kSize:
      return ToSize(target, value);
    case Type::kDot:
      return ToDot(target, value);
  }
  return value;
}

geom::Vec3 PointOf(const Value& value) {
  const std::vector<Value>& items = value.list();
  return {items[0].number(), items[1].number(), items.size() > 2 ? items[2].number() : 0};
}

}  // namespace tranos::interp
