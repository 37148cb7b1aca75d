// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/type.h"

#include <array>

namespace tranos::interp {

namespace {

struct TypeName {
  Type type;
  std::string_view name;  // in a declaration; "" for types that no declaration names
  std::string_view phrase;
};

constexpr std::array kNames = {
    TypeName{Type::kNumber, "number", "a number"},
    TypeName{Type::kCount, "count", "a count"},
    TypeName{Type::kLength, "length", "a length"},
    TypeName{Type::kArea, "area", "an area"},
    TypeName{Type::kVolume, "volume", "a volume"},
    TypeName{Type::kAngle, "angle", "an angle"},
    TypeName{Type::kBoolean, "boolean", "true or false"},
    TypeName{Type::kString, "string", "a string"},
    TypeName{Type::kColor, "color", "a colour: 0–255 or \"#rrggbb\""},
    TypeName{Type::kPoint, "point", "a point"},
    TypeName{Type::kElement, "element", "an element"},
    TypeName{Type::kRange, "range", "a range"},
    TypeName{Type::kPlane, "plane", "a plane"},
    TypeName{Type::kWord, "word", "a word"},
    TypeName{Type::kName, "", "a name"},
    TypeName{Type::kAny, "", "a value"},
    TypeName{Type::kPixel, "", "a number of pixels"},
    TypeName{Type::kLabel, "", "a string or a number"},
    TypeName{Type::kScale, "", "one or three numbers"},
    TypeName{Type::kElements, "", "an element or a list of elements"},
    TypeName{Type::kPoints, "", "a list of points"},
    TypeName{Type::kSize, "", "a width and a height in pixels"},
    TypeName{Type::kDot, "", "a dot"},
};

}  // namespace

std::string_view Describe(Type type) {
  for (const TypeName& entry : kNames) {
    if (entry.type == type) return entry.phrase;
  }
  return "a value";
}

std::optional<Type> TypeNamed(std::string_view name) {
  if (name.empty()) return std::nullopt;
  for (const TypeName& entry : kNames) {
    if (entry.name == name) return entry.type;
  }
  return std::nullopt;
}

std::vector<std::string> TypeNames() {
  std::vector<std::string> names;
  for (const TypeName& entry : kNames) {
    if (!entry.name.empty()) names.emplace_back(entry.name);
  }
  return names;
}

}  // namespace tranos::interp
