// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/markdown.h"

#include <algorithm>

namespace tranos::bench {
namespace {

// In characters of UTF-8.
std::size_t WidthOf(const std::string& cell) {
  return static_cast<std::size_t>(
      std::ranges::count_if(cell, [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

std::string Table(const std::vector<TableRow>& rows) {
  std::vector<std::size_t> widths(rows[0].size(), 3);
  for (const TableRow& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], WidthOf(row[i]));
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    text += '|';
    for (std::size_t i = 0; i < rows[r].size(); ++i)
      text += ' ' + rows[r][i] + std::string(widths[i] - WidthOf(rows[r][i]), ' ') + " |";
    text += '\n';
    if (r > 0) continue;
    text += '|';
    for (const std::size_t width : widths) text += ' ' + std::string(width, '-') + " |";
    text += '\n';
  }
  return text;
}

std::optional<std::string> WithBlocks(std::string text,
                                      const std::map<std::string, std::string>& blocks) {
  for (const auto& [name, block] : blocks) {
    const std::string begin = "<!-- generated: " + name + " -->\n",
                      end = "<!-- end: " + name + " -->";
    const std::size_t from = text.find(begin);
    if (from == std::string::npos) return {};
    const std::size_t first = from + begin.size(), last = text.find(end, first);
    if (last == std::string::npos) return {};
    text.replace(first, last - first, block);
  }
  return text;
}

}  // namespace tranos::bench
