// SPDX-License-Identifier: GPL-3.0-or-later
// Running a script from a file, as run, check, inspect and diff do.
#pragma once

#include <functional>
#include <memory>

#include "app/console.h"
#include "app/files.h"
#include "app/status.h"
#include "app/verbs.h"
#include "interp/run.h"

namespace tranos::app {

struct ScriptRun {
  interp::ScriptResult result;
  std::unique_ptr<Sandbox> sandbox;
  int status = kFine;  // of the script itself: its diagnostics and assertions

  // Whether there is a model to write: a failed assertion is a finding about it and no hindrance.
  bool made_model() const { return status == kFine || status == kAssertionFailed; }
};

// Reads and runs, `print` going to standard output or error; what cannot be read is told on
// standard error, with status kFileFailed. Paths in the result are the script's own, below its
// folder. `on_step` and `progress` may be null.
ScriptRun RunScriptFile(const ScriptOptions& options, bool print_to_error,
                        std::function<void(const interp::Step&)> on_step = {},
                        Progress* progress = nullptr);
// The same without running: parses and binds.
ScriptRun CheckScriptFile(const ScriptOptions& options);
// Puts the script's folder, as it was named on the command line, before the paths that diagnostics
// show, so that they can be opened from here.
void NamePathsFromHere(const ScriptOptions& options, ScriptRun* run);
// Diagnostics, undeclared parameters and failed assertions, on standard error.
void PrintProblems(const ScriptRun& run);
// How many threads pictures are made with: as many as were asked for, or as there are cores.
int ThreadsOf(int asked);
// The folder of a path, without its slash; "." if it names none.
std::string FolderOf(const std::string& path);
std::string NameOf(const std::string& path);  // "elements/church.trn" → "church.trn"
std::string StemOf(const std::string& path);  // "elements/church.trn" → "church"

}  // namespace tranos::app
