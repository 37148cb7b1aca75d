// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <utf8proc.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "interp/diagnostic.h"

namespace tranos::interp {
namespace {

// A longer line is shown only around what is underlined.
constexpr std::size_t kWidestLine = 120;
constexpr std::size_t kColumnsBefore = 45;

struct Colours {
  std::string_view severity, gutter, bold, off;
};

Colours ColoursFor(Severity severity, bool colour) {
  if (!colour) return {"", "", "", ""};
  return {severity == Severity::kError ? "\x1b[1;31m" : "\x1b[1;33m", "\x1b[1;34m", "\x1b[1m",
          "\x1b[0m"};
}

// What a terminal is given for one character, and the columns it takes there.
struct Glyph {
  std::string text;
  std::size_t columns = 0;
  std::size_t bytes = 0;  // of the source
};

Glyph Escaped(std::string text, std::size_t bytes) {
  const std::size_t columns = text.size();
  return {std::move(text), columns, bytes};
}

bool MustBeEscaped(std::int32_t code_point) {
  return code_point < 0x20 || (code_point >= 0x7f && code_point < 0xa0) ||
         (code_point >= 0x200e && code_point <= 0x200f) ||
         (code_point >= 0x2028 && code_point <= 0x202e) ||
         (code_point >= 0x2066 && code_point <= 0x2069) || code_point == 0xfeff;
}

Glyph GlyphAt(std::string_view text, std::size_t at) {
  std::int32_t code_point = -1;
  const auto length =
      utf8proc_iterate(reinterpret_cast<const utf8proc_uint8_t*>(text.data()) + at,
                       static_cast<utf8proc_ssize_t>(text.size() - at), &code_point);
  if (length <= 0)
    return Escaped(fmt::format("\\x{:02x}", static_cast<unsigned char>(text[at])), 1);
  const auto bytes = static_cast<std::size_t>(length);
  if (MustBeEscaped(code_point)) return Escaped(fmt::format("\\u{{{:x}}}", code_point), bytes);
  const int width = utf8proc_charwidth(code_point);
  return {std::string(text.substr(at, bytes)), static_cast<std::size_t>(std::max(width, 0)), bytes};
}

Glyph SourceGlyphAt(std::string_view line, std::size_t at) {
  return line[at] == '\t' ? Glyph{"    ", 4, 1} : GlyphAt(line, at);
}

// The byte from which the columns before `at` number kColumnsBefore or a little fewer.
std::size_t WindowStart(std::string_view line, std::size_t at) {
  std::size_t start = at;
  for (std::size_t columns = 0; start > 0 && columns < kColumnsBefore; ++columns) {
    do {
      --start;
    } while (start > 0 && (static_cast<unsigned char>(line[start]) & 0xC0) == 0x80);
  }
  return start;
}

// A line as it is printed, and where the carets stand below it.
struct Snippet {
  std::string text;
  std::size_t caret_column = 0;
  std::size_t caret_count = 0;
};

Snippet CutOut(std::string_view line, std::size_t begin, std::size_t end) {
  Snippet snippet;
  const bool is_long = line.size() > kWidestLine;
  std::size_t at = is_long ? WindowStart(line, begin) : 0;
  std::size_t column = 0;
  if (at > 0) {
    snippet.text = "…";
    column = 1;
  }
  snippet.caret_column = column;
  for (std::size_t shown = 0; at < line.size() && shown < kWidestLine;) {
    const Glyph glyph = SourceGlyphAt(line, at);
    if (at < begin) snippet.caret_column = column + glyph.columns;
    if (at >= begin && at < end) snippet.caret_count += glyph.columns;
    snippet.text += glyph.text;
    at += glyph.bytes;
    column += glyph.columns;
    shown += std::max<std::size_t>(glyph.columns, 1);
  }
  if (at < line.size()) snippet.text += "…";
  snippet.caret_count = std::max<std::size_t>(snippet.caret_count, 1);
  while (snippet.text.ends_with(' ')) snippet.text.pop_back();
  return snippet;
}

class TextRenderer {
 public:
  TextRenderer(const Diagnostic& diagnostic, const Sources& sources, bool colour)
      : diagnostic_(diagnostic),
        sources_(sources),
        colours_(ColoursFor(diagnostic.severity(), colour)) {
    Widen(diagnostic.span);
    for (const Note& note : diagnostic.notes) Widen(note.span);
  }

