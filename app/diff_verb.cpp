// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/console.h"
#include "app/memory_limit.h"
#include "app/script_run.h"
#include "app/status.h"
#include "app/verbs.h"
#include "session/difference.h"
#include "session/journal_reader.h"

namespace tranos::app {

namespace {

// Runs a script, or the script of a journal; the status is not kFine if there is nothing to
// compare.
int RunForDiff(const std::string& path, session::RunRecord* record) {
  session::OriginRecorder recorder(record);
  const auto on_step = [&](const interp::Step& step) { recorder.Add(step); };
  const auto text = ReadNamedFile(path);
  if (text && session::IsJournal(*text)) {
    const auto journal = session::ReadJournal(*text);
    if (!journal) {
      PrintError(session::RenderText(journal.error(), path));
      return kCommandLineIsWrong;
    }
    LimitMemory(journal->settings.limits.memory);
    record->result = session::RunJournal(*journal, on_step, {});
    PrintDiagnostics(record->result.diagnostics, *record->result.sources);
    return record->result.ran && !record->result.diagnostics.has_errors() ? kFine
                                                                          : kCommandLineIsWrong;
  }
  ScriptOptions options;
  options.script = path;
  ScriptRun run = RunScriptFile(options, true, on_step);
  PrintProblems(run);
  record->result = std::move(run.result);
  if (run.status == kFine || run.status == kAssertionFailed) return kFine;
  return run.status == kFileFailed ? kFileFailed : kCommandLineIsWrong;
}

}  // namespace

// As diff(1): 0 no difference, 1 differences, more for trouble.
int DiffVerb(const DiffOptions& options) {
  session::RunRecord a, b;
  if (const int status = RunForDiff(options.a, &a); status != kFine) return status;
  if (const int status = RunForDiff(options.b, &b); status != kFine) return status;
  const session::Difference difference = session::Diff(a, b);
  PrintOut(options.json ? session::RenderJson(difference) : session::RenderText(difference));
  return difference.changes.empty() ? 0 : 1;
}

}  // namespace tranos::app
