// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/console.h"
#include "app/reference.h"
#include "app/status.h"
#include "app/verbs.h"
#include "interp/functions.h"
#include "interp/program.h"

namespace tranos::app {

int HelpVerb(const std::vector<std::string>& words) {
  std::string joined;
  for (const std::string& word : words) joined += (joined.empty() ? "" : " ") + word;
  std::string lower = joined;
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  }
  if (lower.empty()) {
    PrintOut(CommandList() +
             "\ntranos help COMMAND tells of one; tranos help functions, tranos help settings list "
             "those.\n");
    return kFine;
  }
  if (lower == "functions" || lower == "settings") {
    PrintOut(lower == "functions" ? FunctionList() : SettingList());
    return kFine;
  }
  if (const interp::Command* command = interp::FindCommand(lower)) {
    PrintOut(HelpOf(*command));
    return kFine;
  }
  if (const int builtin = interp::FindBuiltin(joined); builtin >= 0) {
    const interp::Builtin& row = interp::AllBuiltins()[static_cast<std::size_t>(builtin)];
    PrintOut(std::string(row.usage) + "\n  " + std::string(row.summary) + "\n");
    return kFine;
  }
  if (const interp::SettingRow* setting = interp::FindSetting(lower)) {
    PrintOut(std::string(setting->key) + "=\n  " + std::string(setting->summary) + "\n");
    return kFine;
  }
  // A beginning lists what goes on from it: `tranos help place`.
  std::string list;
  std::vector<std::string> known;
  for (const interp::Command& command : interp::AllCommands()) {
    known.emplace_back(command.words);
    if (command.words.starts_with(lower + " ")) {
      list += "  " + std::string(command.words) + ": " + std::string(command.summary) + "\n";
    }
  }
  if (!list.empty()) {
    PrintOut(list);
    return kFine;
  }
  const auto meant = interp::DidYouMean(lower, known);
  PrintFailure("there is no command `" + interp::Printable(joined) + "`" +
               (meant ? ": did you mean `" + *meant + "`?" : ""));
  return kCommandLineIsWrong;
}

}  // namespace tranos::app
