// SPDX-License-Identifier: GPL-3.0-or-later
// JSON written by appending: a journal has a line for each key-in, and building a tree of values
// for each would cost more than the run itself.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

#include "geom/primitives.h"

namespace tranos::session {

class JsonText {
 public:
  JsonText& Open(char bracket);             // { or [
  JsonText& Close(char bracket);            // } or ]
  JsonText& Key(std::string_view key);      // a word that needs no escaping
  JsonText& String(std::string_view text);  // ill-formed UTF-8 as U+FFFD
  JsonText& Boolean(bool value);
  JsonText& Null();
  template <std::integral T>
  JsonText& Integer(T value) {
    return Whole(static_cast<std::int64_t>(value));
  }
  JsonText& Number(double value);   // its shortest digits; null if it is not finite
  JsonText& Length(double metres);  // rounded as content hashes round lengths
  JsonText& Ratio(double number);   // … and as they round angles and ratios
  JsonText& Point(const geom::Vec3& metres);
  JsonText& Direction(const geom::Vec3& unit);

  const std::string& text() const { return text_; }
  std::string& text() { return text_; }

 private:
  JsonText& Whole(std::int64_t value);
  void Separate();

  std::string text_;
};

}  // namespace tranos::session
