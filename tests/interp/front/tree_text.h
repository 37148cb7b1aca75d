// SPDX-License-Identifier: GPL-3.0-or-later
// A syntax tree as one line of text, for comparing.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interp/diagnostic.h"
#include "interp/parser.h"

namespace tranos::interp {

// A text and what became of it.
struct Parsed {
  Sources sources;
  Diagnostics diagnostics;
  SyntaxTree tree;
};

inline Parsed ParseText(std::string text, const ParseLimits& limits = {}) {
  Parsed parsed;
  parsed.sources.files.push_back(MakeSource("a.trn", std::move(text)));
  parsed.tree = Parse(parsed.sources, 0, limits, &parsed.diagnostics);
  return parsed;
}

inline std::string_view NameOf(NodeKind kind) {
  constexpr std::string_view kNames[] = {
      "Script",     "Block",     "Let",         "Unit",     "Function",   "Define",      "Param",
      "Interface",  "Parameter", "Unknown",     "ForCount", "ForEach",    "If",          "Group",
      "Hypothesis", "Use",       "Assert",      "Command",  "KeyIns",     "Words",       "Params",
      "Type",       "Default",   "Range",       "Step",     "KeyIn",      "Reset",       "Naming",
      "Word",       "Name",      "Conditional", "Lambda",   "Binary",     "Unary",       "Member",
      "Call",       "Index",     "Number",      "String",   "StringText", "StringValue", "True",
      "False",      "Last",      "Paren",       "List",     "Error"};
  return kNames[static_cast<std::size_t>(kind)];
}

inline std::string_view NameOf(Operator operation) {
  constexpr std::string_view kNames[] = {
      "or",         "and", "not", "==", "!=", "<", "<=", ">", ">=",  "within",
      "consistent", "..",  "+-",  "+",  "-",  "*", "/",  "%", "neg", "^"};
  return kNames[static_cast<std::size_t>(operation)];
}

inline std::string Head(const Parsed& parsed, NodeId id) {
  const Node& node = parsed.tree[id];
  const std::string text(parsed.sources.Slice(parsed.tree.SpanOf(id)));
  switch (node.kind) {
    case NodeKind::kBinary:
    case NodeKind::kUnary:
      return std::string(NameOf(static_cast<Operator>(node.detail)));
    case NodeKind::kWord:
      return text + ":";
    case NodeKind::kName:
    case NodeKind::kNumber:
      return text;
    case NodeKind::kStringText:
      return "'" + text + "'";
    case NodeKind::kStringValue:
    case NodeKind::kType:
      return std::string(NameOf(node.kind)) + std::to_string(node.detail);
    default:
      return std::string(NameOf(node.kind));
  }
}

// Everything but the places: (Let x (+ 1 2)). Walks without recursion: a sum may be long.
inline std::string TreeText(const Parsed& parsed) {
  std::string out;
  std::vector<NodeId> open = {parsed.tree.root};
  const auto begin = [&](NodeId id) {
    const bool has_children = parsed.tree[id].first_child != kNoNode;
    out += (has_children ? "(" : "") + Head(parsed, id);
    return has_children;
  };
  if (!begin(parsed.tree.root)) return out;
  NodeId next = parsed.tree[parsed.tree.root].first_child;
  while (!open.empty()) {
    if (next == kNoNode) {
      out += ")";
      next = parsed.tree[open.back()].next;
      open.pop_back();
      continue;
    }
    out += " ";
    if (begin(next)) {
      open.push_back(next);
      next = parsed.tree[next].first_child;
    } else {
      next = parsed.tree[next].next;
    }
  }
  return out;
}

// The comments, without the blanks at their ends.
inline std::vector<std::string> CommentsOf(const Parsed& parsed) {
  std::vector<std::string> out;
  for (const Comment& comment : parsed.tree.comments) {
    std::string text(parsed.sources.Slice({0, comment.begin, comment.end}));
    text.erase(text.find_last_not_of(" \t") + 1);
    out.push_back(std::move(text));
  }
  return out;
}

}  // namespace tranos::interp
