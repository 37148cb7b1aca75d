// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/source.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace tranos::interp {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

bool IsContinuation(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

// The length of the well-formed sequence at the beginning of `text`, or 0.
std::size_t SequenceLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if (!IsContinuation(text[i])) return 0;
  }
  const unsigned char second = byte(1);
  const bool overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool surrogate = lead == 0xED && second > 0x9F;
  const bool beyond = lead == 0xF4 && second > 0x8F;
  return overlong || surrogate || beyond ? 0 : length;
}

}  // namespace

SourceText MakeSource(std::string path, std::string text) {
  SourceText source{std::move(path), std::move(text), {}};
  const std::string_view view = source.text;
  const bool marked = view.starts_with(kByteOrderMark);
  // The first line begins after a byte order mark, so that its columns are those one sees.
  source.line_starts.push_back(marked ? static_cast<std::uint32_t>(kByteOrderMark.size()) : 0);
  for (std::size_t at = view.find('\n'); at != view.npos; at = view.find('\n', at + 1)) {
    source.line_starts.push_back(static_cast<std::uint32_t>(at + 1));
  }
  return source;
}

SourceText::Place SourceText::PlaceOf(std::uint32_t offset) const {
  const auto after = std::upper_bound(line_starts.begin(), line_starts.end(), offset);
  const auto line =
      static_cast<std::uint32_t>(std::max<std::ptrdiff_t>(1, after - line_starts.begin()));
  const std::uint32_t start = line_starts[line - 1];
  const std::size_t end = std::min<std::size_t>(offset, text.size());
  std::uint32_t column = 1;
  for (std::size_t i = start; i < end; ++i) column += IsContinuation(text[i]) ? 0 : 1;
  return {line, column};
}

std::string_view SourceText::Line(std::uint32_t line) const {
  if (line == 0 || line > line_starts.size()) return {};
  const std::uint32_t start = line_starts[line - 1];
  std::size_t end = line < line_starts.size() ? line_starts[line] - 1 : text.size();
  if (end > start && end < text.size() && text[end - 1] == '\r') --end;
  return std::string_view(text).substr(start, end - start);
}

std::size_t FirstInvalidUtf8(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    std::uint64_t eight = 0;
    if (text.size() - at >= sizeof eight) {
      std::memcpy(&eight, text.data() + at, sizeof eight);
      if ((eight & 0x8080808080808080u) == 0) {
        at += sizeof eight;
        continue;
      }
    }
    const std::size_t length = SequenceLength(text.substr(at));
    if (length == 0) return at;
    at += length;
  }
  return std::string_view::npos;
}

}  // namespace tranos::interp
