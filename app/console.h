// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "interp/diagnostic.h"

namespace tranos::app {

void PrintOut(std::string_view text);  // standard output
void PrintError(std::string_view text);
// All of them to standard error, in colour on a terminal.
void PrintDiagnostics(const interp::Diagnostics& diagnostics, const interp::Sources& sources);
// "error: …" for what has no place in a script.
void PrintFailure(std::string_view message);
bool ErrorsAreOnTerminal();

// A line on the terminal that tells how far long work has come. It appears once the work has taken
// half a second; where standard error is no terminal, never.
class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // From now on the line says this.
  void Tell(std::string doing);
  // Takes the line away, so that something can be printed in its place.
  void Hide();

 private:
  struct Line;
  std::unique_ptr<Line> line_;  // null where there is no terminal
};

}  // namespace tranos::app
