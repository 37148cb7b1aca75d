// SPDX-License-Identifier: GPL-3.0-or-later
// Values as text: for people, for messages, and as key-ins that read back.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "interp/value_support.h"

namespace tranos::interp {

using model::Dimension;
using model::Value;

namespace {

constexpr int kDeepest = 100;  // lists in lists beyond this are shown as …
constexpr std::size_t kLongestShown = 40;

template <class... Precision>
std::string ToChars(double number, Precision... precision) {
  std::array<char, 640> buffer;  // 309 digits, a point and 255 decimals at most
  const auto [end, error] =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), number, precision...);
  return error == std::errc() ? std::string(buffer.data(), end) : std::string("?");
}

// Up to twelve significant digits, or as many decimals as asked for; no minus before a zero.
std::string Rounded(double number, int decimals) {
  std::string text = decimals < 0
                         ? ToChars(number, std::chars_format::general, 12)
                         : ToChars(number, std::chars_format::fixed, std::min(decimals, 255));
  if (text.starts_with('-') && text.find_first_of("123456789") == std::string::npos)
    text.erase(0, 1);
  return text;
}

// "m", "m2", "deg", "px", "m^4"; "" for a plain number.
std::string UnitName(Dimension dimension, std::string_view length_name) {
  std::string_view base = length_name;
  if (dimension.plain()) return "";
  if (dimension.base == Dimension::kAngle) base = "deg";
  if (dimension.base == Dimension::kPixel) base = "px";
  std::string name(base);
  if (dimension.exponent == 1) return name;
  if (dimension.exponent == 2 || dimension.exponent == 3)
    return name + std::to_string(dimension.exponent);
  return name + "^" + std::to_string(dimension.exponent);
}

// A number in the unit that people read it in.
double InUnit(double number, Dimension dimension, const Unit& unit) {
  if (dimension == model::kAngle) return number / (geom::kPi / 180);
  return number / FactorOf(dimension, unit);
}

std::string ShortText(const std::string& text) {
  if (text.size() <= kLongestShown) return text;
  std::size_t end = kLongestShown;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end) + "…";
}

std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    switch (c) {
      case '"':
      case '\\':
        quoted += '\\', quoted += c;
        break;
      case '\n':
        quoted += "\\n";
        break;
      case '{':
      case '}':
        quoted += c, quoted += c;
        break;
      default:
        quoted += c;
    }
  }
  return quoted + '"';
}

void CheckLength(const std::string& text) {
  if (text.size() > kLongestText) {
    throw OpFailure{Code::kMemoryLimit, "the text of this value is longer than 64 MB"};
  }
}

const Unit& Metre() {
  static const Unit metre{"m", model::kLength, 1};
  return metre;
}

constexpr std::string_view kElided = "…";

std::string ElementText(const model::Element& element) {
  const std::string type = model::TypeOf(element);
  return element.name ? type + " " + *element.name : type;
}

// Text for people.
struct Reader {
  const Unit& unit;
  int decimals;
  const SourceList* sources;
  std::string out = {};

  void Number(double number, Dimension dimension, int digits) {
    out += Rounded(InUnit(number, dimension, unit), digits);
    const std::string name = UnitName(dimension, unit.name);
    if (!name.empty()) out += ' ' + name;
  }
  void Deviation(const Value& value) {
    if (!sources || !value.derivatives()) return;
    double sigma = InUnit(Sigma(value, *sources), value.dimension(), unit);
    if (decimals < 0 && sigma > 0) {  // two digits say all that a deviation knows
      sigma = std::strtod(ToChars(sigma, std::chars_format::general, 2).c_str(), nullptr);
    }
    out += " ± " + Rounded(sigma, decimals);
    const std::string name = UnitName(value.dimension(), unit.name);
    if (!name.empty()) out += ' ' + name;
  }
  void List(const Value& value, int depth) {
    const bool point = IsVector(value);
    out += point ? '(' : '[';
    for (std::size_t i = 0; i < value.list().size(); ++i) {
      if (i > 0) out += ", ";
      Add(value.list()[i], depth + 1);
      CheckLength(out);
    }
    out += point ? ')' : ']';
  }
  void Plane(const geom::Frame& plane) {
    out += "plane at ";
    Add(Value::OfPoint(plane.origin), 1);
    out += " normal ";
    const geom::Vec3 normal = plane.z();
    List(Value::List(
             {Value::Number(normal.x()), Value::Number(normal.y()), Value::Number(normal.z())}),
         1);
  }
  void Record(const model::Record& record, int depth) {
    out += record.type + " (";
    for (std::size_t i = 0; i < record.members.size(); ++i) {
      if (i > 0) out += ", ";
      out += record.members[i].first + ": ";
      Add(record.members[i].second, depth + 1);
    }
    out += ')';
  }
  void Add(const Value& value, int depth) {
    if (depth > kDeepest) {
      out += kElided;
      return;
    }
    switch (value.kind()) {
      case Value::Kind::kNone:
        out += "nothing";
        break;
      case Value::Kind::kNumber:
      case Value::Kind::kUncertain:
        Number(value.number(), value.dimension(), decimals);
        Deviation(value);
        break;
      case Value::Kind::kBoolean:
        out += value.boolean() ? "true" : "false";
        break;
      case Value::Kind::kString:
        out += depth > 0 ? Quoted(value.string()) : value.string();
        break;
      case Value::Kind::kList:
        List(value, depth);
        break;
      case Value::Kind::kRange:
        Number(value.range().from, value.dimension(), decimals);
        out += "..";
        Number(value.range().to, value.dimension(), decimals);
        break;
      case Value::Kind::kPlane:
        Plane(value.plane());
        break;
      case Value::Kind::kElement:
        out += ElementText(*value.element());
        break;
      case Value::Kind::kClosure:
        out += "function";
        break;
      case Value::Kind::kRecord:
        Record(value.record(), depth);
        break;
    }
  }
};

