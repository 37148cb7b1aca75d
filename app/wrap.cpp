// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/wrap.h"

#include <algorithm>
#include <utility>

namespace tranos::app {

namespace {

constexpr std::size_t kWidth = 100;  // columns of a line

std::size_t Columns(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

std::string Wrap(std::string head, std::size_t indent, std::string_view text) {
  std::string out;
  std::string line = std::move(head);
  if (Columns(line) >= indent && !line.empty() && indent > 0) {
    out = line + "\n";
    line.clear();
  }
  line.append(indent - std::min(indent, Columns(line)), ' ');
  bool first = true;
  std::string word;
  const auto flush = [&] {
    if (word.empty()) return;
    if (!first && Columns(line) + 1 + Columns(word) > kWidth) {
      out += line + "\n";
      line = std::string(indent, ' ');
      first = true;
    }
    line += (first ? "" : " ") + word;
    first = false;
    word.clear();
  };
  for (char c : text) {
    if (c == ' ')
      flush();
    else
      word += c;
  }
  flush();
  return out + line + "\n";
}

}  // namespace tranos::app
