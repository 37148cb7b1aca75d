// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/console.h"
#include "app/report.h"
#include "app/verbs.h"

namespace tranos::app {

int InspectVerb(const ScriptOptions& options) {
  const ScriptRun run = RunScriptFile(options, true);
  PrintProblems(run);
  if (run.status == kFine || run.status == kAssertionFailed) PrintOut(ReportTable(run));
  return run.status;
}

}  // namespace tranos::app
