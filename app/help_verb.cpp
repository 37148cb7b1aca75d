// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/console.h"
#include "app/help_text.h"
#include "app/library_help.h"
#include "app/status.h"
#include "app/verbs.h"

namespace tranos::app {

namespace {

constexpr std::string_view kMore =
    "`tranos help place arc` tells of one command, `tranos help place` of those that begin so.\n"
    "Further lists: `tranos help statements`, `points`, `settings`, `functions`.\n"
    "`tranos lib` lists the elements of the library.\n"
    "The language is told in docs/language.md, all of the above in docs/reference.md.\n";

std::string Lower(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  }
  return text;
}

// What is known of these words; "" if nothing is.
std::string HelpOn(const std::string& words) {
  if (words.empty()) return CommandList() + std::string(kMore);
  if (words == "commands") return CommandList();
  if (words == "statements") return StatementList();
  if (words == "points") return PointList();
  if (words == "settings") return SettingList();
  if (words == "functions") return FunctionList();
  if (const interp::Command* command = interp::FindCommand(words)) return HelpOf(*command);
  if (std::string known = HelpOfWord(words); !known.empty()) return known;
  if (std::string known = HelpOfElement(words); !known.empty()) return known;
  return CommandsFrom(words) + ElementsFrom(words);
}

}  // namespace

int HelpVerb(const std::vector<std::string>& words) {
  std::string joined;
  for (const std::string& word : words) joined += (joined.empty() ? "" : " ") + word;
  std::string lower = Lower(joined);
  if (lower.ends_with('=')) lower.pop_back();  // `tranos help co=`
  if (const std::string known = HelpOn(lower); !known.empty()) {
    PrintOut(known);
    return kFine;
  }
  std::vector<std::string> commands;
  for (const interp::Command& command : interp::AllCommands()) commands.emplace_back(command.words);
  for (const std::string& element : interp::StandardLibrary().Words()) commands.push_back(element);
  const auto meant = interp::DidYouMean(lower, commands);
  const std::string about = meant ? "" : CommandsAbout(lower) + ElementsAbout(lower);
  PrintFailure("there is no command `" + interp::Printable(joined) + "`" +
               (meant           ? ": did you mean `" + *meant + "`?"
                : about.empty() ? ": `tranos help` lists those there are"
                                : "; these speak of it:"));
  PrintError(about);
  return kCommandLineIsWrong;
}

}  // namespace tranos::app
