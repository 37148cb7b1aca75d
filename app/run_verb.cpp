// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/console.h"
#include "app/outputs.h"
#include "app/verbs.h"

namespace tranos::app {

int RunVerb(const RunVerbOptions& options) {
  ScriptRun run = RunScriptFile(options.script, options.json);
  PrintProblems(run);
  int status = run.status;
  std::vector<OutputFile> files;
  // A failed assertion is a finding about the model: the model is written all the same.
  const bool writes = status == kFine || status == kAssertionFailed;
  if (writes && !options.no_output) {
    Written written = WriteOutputs(run, options);
    if (written.status != kFine) status = written.status;
    files = std::move(written.files);
  }
  if (options.json) {
    PrintOut(ReportJson(run, status, files));
  } else {
    for (const OutputFile& file : files) PrintOut(interp::Printable(file.path) + "\n");
  }
  return status;
}

}  // namespace tranos::app
