// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/console.h"

#include <unistd.h>

#include <cstdio>

namespace tranos::app {

void PrintOut(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stdout); }
void PrintError(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stderr); }

bool ErrorsAreOnTerminal() { return isatty(STDERR_FILENO) != 0; }

void PrintDiagnostics(const interp::Diagnostics& diagnostics, const interp::Sources& sources) {
  const bool colour = ErrorsAreOnTerminal();
  for (const interp::Diagnostic& diagnostic : diagnostics.list()) {
    PrintError(interp::RenderText(diagnostic, sources, colour));
  }
  std::size_t shown = 0;
  for (const interp::Diagnostic& diagnostic : diagnostics.list()) {
    shown += diagnostic.severity() == interp::Severity::kError;
  }
  if (diagnostics.error_count() > shown) {
    PrintError("and " + std::to_string(diagnostics.error_count() - shown) + " more errors\n");
  }
}

void PrintFailure(std::string_view message) { PrintError("error: " + std::string(message) + "\n"); }

}  // namespace tranos::app
