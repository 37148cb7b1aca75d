// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/console.h"
#include "app/files.h"
#include "app/reference.h"
#include "app/status.h"
#include "app/verbs.h"

namespace tranos::app {

int DocsVerb(const DocsOptions& options) {
  const std::string text = Reference();
  if (options.check) {
    const auto known = ReadNamedFile(options.file);
    if (known && *known == text) return kFine;
    PrintFailure("`" + interp::Printable(options.file) + "` is stale: run `tranos docs`");
    return kScriptIsWrong;
  }
  if (const auto written = ReplaceNamedFile(options.file, text); !written) {
    PrintFailure("`" + interp::Printable(options.file) +
                 "` cannot be written: " + written.error().detail);
    return kFileFailed;
  }
  PrintOut(interp::Printable(options.file) + "\n");
  return kFine;
}

}  // namespace tranos::app
