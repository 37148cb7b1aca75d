// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/json_text.h"

#include <charconv>
#include <cmath>

namespace tranos::session {

namespace {

// Beyond this many steps of the grid a double is coarser than the grid.
constexpr double kLargestOnGrid = 0x1p52;

double OnGrid(double number, double steps) {
  const double scaled = number * steps;
  if (!(std::abs(scaled) < kLargestOnGrid)) return number;
  return std::round(scaled) / steps + 0.0;  // no minus before a zero
}

// The length of the well-formed UTF-8 sequence at `at`, or 0.
std::size_t SequenceAt(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(at);
  const std::size_t length = lead < 0x80   ? 1
                             : lead < 0xC2 ? 0
                             : lead < 0xE0 ? 2
                             : lead < 0xF0 ? 3
                             : lead < 0xF5 ? 4
                                           : 0;
  if (length == 0 || at + length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xC0) != 0x80) return 0;
  }
  if (length == 3 && lead == 0xE0 && byte(at + 1) < 0xA0) return 0;
  if (length == 3 && lead == 0xED && byte(at + 1) > 0x9F) return 0;
  if (length == 4 && lead == 0xF0 && byte(at + 1) < 0x90) return 0;
  if (length == 4 && lead == 0xF4 && byte(at + 1) > 0x8F) return 0;
  return length;
}

void AppendEscaped(char c, std::string* out) {
  static constexpr char kHex[] = "0123456789abcdef";
  switch (c) {
    case '"':
      *out += "\\\"";
      return;
    case '\\':
      *out += "\\\\";
      return;
    case '\n':
      *out += "\\n";
      return;
    case '\t':
      *out += "\\t";
      return;
    default:
      break;
  }
  const auto code = static_cast<unsigned char>(c);
  *out += "\\u00";
  *out += kHex[code >> 4];
  *out += kHex[code & 15];
}

}  // namespace

void JsonText::Separate() {
  if (text_.empty()) return;
  const char last = text_.back();
  if (last != '{' && last != '[' && last != ':' && last != '\n') text_ += ',';
}

JsonText& JsonText::Open(char bracket) {
  Separate();
  text_ += bracket;
  return *this;
}

JsonText& JsonText::Close(char bracket) {
  text_ += bracket;
  return *this;
}

JsonText& JsonText::Key(std::string_view key) {
  Separate();
  text_ += '"';
  text_ += key;
  text_ += "\":";
  return *this;
}

JsonText& JsonText::String(std::string_view text) {
  Separate();
  text_ += '"';
  std::size_t plain = 0;  // where what needs no change begins
  for (std::size_t at = 0; at < text.size();) {
    const auto byte = static_cast<unsigned char>(text[at]);
    if (byte >= 0x20 && byte < 0x7F && byte != '"' && byte != '\\') {
      ++at;
      continue;
    }
    const std::size_t length = byte < 0x80 ? 0 : SequenceAt(text, at);
    if (length > 0) {
      at += length;
      continue;
    }
    text_.append(text, plain, at - plain);
    if (byte < 0x80)
      AppendEscaped(text[at], &text_);
    else
      text_ += "\xEF\xBF\xBD";
    plain = ++at;
  }
  text_.append(text, plain, text.size() - plain);
  text_ += '"';
  return *this;
}

JsonText& JsonText::Boolean(bool value) {
  Separate();
  text_ += value ? "true" : "false";
  return *this;
}

JsonText& JsonText::Null() {
  Separate();
  text_ += "null";
  return *this;
}

JsonText& JsonText::Whole(std::int64_t value) {
  Separate();
  char digits[24];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  text_.append(digits, end);
  return *this;
}

JsonText& JsonText::Number(double value) {
  if (!std::isfinite(value)) return Null();
  Separate();
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  text_.append(digits, end);
  return *this;
}

JsonText& JsonText::Length(double metres) { return Number(OnGrid(metres, 0x1p30)); }
JsonText& JsonText::Ratio(double number) { return Number(OnGrid(number, 0x1p40)); }

JsonText& JsonText::Point(const geom::Vec3& metres) {
  return Open('[').Length(metres.x()).Length(metres.y()).Length(metres.z()).Close(']');
}

JsonText& JsonText::Direction(const geom::Vec3& unit) {
  return Open('[').Ratio(unit.x()).Ratio(unit.y()).Ratio(unit.z()).Close(']');
}

}  // namespace tranos::session
