// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/console.h"
#include "app/script_run.h"

namespace tranos::app {

// Parses and binds, and runs nothing: all that can be said of a script without drawing.
int CheckVerb(const ScriptOptions& options, bool json) {
  ScriptRun run = CheckScriptFile(options);
  NamePathsFromHere(options, &run);
  if (!json) {
    PrintProblems(run);
    return run.status;
  }
  std::string list;
  if (run.result.sources) {
    for (const interp::Diagnostic& diagnostic : run.result.diagnostics.list()) {
      list +=
          (list.empty() ? "\n  " : ",\n  ") + interp::RenderJson(diagnostic, *run.result.sources);
    }
  }
  PrintOut("[" + list + "\n]\n");
  return run.status;
}

}  // namespace tranos::app
