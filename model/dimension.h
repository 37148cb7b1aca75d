// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

namespace tranos::model {

// What a number measures: a plain number, length^n (m^n), an angle (rad) or pixel^n.
struct Dimension {
  enum Base : std::uint8_t { kNone, kLength, kAngle, kPixel };
  Base base = kNone;
  std::int8_t exponent = 0;
  bool plain() const { return base == kNone; }
  friend bool operator==(const Dimension&, const Dimension&) = default;
};
inline constexpr Dimension kPlain{};
inline constexpr Dimension kLength{Dimension::kLength, 1};
inline constexpr Dimension kArea{Dimension::kLength, 2};
inline constexpr Dimension kVolume{Dimension::kLength, 3};
inline constexpr Dimension kAngle{Dimension::kAngle, 1};
inline constexpr Dimension kPixel{Dimension::kPixel, 1};

// "a length", "an area", "a plain number", "length^4" … for messages.
std::string Describe(Dimension dimension);

}  // namespace tranos::model
