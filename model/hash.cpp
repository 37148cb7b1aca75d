// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>

namespace tranos::model {

namespace {

constexpr double kStepsPerMetre = 0x1p30;
constexpr double kStepsPerUnit = 0x1p40;  // of radians and ratios

// The number on its grid, as an integer. Where that might overflow, a double is coarser than the
// grid anyway, and its own bits stand for it; they are larger than any integer below the bound.
std::int64_t OnGrid(double number, double steps) {
  const double scaled = number * steps;
  if (std::abs(scaled) < 0x1p61)
    return static_cast<std::int64_t>(scaled + std::copysign(0.5, scaled));
  if (std::isnan(number)) return std::numeric_limits<std::int64_t>::min();
  const auto bits = std::bit_cast<std::int64_t>(std::abs(number));
  return number < 0 ? -bits : bits;
}

}  // namespace

Hash128 operator+(const Hash128& a, const Hash128& b) {
  const std::uint64_t low = a.low + b.low;
  return {a.high + b.high + (low < a.low ? 1 : 0), low};
}

Hash128 operator-(const Hash128& a, const Hash128& b) {
  return {a.high - b.high - (a.low < b.low ? 1 : 0), a.low - b.low};
}

std::string Hex(const Hash128& hash) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  text.reserve(32);
  for (const std::uint64_t word : {hash.high, hash.low}) {
    for (int shift = 60; shift >= 0; shift -= 4) text += kDigits[(word >> shift) & 15];
  }
  return text;
}

std::optional<Hash128> HashFromHex(std::string_view digits) {
  if (digits.size() != 32) return std::nullopt;
  std::uint64_t words[2] = {};
  for (std::size_t i = 0; i < 2; ++i) {
    const char* const begin = digits.data() + 16 * i;
    const auto [end, error] = std::from_chars(begin, begin + 16, words[i], 16);
    if (error != std::errc() || end != begin + 16) return std::nullopt;
  }
  return Hash128{words[0], words[1]};
}

Hasher& Hasher::MoreBytes(const void* data, std::size_t size) {
  if (large_.empty()) large_.assign(small_, small_ + size_);
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  large_.insert(large_.end(), bytes, bytes + size);
  return *this;
}

Hasher& Hasher::Length(double metres) { return Integer(OnGrid(metres, kStepsPerMetre)); }
Hasher& Hasher::Angle(double radians) { return Integer(OnGrid(radians, kStepsPerUnit)); }
Hasher& Hasher::Ratio(double number) { return Integer(OnGrid(number, kStepsPerUnit)); }

Hasher& Hasher::Point(const geom::Vec3& metres) {
  const std::int64_t grid[] = {OnGrid(metres.x(), kStepsPerMetre),
                               OnGrid(metres.y(), kStepsPerMetre),
                               OnGrid(metres.z(), kStepsPerMetre)};
  return Bytes(grid, sizeof grid);
}

Hasher& Hasher::Direction(const geom::Vec3& unit) {
  const std::int64_t grid[] = {OnGrid(unit.x(), kStepsPerUnit), OnGrid(unit.y(), kStepsPerUnit),
                               OnGrid(unit.z(), kStepsPerUnit)};
  return Bytes(grid, sizeof grid);
}

Hasher& Hasher::Text(std::string_view text) {
  Integer(static_cast<std::int64_t>(text.size()));
  return Bytes(text.data(), text.size());
}

Hasher& Hasher::Hash(const Hash128& hash) {
  const std::uint64_t words[] = {hash.high, hash.low};
  return Bytes(words, sizeof words);
}

Hash128 Hasher::Finish() const {
  const XXH128_hash_t hash =
      large_.empty() ? XXH3_128bits(small_, size_) : XXH3_128bits(large_.data(), large_.size());
  return {hash.high64, hash.low64};
}

}  // namespace tranos::model
