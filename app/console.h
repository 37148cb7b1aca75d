// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

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

// A line on the terminal that tells how far long work has come; nothing where standard error is no terminal.
class Progress {
 public:
  void Tell(std::string_view doing);  // shown only once the work has taken a while
  ~Progress();

 private:
  bool shown_ = false;
};

}  // namespace tranos::app
