// SPDX-License-Identifier: GPL-3.0-or-later
// Running a script from a file, as run, check, inspect and diff do.
#pragma once

#include <functional>
#include <memory>

#include "app/files.h"
#include "app/status.h"
#include "app/verbs.h"
#include "interp/run.h"

namespace tranos::app {

struct ScriptRun {
  interp::ScriptResult result;
  std::unique_ptr<Sandbox> sandbox;
  int status = kFine;  // of the script itself: its diagnostics and assertions
};

// Reads and runs, `print` going to standard output or error; what cannot be read is told on standard error, with status kFileFailed. `on_step` may be null.
ScriptRun RunScriptFile(const ScriptOptions& options, bool print_to_error,
                        std::function<void(const interp::Step&)> on_step = {});
// Diagnostics, undeclared parameters and failed assertions, on standard error.
void PrintProblems(const ScriptRun& run);
// The host of a script's run: reads through the sandbox, prints to the stream that is given.
interp::Host HostFor(Sandbox* sandbox, bool print_to_error);
std::string FolderOf(const std::string& path);

}  // namespace tranos::app
