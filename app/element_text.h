// SPDX-License-Identifier: GPL-3.0-or-later
// What `lib`, `help` and the gallery say alike of an element of the standard library.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "interp/run.h"

namespace tranos::app {

// A library, and the scripts of its elements' facts by what files about the element are called.
struct ElementLibrary {
  const interp::Library* library = nullptr;
  std::map<std::string, std::string, std::less<>> facts;
};
const ElementLibrary& StandardElements();

// A family, bound: the definitions that stand in its file, in their order there.
struct BoundFamily {
  const interp::LibraryFamily* family = nullptr;
  std::shared_ptr<const interp::Program> program;
  interp::Diagnostics diagnostics;
  std::vector<const interp::Definition*> elements;
};
BoundFamily BindLibraryFamily(const ElementLibrary& elements, const interp::LibraryFamily& family);
// The element of these words, or null.
const interp::Definition* ElementOf(const BoundFamily& family, std::string_view words);

// Of a parameter without its name: its type, what it is if not given, its range, what it means.
std::string TellParameter(const interp::DefinedParameter& parameter);
// "springing (bay), crown"
std::string TellInterfaces(const interp::Definition& element);
// The names of its parts, "" if it has none.
std::string TellParts(const BoundFamily& family, const interp::Definition& element);
// What its facts say, each a sentence's part: the messages of the asserts.
std::vector<std::string> FactsOf(const ElementLibrary& elements, const interp::Definition& element);
// The text of its facts' script; "" if there is none.
std::string_view FactsTextOf(const ElementLibrary& elements, std::string_view words);
// "dome_onion" of "place dome onion": what files about the element are called.
std::string FileNameOf(std::string_view words);

}  // namespace tranos::app
