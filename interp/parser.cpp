// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/parser.h"

#include <algorithm>
#include <string>

#include "interp/parse_state.h"

namespace tranos::interp {
namespace {

SyntaxTree EmptyTree(std::uint32_t file) {
  SyntaxTree tree;
  tree.file = file;
  tree.nodes.push_back(Node{NodeKind::kScript});
  tree.root = 0;
  return tree;
}

}  // namespace

SyntaxTree Parse(const Sources& sources, std::uint32_t file, const ParseLimits& limits,
                 Diagnostics* diagnostics) {
  const SourceText& source = sources.files[file];
  const std::size_t invalid = FirstInvalidUtf8(source.text);
  if (invalid != std::string_view::npos) {
    const auto at = static_cast<std::uint32_t>(invalid);
    diagnostics->Add({Code::kNotUtf8,
                      {file, at, at + 1},
                      "the file is not UTF-8: byte " + std::to_string(invalid),
                      "the first byte that is not",
                      "save the file as UTF-8"});
    return EmptyTree(file);
  }
  // The lexer reports before the parser does; the reader wants both in the order of the text.
  Diagnostics found;
  SyntaxTree tree = ParseState(source, file, limits, &found).Run();
  found.SortByPlace();
  diagnostics->Append(found);
  return tree;
}

}  // namespace tranos::interp
