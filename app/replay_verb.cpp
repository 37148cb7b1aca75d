// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/replay.h"

#include "app/console.h"
#include "app/files.h"
#include "app/memory_limit.h"
#include "app/status.h"
#include "app/verbs.h"

namespace tranos::app {

int ReplayVerb(const ReplayOptions& options) {
  const auto text = ReadNamedFile(options.journal);
  if (!text) {
    PrintFailure("`" + interp::Printable(options.journal) +
                 "` cannot be read: " + text.error().detail);
    return kFileFailed;
  }
  const auto journal = session::ReadJournal(*text);
  if (!journal) {
    PrintError(session::RenderText(journal.error(), options.journal));
    return kScriptIsWrong;
  }
  LimitMemory(journal->settings.limits.memory);
  const session::ReplayReport report = session::Replay(*journal);
  for (const session::JournalFinding& finding : report.findings) {
    PrintError(session::RenderText(finding, options.journal));
  }
  using Report = session::ReplayReport;
  if (report.verdict == Report::kDiffers || report.verdict == Report::kBroken)
    return kScriptIsWrong;
  const bool is_equal = report.verdict == Report::kEqual;
  PrintOut(std::to_string(report.steps) + " steps, " +
           (is_equal ? "equal\n" : "equal within tolerance\n"));
  return kFine;
}

}  // namespace tranos::app