  std::string Run() {
    const bool is_error = diagnostic_.severity() == Severity::kError;
    out_ = fmt::format("{}{}[{}]{}{}: {}{}\n", colours_.severity, is_error ? "error" : "warning",
                       InfoOf(diagnostic_.code).code, colours_.off, colours_.bold,
                       Printable(diagnostic_.message), colours_.off);
    AddSnippet(diagnostic_.span, diagnostic_.label);
    if (!diagnostic_.help.empty()) {
      out_ += fmt::format("{:{}} {}={} help: {}\n", "", gutter_, colours_.gutter, colours_.off,
                          Printable(diagnostic_.help));
    }
    for (const Note& note : diagnostic_.notes) {
      out_ += fmt::format("{}note{}: {}\n", colours_.bold, colours_.off, Printable(note.text));
      AddSnippet(note.span, "");
    }
    return std::move(out_);
  }

  std::string RunPlace() {
    AddSnippet(diagnostic_.span, diagnostic_.label);
    return std::move(out_);
  }

 private:
  bool Shows(const Span& span) const {
    return span.file < sources_.files.size() && !sources_.files[span.file].line_starts.empty();
  }

  void Widen(const Span& span) {
    if (!Shows(span)) return;
    const auto line = sources_.files[span.file].PlaceOf(span.begin).line;
    gutter_ = std::max(gutter_, std::to_string(line).size());
  }

  void AddSnippet(const Span& span, std::string_view label) {
    if (!Shows(span)) return;
    const SourceText& source = sources_.files[span.file];
    const SourceText::Place place = source.PlaceOf(span.begin);
    const std::string_view line = source.Line(place.line);
    const std::size_t start = source.line_starts[place.line - 1];
    const std::size_t begin = span.begin > start ? span.begin - start : 0;
    const std::size_t end = span.end > start ? span.end - start : 0;
    const Snippet snippet = CutOut(line, std::min(begin, line.size()), std::min(end, line.size()));
    const auto& [severity, gutter, bold, off] = colours_;
    out_ += fmt::format("{:{}}{}-->{} {}:{}:{}\n", "", gutter_, gutter, off, Printable(source.path),
                        place.line, place.column);
    out_ += fmt::format("{:{}} {}|{}\n", "", gutter_, gutter, off);
    out_ += fmt::format("{}{:>{}} |{}{}{}\n", gutter, place.line, gutter_, off,
                        snippet.text.empty() ? "" : " ", snippet.text);
    out_ += fmt::format("{:{}} {}|{} {:{}}{}{}", "", gutter_, gutter, off, "", snippet.caret_column,
                        severity, std::string(snippet.caret_count, '^'));
    if (!label.empty()) out_ += fmt::format(" {}", Printable(label));
    out_ += fmt::format("{}\n", off);
  }

  const Diagnostic& diagnostic_;
  const Sources& sources_;
  Colours colours_;
  std::size_t gutter_ = 1;
  std::string out_;
};

nlohmann::json PlaceAsJson(const Span& span, const Sources& sources) {
  nlohmann::json json = nlohmann::json::object();
  if (span.file >= sources.files.size()) return json;
  const SourceText& source = sources.files[span.file];
  const auto begin = source.PlaceOf(span.begin);
  const auto end = source.PlaceOf(span.end);
  json["path"] = source.path;
  json["line"] = begin.line;
  json["column"] = begin.column;
  json["end_line"] = end.line;
  json["end_column"] = end.column;
  json["begin"] = span.begin;
  json["end"] = span.end;
  return json;
}

}  // namespace

std::string Printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const Glyph glyph = GlyphAt(text, at);
    out += glyph.text;
    at += glyph.bytes;
  }
  return out;
}

std::string RenderText(const Diagnostic& diagnostic, const Sources& sources, bool colour) {
  return TextRenderer(diagnostic, sources, colour).Run();
}

std::string RenderPlace(const Span& span, std::string_view label, const Sources& sources,
                        bool colour) {
  const Diagnostic at_place{Code::kNotYet, span, "", std::string(label), ""};
  return TextRenderer(at_place, sources, colour).RunPlace();
}

std::string RenderJson(const Diagnostic& diagnostic, const Sources& sources) {
  nlohmann::json json = PlaceAsJson(diagnostic.span, sources);
  json["severity"] = diagnostic.severity() == Severity::kError ? "error" : "warning";
  json["code"] = InfoOf(diagnostic.code).code;
  json["message"] = diagnostic.message;
  json["label"] = diagnostic.label;
  json["help"] = diagnostic.help;
  json["notes"] = nlohmann::json::array();
  for (const Note& note : diagnostic.notes) {
    nlohmann::json entry = PlaceAsJson(note.span, sources);
    entry["text"] = note.text;
    json["notes"].push_back(std::move(entry));
  }
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace tranos::interp