// A number as a literal, or a product of literals where no unit has its dimension.
std::string Literal(double number, Dimension dimension) {
  const std::string digits = Digits(number);
  if (dimension.plain()) return digits;
  if (dimension == model::kAngle) return digits + "rad";
  const std::string unit = UnitName(dimension, "m");
  const bool has_unit =
      dimension.base == Dimension::kLength && dimension.exponent > 0 && dimension.exponent < 4;
  if (has_unit || dimension == model::kPixel) return digits + unit;
  const char* one = dimension.base == Dimension::kPixel ? "1px" : "1m";
  return digits + "*" + one + "^" + std::to_string(dimension.exponent);
}

// Text that reads back.
struct Writer {
  std::string out = {};

  void Numbers(const geom::Vec3& v, Dimension dimension) {
    out += '[' + Literal(v.x(), dimension) + ',' + Literal(v.y(), dimension) + ',' +
           Literal(v.z(), dimension) + ']';
  }
  void List(const Value& value, int depth) {
    out += '[';
    for (std::size_t i = 0; i < value.list().size(); ++i) {
      if (i > 0) out += ',';
      Add(value.list()[i], depth + 1);
      CheckLength(out);
    }
    out += ']';
  }
  void Add(const Value& value, int depth) {
    if (depth > kDeepest) {
      throw OpFailure{Code::kDepthLimit, "lists are nested too deeply to be written as a key-in"};
    }
    switch (value.kind()) {
      case Value::Kind::kNone:
        break;
      case Value::Kind::kNumber:
      case Value::Kind::kUncertain:
        out += Literal(value.number(), value.dimension());
        break;
      case Value::Kind::kBoolean:
        out += value.boolean() ? "true" : "false";
        break;
      case Value::Kind::kString:
        out += Quoted(value.string());
        break;
      case Value::Kind::kList:
        List(value, depth);
        break;
      case Value::Kind::kRange:
        out += Literal(value.range().from, value.dimension()) + ".." +
               Literal(value.range().to, value.dimension());
        break;
      case Value::Kind::kPlane:
        out += "at=";
        Numbers(value.plane().origin, model::kLength);
        out += " normal=";
        Numbers(value.plane().z(), model::kPlain);
        out += " x=";
        Numbers(value.plane().x, model::kPlain);
        break;
      case Value::Kind::kElement:
        out += value.element()->name_or_empty();
        break;
      case Value::Kind::kClosure:
      case Value::Kind::kRecord:
        break;  // made by an expression, never typed
    }
  }
};

}  // namespace

std::string Digits(double number) { return ToChars(number); }

std::string WithArticle(std::string_view noun) {
  const bool vowel =
      !noun.empty() && std::string_view("aeiou").find(noun[0]) != std::string_view::npos;
  return (vowel ? "an " : "a ") + std::string(noun);
}

std::string Describe(const Value& value) {
  switch (value.kind()) {
    case Value::Kind::kNone:
      return "nothing";
    case Value::Kind::kNumber:
    case Value::Kind::kUncertain:
      return model::Describe(value.dimension());
    case Value::Kind::kBoolean:
      return "a boolean";
    case Value::Kind::kString:
      return "a string";
    case Value::Kind::kList:
      return "a list of " + std::to_string(value.list().size());
    case Value::Kind::kRange:
      return "a range";
    case Value::Kind::kPlane:
      return "a plane";
    case Value::Kind::kElement:
      return WithArticle(model::TypeOf(*value.element()));
    case Value::Kind::kClosure:
      return "a function";
    case Value::Kind::kRecord:
      return WithArticle(value.record().type);
  }
  return "a value";
}

std::string Shown(const Value& value) {
  switch (value.kind()) {
    case Value::Kind::kNumber:
    case Value::Kind::kUncertain:
      return Rounded(InUnit(value.number(), value.dimension(), Metre()), -1) +
             UnitName(value.dimension(), "m");
    case Value::Kind::kBoolean:
      return value.boolean() ? "true" : "false";
    case Value::Kind::kString:
      return Quoted(ShortText(value.string()));
    default:
      return Describe(value);
  }
}

std::string WhatIs(const Value& value) {
  const bool is_short = value.is_number() || value.is_string() || value.is_boolean();
  if (is_short) return Printable(Shown(value)) + " is " + Describe(value);
  return "it is given " + Describe(value);
}

std::string Format(const Value& value, const Unit& unit, int decimals, const SourceList* sources) {
  Reader reader{unit, decimals, sources};
  reader.Add(value, 0);
  CheckLength(reader.out);
  return std::move(reader.out);
}

std::string KeyInText(const Value& value) {
  Writer writer;
  writer.Add(value, 0);
  CheckLength(writer.out);
  return std::move(writer.out);
}

}  // namespace tranos::interp
