// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/console.h"
#include "app/report.h"
#include "app/verbs.h"

namespace tranos::app {

int InspectVerb(const ScriptOptions& options) {
  ScriptRun run = [&] {
    Progress progress;
    return RunScriptFile(options, true, {}, &progress);
  }();
  NamePathsFromHere(options, &run);
  PrintProblems(run);
  if (run.made_model()) PrintTable(run);
  return run.status;
}

}  // namespace tranos::app
