// SPDX-License-Identifier: GPL-3.0-or-later
// The text of a script and places in it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tranos::interp {

// A piece of source text: bytes [begin, end) of the file with this index.
struct Span {
  std::uint32_t file = 0;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  friend bool operator==(const Span&, const Span&) = default;
};

// One file's text. Lines and columns count from 1; columns count code points.
struct SourceText {
  std::string path;  // as the user named it
  std::string text;
  std::vector<std::uint32_t> line_starts;  // byte offset of each line
  bool of_library = false;  // a family of the standard library; its path is no file's

  struct Place {
    std::uint32_t line, column;
  };
  Place PlaceOf(std::uint32_t offset) const;
  std::string_view Line(std::uint32_t line) const;  // without its newline
  std::string_view Slice(const Span& span) const {
    return std::string_view(text).substr(span.begin, span.end - span.begin);
  }
};

SourceText MakeSource(std::string path, std::string text);

// The byte offset of the first ill-formed UTF-8 sequence, or npos.
std::size_t FirstInvalidUtf8(std::string_view text);

// All files of a run; a Span's `file` is an index here.
struct Sources {
  std::vector<SourceText> files;
  std::string_view Slice(const Span& span) const { return files[span.file].Slice(span); }
};

}  // namespace tranos::interp
