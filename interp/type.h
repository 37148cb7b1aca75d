// SPDX-License-Identifier: GPL-3.0-or-later
// The types that parameters, keys and settings are declared with.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tranos::interp {

enum class Type : std::uint8_t {
  kAny,
  kNumber,
  kCount,  // a whole number, not negative
  kLength,
  kArea,
  kVolume,
  kAngle,
  kPixel,
  kBoolean,
  kString,
  kColor,  // 0–255 or "#rrggbb"
  kPoint,  // a list of two or three lengths
  kElement,
  kRange,
  kPlane,
  kWord,      // one of a closed list
  kName,      // an open word, or a string
  kLabel,     // a level or material: a string or a number
  kScale,     // one or three plain numbers
  kElements,  // an element or a list of them
  kPoints,    // a list of points
  kSize,      // two counts, in pixels
  kDot,       // a list of u and v, in pixels
};

// "a length", "a count", … for messages.
std::string_view Describe(Type type);
// The type with this name in a declaration ("length"); only those that docs/language.md lists.
std::optional<Type> TypeNamed(std::string_view name);
std::vector<std::string> TypeNames();

}  // namespace tranos::interp
