// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>

#include "app/console.h"
#include "app/script_run.h"
#include "interp/format.h"

namespace tranos::app {

namespace {

// The formatted text, or nothing after telling why it cannot be formatted.
std::optional<std::string> Formatted(const std::string& path, std::string text) {
  interp::Sources sources;
  sources.files.push_back(interp::MakeSource(path, std::move(text)));
  interp::Diagnostics diagnostics;
  const std::size_t bad = interp::FirstInvalidUtf8(sources.files[0].text);
  if (bad != std::string::npos) {
    const auto at = static_cast<std::uint32_t>(bad);
    diagnostics.Add({interp::Code::kNotUtf8, {0, at, at + 1}, "the file is not UTF-8", "", ""});
  } else {
    const interp::SyntaxTree tree = interp::Parse(sources, 0, {}, &diagnostics);
    if (!diagnostics.has_errors()) return interp::Format(sources.files[0], tree);
  }
  PrintDiagnostics(diagnostics, sources);
  return std::nullopt;
}

std::string StandardInput() {
  std::string text;
  char buffer[65536];
  for (std::size_t got; (got = std::fread(buffer, 1, sizeof buffer, stdin)) > 0;)
    text.append(buffer, got);
  return text;
}

int FormatFile(const std::string& path, bool check) {
  auto text = ReadNamedFile(path);
  if (!text) {
    PrintFailure("`" + interp::Printable(path) + "` cannot be read: " + text.error().detail);
    return kFileFailed;
  }
  const auto formatted = Formatted(path, *text);
  if (!formatted) return kScriptIsWrong;
  if (*formatted == *text) return kFine;
  if (check) {
    PrintOut(interp::Printable(path) + " would change\n");
    return kScriptIsWrong;
  }
  auto written = ReplaceNamedFile(path, *formatted);
  if (!written) {
    PrintFailure("`" + interp::Printable(path) + "` cannot be written: " + written.error().detail);
    return kFileFailed;
  }
  return kFine;
}

}  // namespace

int FmtVerb(const FmtOptions& options) {
  if (options.files.empty()) {
    const auto formatted = Formatted("standard input", StandardInput());
    if (formatted) PrintOut(*formatted);
    return formatted ? kFine : kScriptIsWrong;
  }
  int status = kFine;
  for (const std::string& path : options.files)
    status = std::max(status, FormatFile(path, options.check));
  return status;
}

}  // namespace tranos::app
