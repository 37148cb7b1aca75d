// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/limits_option.h"

#include <algorithm>
#include <charconv>
#include <optional>

namespace tranos::app {

namespace {

// Deeper nesting might not fit the machine's stack.
constexpr std::uint64_t kDeepest = 1000;

std::optional<std::uint64_t> ReadNumber(const std::string& text) {
  std::uint64_t value = 0;
  const char* const end_of_text = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), end_of_text, value);
  const std::string_view suffix(end, static_cast<std::size_t>(end_of_text - end));
  const std::uint64_t factor = suffix.empty()  ? 1
                               : suffix == "k" ? 1000
                               : suffix == "M" ? 1'000'000
                               : suffix == "G" ? 1'000'000'000
                                               : 0;
  if (error != std::errc() || value == 0 || factor == 0 || value > UINT64_MAX / 2 / factor)
    return std::nullopt;
  return value * factor;
}

}  // namespace

std::string ReadLimits(const std::string& text, interp::Limits* limits) {
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const std::string part = text.substr(at, comma - at);
    at = comma + 1;
    const std::size_t equals = std::min(part.find('='), part.size());
    const std::string name = part.substr(0, equals);
    const auto value = ReadNumber(part.substr(std::min(equals + 1, part.size())));
    if (name != "steps" && name != "elements" && name != "memory" && name != "depth") {
      return "there is no limit `" + name + "`: there are steps, elements, memory and depth";
    }
    if (!value) return "`" + part + "` needs a whole number above zero, such as 1000, 50M or 2G";
    if (name == "steps") limits->steps = *value;
    if (name == "elements") limits->elements = *value;
    if (name == "memory") limits->memory = *value;
    if (name != "depth") continue;
    if (*value > kDeepest) return "depth is at most " + std::to_string(kDeepest);
    limits->depth = static_cast<int>(*value);
  }
  return "";
}

}  // namespace tranos::app
