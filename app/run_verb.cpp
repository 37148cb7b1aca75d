// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/console.h"
#include "app/outputs.h"
#include "app/verbs.h"
#include "app/version.h"
#include "session/journal.h"

namespace tranos::app {

namespace {

// Runs the script; its journal is gathered in `journal`, if one is asked for.
ScriptRun RunWithJournal(const RunVerbOptions& options, std::string* journal, Progress* progress) {
  if (options.journal.empty()) return RunScriptFile(options.script, options.json, {}, progress);
  const ScriptOptions& script = options.script;
  session::JournalWriter writer({script.parameters, script.hypothesis, script.limits},
                                std::string(kVersion),
                                [&](std::string_view text) { journal->append(text); });
  ScriptRun run = RunScriptFile(
      script, options.json, [&](const interp::Step& step) { writer.Add(step); }, progress);
  if (run.result.ran) writer.Finish(run.result);
  return run;
}

int WriteJournal(const std::string& path, const std::string& journal, const Sandbox* sandbox) {
  auto writer = Writer::Into(FolderOf(path), sandbox);
  tl::expected<void, HostError> written;
  if (!writer) written = tl::make_unexpected(writer.error());
  if (written) written = writer->Write(path.substr(path.rfind('/') + 1), journal);
  if (written) written = writer->PutInPlace();
  if (written) return kFine;
  PrintFailure("`" + interp::Printable(path) + "` cannot be written: " + written.error().detail);
  return kFileFailed;
}

}  // namespace

int RunVerb(const RunVerbOptions& options) {
  Progress progress;
  std::string journal;
  ScriptRun run = RunWithJournal(options, &journal, &progress);
  NamePathsFromHere(options.script, &run);
  progress.Hide();
  PrintProblems(run);
  std::vector<OutputFile> files;
  if (run.made_model() && !options.no_output) {
    Written written = WriteOutputs(run, options, &progress);
    progress.Hide();
    PrintDiagnostics(written.diagnostics, *run.result.sources);
    run.result.diagnostics.Append(written.diagnostics);
    if (written.status != kFine) run.status = written.status;
    files = std::move(written.files);
  }
  if (run.made_model() && !options.journal.empty()) {
    const int written = WriteJournal(options.journal, journal, run.sandbox.get());
    if (written != kFine) run.status = written;
  }
  if (options.json) {
    PrintJson(run, files);
  } else {
    for (const OutputFile& file : files) PrintOut(interp::Printable(file.path) + "\n");
  }
  return run.status;
}

}  // namespace tranos::app
