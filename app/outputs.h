// SPDX-License-Identifier: GPL-3.0-or-later
// The model and pictures of a run, as bytes, and their place on the disk.
#pragma once

#include <vector>

#include "app/console.h"
#include "app/report.h"
#include "app/verbs.h"

namespace tranos::app {

struct Written {
  int status = kFine;  // of the writing alone
  std::vector<OutputFile> files;
  interp::Diagnostics diagnostics;
};
// Makes DIR/<stem>.glb and what the script renders and exports; all appear, or none.
Written WriteOutputs(const ScriptRun& run, const RunVerbOptions& options, Progress* progress);

}  // namespace tranos::app
