// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/console.h"
#include "app/library_help.h"
#include "app/status.h"
#include "app/verbs.h"

namespace tranos::app {

int LibVerb(const std::string& family) {
  if (const std::string list = ElementList(family); !list.empty()) {
    PrintOut(list);
    return kFine;
  }
  std::vector<std::string> names;
  std::string list;
  for (const interp::LibraryFamily& each : interp::StandardLibrary().families()) {
    names.push_back(each.name);
    list += (list.empty() ? "" : ", ") + each.name;
  }
  const auto meant = interp::DidYouMean(family, names);
  PrintFailure("the library has no family `" + interp::Printable(family) +
               "`: " + (meant ? "did you mean `" + *meant + "`?" : "its families are " + list));
  return kCommandLineIsWrong;
}

}  // namespace tranos::app
