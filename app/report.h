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

// `tranos run --json`, on standard output: SI units and degrees whatever the working unit;
// docs/language.md lists the members. A run without a model has no elements and no hash.
void PrintJson(const ScriptRun& run, const std::vector<OutputFile>& outputs);
// `tranos inspect`: the same elements, a line each.
void PrintTable(const ScriptRun& run);

}  // namespace tranos::app
