// SPDX-License-Identifier: GPL-3.0-or-later
// Diagnostics are data: a code, a span, what was found, and a way out. Text and JSON are made
// from them in diagnostic_render.cpp alone.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interp/source.h"

namespace tranos::interp {

enum class Severity : std::uint8_t { kError, kWarning };

enum class Code : std::uint16_t {
#define TRANOS_DIAGNOSTIC(code, name, severity, title, explanation) name,
#include "interp/diagnostics.def"
#undef TRANOS_DIAGNOSTIC
};

// What `tranos explain` knows of a code.
struct CodeInfo {
  std::string_view code;  // "E0203"
  std::string_view name;  // "kWrongType"
  Severity severity;
  std::string_view title;        // a sentence without a full stop
  std::string_view explanation;  // why, and what to do, a paragraph
};
const CodeInfo& InfoOf(Code code);
std::optional<Code> FindCode(std::string_view code);  // "E0203", in either case
const std::vector<Code>& AllCodes();

struct Note {
  Span span;
  std::string text;
};

struct Diagnostic {
  Code code;
  Span span;                     // the narrowest thing that is wrong
  std::string message;           // lower case, no full stop, source in backticks
  std::string label;             // under the carets: what was expected; may be empty
  std::string help;              // a way out; may be empty
  std::vector<Note> notes = {};  // other places that matter ("first named here")
  Severity severity() const { return InfoOf(code).severity; }
};

// An append-only list. Beyond a hundred errors only their number grows.
class Diagnostics {
 public:
  void Add(Diagnostic diagnostic);
  void Append(const Diagnostics& other);
  void SortByPlace();  // by file and beginning; what begins together stays in order
  bool has_errors() const { return error_count_ > 0; }
  std::size_t error_count() const { return error_count_; }
  const std::vector<Diagnostic>& list() const { return list_; }

 private:
  std::vector<Diagnostic> list_;
  std::size_t error_count_ = 0;
  std::size_t warning_count_ = 0;
};

// As in docs/language.md, "Evidence and errors", with source line and carets; control characters
// are shown escaped.
std::string RenderText(const Diagnostic& diagnostic, const Sources& sources, bool colour);
// The place alone, as it stands below a diagnostic's first line: path, source line, carets, label.
std::string RenderPlace(const Span& span, std::string_view label, const Sources& sources,
                        bool colour);
// One JSON object: severity, code, message, label, help, path, line, column, end_line, end_column,
// begin, end (bytes), notes.
std::string RenderJson(const Diagnostic& diagnostic, const Sources& sources);
// Text in which control characters and ill-formed UTF-8 are escaped, for terminals.
std::string Printable(std::string_view text);

// The candidate nearest to `word` by edit distance (case ignored, transpositions counted as one),
// if it is near enough to be meant.
std::optional<std::string> DidYouMean(std::string_view word,
                                      const std::vector<std::string>& candidates);

}  // namespace tranos::interp
