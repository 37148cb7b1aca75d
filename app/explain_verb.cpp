// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/console.h"
#include "app/status.h"
#include "app/verbs.h"

namespace tranos::app {

int ExplainVerb(const std::string& code) {
  const auto found = interp::FindCode(code);
  if (!found) {
    std::vector<std::string> known;
    for (interp::Code each : interp::AllCodes()) known.emplace_back(interp::InfoOf(each).code);
    const auto meant = interp::DidYouMean(code, known);
    PrintFailure("there is no diagnostic `" + interp::Printable(code) + "`" +
                 (meant ? ": did you mean " + *meant + "?" : ""));
    return kCommandLineIsWrong;
  }
  const interp::CodeInfo& info = interp::InfoOf(*found);
  PrintOut(std::string(info.code) + ": " + std::string(info.title) + "\n\n" +
           std::string(info.explanation) + "\n");
  return kFine;
}

}  // namespace tranos::app
