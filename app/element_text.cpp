// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/element_text.h"

#include <algorithm>

#include "app/command_text.h"
#include "stdlib/texts.h"

namespace tranos::app {

using interp::DefinedParameter;
using interp::Definition;

const ElementLibrary& StandardElements() {
  static const ElementLibrary kElements = [] {
    ElementLibrary elements{&interp::StandardLibrary(), {}};
    for (const stdlib::Text& text : stdlib::Facts()) elements.facts.emplace(text.name, text.text);
    return elements;
  }();
  return kElements;
}

BoundFamily BindLibraryFamily(const ElementLibrary& elements, const interp::LibraryFamily& family) {
  interp::Bound bound = interp::BindFamily(*elements.library, family);
  BoundFamily result{&family, bound.program, std::move(bound.diagnostics), {}};
  for (const Definition& definition : result.program->definitions) {
    const interp::SourceText& source = result.program->sources->files[definition.span.file];
    if (source.path == family.path() && elements.library->Defining(definition.words) == &family)
      result.elements.push_back(&definition);
  }
  return result;
}

const Definition* ElementOf(const BoundFamily& family, std::string_view words) {
  for (const Definition* element : family.elements) {
    if (element->words == words) return element;
  }
  return nullptr;
}

std::string TellParameter(const DefinedParameter& parameter) {
  std::string out =
      parameter.type == interp::Type::kWord
          ? "one of " + QuotedWords(parameter.words)
          : (parameter.list ? "a list, each " : "") + std::string(Describe(parameter.type));
  if (!parameter.standard.empty()) out += ", " + parameter.standard + " if not given";
  if (!parameter.range.empty() && parameter.type != interp::Type::kWord)
    out += ", in " + parameter.range;
  if (!parameter.summary.empty()) out += ": " + parameter.summary;
  return out;
}

std::string TellInterfaces(const Definition& element) {
  std::string out;
  for (const interp::DefinedInterface& interface : element.interfaces) {
    out += (out.empty() ? "" : ", ") + interface.name;
    std::string measures;
    for (const std::string& measure : interface.measures)
      measures += (measures.empty() ? "" : ", ") + measure;
    if (!measures.empty()) out += " (" + measures + ")";
  }
  return out;
}

std::string TellParts(const BoundFamily& family, const Definition& element) {
  std::string out;
  for (const std::string& name : family.program->scopes[element.scope].names)
    out += (out.empty() ? "" : ", ") + name;
  return out;
}

std::string FileNameOf(std::string_view words) {
  std::string name(words.substr(words.find(' ') + 1));
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

std::string_view FactsTextOf(const ElementLibrary& elements, std::string_view words) {
  const auto found = elements.facts.find(FileNameOf(words));
  return found == elements.facts.end() ? std::string_view() : found->second;
}

std::vector<std::string> FactsOf(const ElementLibrary& elements, const Definition& element) {
  interp::Sources sources;
  sources.files.push_back(
      interp::MakeSource("facts", std::string(FactsTextOf(elements, element.words))));
  interp::Diagnostics diagnostics;
  const interp::SyntaxTree tree = interp::Parse(sources, 0, {}, &diagnostics);
  std::vector<std::string> facts;
  for (interp::NodeId id = 0; id < tree.nodes.size(); ++id) {
    if (tree[id].kind != interp::NodeKind::kAssert) continue;
    const auto kids = tree.Children(id);
    std::string text(sources.Slice(tree.SpanOf(kids.back())));
    if (kids.size() > 1) text = text.substr(1, text.size() - 2);  // without its quotes
    facts.push_back(std::move(text));
  }
  return facts;
}

}  // namespace tranos::app
