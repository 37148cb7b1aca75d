// SPDX-License-Identifier: GPL-3.0-or-later
// The model and pictures of a run, as bytes, and their place on the disk.
#pragma once

#include <string>
#include <vector>

#include "app/report.h"
#include "app/verbs.h"

namespace tranos::app {

// Makes DIR/<stem>.glb and what the script renders and exports; all appear, or none. What goes
// wrong is told on standard error; the status says what kind it was.
struct Written {
  int status = kFine;
  std::vector<OutputFile> files;
};
Written WriteOutputs(const ScriptRun& run, const RunVerbOptions& options);

}  // namespace tranos::app
