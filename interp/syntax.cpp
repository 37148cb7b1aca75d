// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/syntax.h"

#include <utf8proc.h>

#include <charconv>
#include <cstdlib>
#include <limits>
#include <system_error>

namespace tranos::interp {

NumberLiteral NumberOf(std::string_view text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc::result_out_of_range) {
    const std::string_view digits(text.data(), static_cast<std::size_t>(rest - text.data()));
    const bool tiny = digits.find("e-") != digits.npos || digits.find("E-") != digits.npos;
    value = tiny ? 0.0 : std::numeric_limits<double>::infinity();
  }
  return {value, text.substr(static_cast<std::size_t>(rest - text.data()))};
}

std::string UnescapeStringText(std::string_view raw) {
  std::string out;
  out.reserve(raw.size());
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const char c = raw[i];
    const bool escapes = c == '\\' || c == '{' || c == '}';
    if (!escapes || i + 1 == raw.size()) {
      out += c;
      continue;
    }
    const char next = raw[++i];
    out += c == '\\' && next == 'n' ? '\n' : next;
  }
  return out;
}

std::string NormalWord(std::string_view word) {
  bool ascii = true;
  for (const char c : word) ascii = ascii && static_cast<signed char>(c) >= 0;
  if (ascii) return std::string(word);
  utf8proc_uint8_t* normal = nullptr;
  const auto length =
      utf8proc_map(reinterpret_cast<const utf8proc_uint8_t*>(word.data()),
                   static_cast<utf8proc_ssize_t>(word.size()), &normal,
                   static_cast<utf8proc_option_t>(UTF8PROC_STABLE | UTF8PROC_COMPOSE));
  if (length < 0) return std::string(word);
  std::string out(reinterpret_cast<const char*>(normal), static_cast<std::size_t>(length));
  std::free(normal);
  return out;
}

}  // namespace tranos::interp
