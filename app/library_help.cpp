// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/library_help.h"

#include <algorithm>

#include "app/element_text.h"
#include "app/wrap.h"

namespace tranos::app {

namespace {

using interp::Definition;

constexpr std::size_t kIndent = 4;

// The rows of the elements that are wanted, words aligned.
template <class F>
std::string Rows(const interp::LibraryFamily& family, F&& wanted) {
  const BoundFamily bound = BindLibraryFamily(StandardElements(), family);
  std::size_t width = 0;
  for (const Definition* element : bound.elements) {
    if (wanted(*element)) width = std::max(width, element->words.size());
  }
  std::string out;
  for (const Definition* element : bound.elements) {
    if (wanted(*element)) out += Wrap("  " + element->words, width + kIndent, element->summary);
  }
  return out;
}

template <class F>
std::string RowsOfAll(F&& wanted) {
  std::string out;
  for (const interp::LibraryFamily& family : interp::StandardLibrary().families())
    out += Rows(family, wanted);
  return out;
}

std::string Parameters(const Definition& element) {
  std::size_t width = 0;
  for (const interp::DefinedParameter& parameter : element.parameters)
    width = std::max(width, parameter.name.size() + 1);
  std::string out;
  for (const interp::DefinedParameter& parameter : element.parameters)
    out += Wrap("  " + parameter.name + "=", width + kIndent, TellParameter(parameter));
  return out;
}

// A line that can be keyed in: with the first parameter at its default, to show how.
std::string Example(const Definition& element) {
  std::string out = element.words;
  if (!element.parameters.empty() && !element.parameters[0].standard.empty())
    out += " " + element.parameters[0].name + "=" + element.parameters[0].standard;
  return out + " xy=0,0,0";
}

}  // namespace

std::string ElementList(const std::string& family) {
  std::string out;
  for (const interp::LibraryFamily& each : interp::StandardLibrary().families()) {
    if (!family.empty() && each.name != family) continue;
    if (family.empty()) out += (out.empty() ? "" : "\n") + each.name + "\n";
    out += Rows(each, [](const Definition&) { return true; });
  }
  return out;
}

std::string HelpOfElement(const std::string& words) {
  const interp::LibraryFamily* family = interp::StandardLibrary().Defining(words);
  if (!family) return "";
  const BoundFamily bound = BindLibraryFamily(StandardElements(), *family);
  const Definition* element = ElementOf(bound, words);
  if (!element) return "";
  std::string out = element->words + "\n" + Wrap("", 2, element->summary) + "\n";
  out += Wrap("", 2, "Of the library's family " + family->name + ". Each data point places one.");
  out += "\n" + Parameters(*element);
  const auto add = [&](std::string_view head, const std::string& text) {
    if (!text.empty()) out += "\n" + Wrap("  " + std::string(head), 14, text);
  };
  add("Interfaces", TellInterfaces(*element));
  add("Parts", TellParts(bound, *element));
  const std::vector<std::string> facts = FactsOf(StandardElements(), *element);
  for (std::size_t i = 0; i < facts.size(); ++i)
    out += (i ? "" : "\n") + Wrap(i ? "" : "  Held to", 14, facts[i]);
  return out + "\n    " + Example(*element) + "\n";
}

std::string ElementsFrom(const std::string& beginning) {
  return RowsOfAll(
      [&](const Definition& element) { return element.words.starts_with(beginning + " "); });
}

std::string ElementsAbout(const std::string& word) {
  return RowsOfAll([&](const Definition& element) {
    return element.words.find(word) != std::string::npos ||
           element.summary.find(word) != std::string::npos;
  });
}

}  // namespace tranos::app
