// SPDX-License-Identifier: GPL-3.0-or-later
// What a run made, as JSON and as a table.
#pragma once

#include <string>
#include <vector>

#include "app/script_run.h"

namespace tranos::app {

struct OutputFile {
  std::string path;
  std::uint64_t bytes;
};

// `tranos run --json`: SI units and degrees whatever the working unit; docs/language.md lists the members.
std::string ReportJson(const ScriptRun& run, int status, const std::vector<OutputFile>& outputs);
// `tranos inspect`: the same elements, a line each.
std::string ReportTable(const ScriptRun& run);

}  // namespace tranos::app
