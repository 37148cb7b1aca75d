// SPDX-License-Identifier: GPL-3.0-or-later
// Content hashes over canonical bytes. Lengths are rounded to 2⁻³⁰ m and angles to 2⁻⁴⁰ rad
// before they are hashed, for libm differs between machines in the last bits.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/primitives.h"

namespace tranos::model {

struct Hash128 {
  std::uint64_t high = 0;
  std::uint64_t low = 0;
  friend bool operator==(const Hash128&, const Hash128&) = default;
  friend auto operator<=>(const Hash128&, const Hash128&) = default;
};
// Sum and difference modulo 2¹²⁸: the hash of a set is the sum of its members' hashes.
Hash128 operator+(const Hash128& a, const Hash128& b);
Hash128 operator-(const Hash128& a, const Hash128& b);
std::string Hex(const Hash128& hash);                         // 32 lower-case digits
std::optional<Hash128> HashFromHex(std::string_view digits);  // nothing for other text

// Gathers canonical bytes. Numbers that are no finite double hash as themselves, not as a crash.
class Hasher {
 public:
  Hasher& Tag(std::uint8_t tag) { return Bytes(&tag, sizeof tag); }
  Hasher& Integer(std::int64_t value) { return Bytes(&value, sizeof value); }
  Hasher& Length(double metres);
  Hasher& Angle(double radians);
  Hasher& Ratio(double number);  // weights, knots, direction cosines, scales: to 2⁻⁴⁰
  Hasher& Point(const geom::Vec3& metres);
  Hasher& Direction(const geom::Vec3& unit);
  Hasher& Text(std::string_view text);  // with its length
  Hasher& Hash(const Hash128& hash);
  Hash128 Finish() const;

 private:
  Hasher& Bytes(const void* data, std::size_t size) {
    if (!large_.empty() || size_ + size > sizeof small_) return MoreBytes(data, size);
    std::memcpy(small_ + size_, data, size);
    size_ += size;
    return *this;
  }
  Hasher& MoreBytes(const void* data, std::size_t size);

  std::uint8_t small_[256];
  std::size_t size_ = 0;
  std::vector<std::uint8_t> large_;  // used once small_ is full
};

}  // namespace tranos::model
