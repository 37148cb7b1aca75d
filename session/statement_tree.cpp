// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/statement_tree.h"

#include <algorithm>

#include "interp/lexer.h"
#include "interp/parser.h"
#include "interp/program.h"

namespace tranos::session {

namespace {

using interp::NodeId;
using interp::NodeKind;
using interp::TokenKind;

std::uint64_t Mix(std::uint64_t a, std::uint64_t b) {
  a ^= b + 0x9e3779b97f4a7c15 + (a << 6) + (a >> 2);
  a ^= a >> 31;
  return a * 0xbf58476d1ce4e5b9;
}
std::uint64_t HashText(std::string_view text, bool any_case) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : text) {
    const char low = any_case && c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    hash = (hash ^ static_cast<unsigned char>(low)) * 1099511628211u;
  }
  return hash;
}
std::string LowerCase(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

class TreeBuilder {
 public:
  TreeBuilder(const interp::Sources& sources, const interp::SyntaxTree& tree)
      : source_(sources.files[0]), tree_(tree) {
    interp::Diagnostics ignored;
    tokens_ = interp::Lex(source_, 0, &ignored).tokens;
  }

  StatementTree Build() {
    Add(Statement::kScript, kNoStatement, tree_[tree_.root], 0);
    Statements(tree_.root, 0);
    // Children come after their parents, so from the back each hash is made of those below.
    for (std::size_t i = out_.statements.size(); i-- > 0;) FinishHash(out_.statements[i]);
    std::sort(out_.places.begin(), out_.places.end());
    std::sort(out_.ends.begin(), out_.ends.end());
    return std::move(out_);
  }

 private:
  std::uint32_t Add(Statement::Kind kind, std::uint32_t parent, const interp::Node& node,
                    std::uint64_t head) {
    const auto id = static_cast<std::uint32_t>(out_.statements.size());
    Statement statement;
    statement.kind = kind;
    statement.head = Mix(kind, head);
    statement.parent = parent;
    statement.begin = node.begin;
    statement.end = node.end;
    if (parent != kNoStatement) {
      const Statement& around = out_.statements[parent];
      statement.loops = around.loops + (around.kind == Statement::kLoop ? 1 : 0);
      out_.statements[parent].children.push_back(id);
    }
    out_.statements.push_back(std::move(statement));
    out_.places.emplace_back(node.begin, id);
    return id;
  }
  void FinishHash(Statement& statement) {
    std::uint64_t hash = statement.head;
    for (const std::uint64_t item : statement.items) hash = Mix(hash, item);
    for (const std::uint32_t child : statement.children)
      hash = Mix(hash, out_.statements[child].hash);
    statement.hash = hash;
  }

  // The tokens in these bytes as one number; newlines say nothing.
  std::uint64_t HashTokens(std::uint32_t begin, std::uint32_t end,
                           std::vector<std::uint64_t>* each = nullptr) const {
    auto at = std::lower_bound(
        tokens_.begin(), tokens_.end(), begin,
        [](const interp::Token& token, std::uint32_t place) { return token.begin < place; });
    std::uint64_t hash = 0;
    for (; at != tokens_.end() && at->begin < end && at->kind != TokenKind::kEnd; ++at) {
      if (at->kind == TokenKind::kNewline) continue;
      const std::string_view text =
          std::string_view(source_.text).substr(at->begin, at->end - at->begin);
      const std::uint64_t token = Mix(static_cast<std::uint64_t>(at->kind),
                                      HashText(text, at->keyword != interp::Keyword::kNone));
      hash = Mix(hash, token);
      if (each) each->push_back(token);
    }
    return hash;
  }
  std::string_view TextOf(NodeId id) const {
    return std::string_view(source_.text).substr(tree_[id].begin, tree_[id].end - tree_[id].begin);
  }

  void Statements(NodeId block, std::uint32_t parent) {
    std::uint32_t active = kNoStatement;
    for (NodeId id = tree_[block].first_child; id != interp::kNoNode; id = tree_[id].next) {
      switch (tree_[id].kind) {
        case NodeKind::kCommand:
          active = Command(id, parent);
          break;
        case NodeKind::kKeyIns:
          Arguments(tree_[id].first_child, parent, &active);
          break;
        case NodeKind::kForCount:
        case NodeKind::kForEach:
          Block(Statement::kLoop, id, parent);
          break;
        case NodeKind::kIf:
          If(id, parent);
          break;
        case NodeKind::kBlock:
        case NodeKind::kGroup:
        case NodeKind::kHypothesis:
          Block(Statement::kBlock, id, parent);
          break;
        default: {
          const auto kind = static_cast<std::uint64_t>(tree_[id].kind);
          const NodeId name = tree_[id].first_child;
          const std::uint32_t made =
              Add(Statement::kOther, parent, tree_[id],
                  Mix(kind, name == interp::kNoNode ? 0 : HashText(TextOf(name), false)));
          HashTokens(tree_[id].begin, tree_[id].end, &out_.statements[made].items);
        }
      }
    }
  }

  std::uint32_t Command(NodeId id, std::uint32_t parent) {
    std::uint64_t words = 0;
    NodeId arg = tree_[id].first_child;
    for (; arg != interp::kNoNode && tree_[arg].kind == NodeKind::kWord; arg = tree_[arg].next) {
      words = Mix(words, HashText(TextOf(arg), true));
    }
    std::uint32_t command = Add(Statement::kCommand, parent, tree_[id], words);
    Arguments(arg, parent, &command);
    return command;
  }

  // Settings are statements of their own; everything else answers the active command.
  void Arguments(NodeId arg, std::uint32_t parent, std::uint32_t* active) {
    for (; arg != interp::kNoNode; arg = tree_[arg].next) {
      const interp::Node& node = tree_[arg];
      if (node.kind == NodeKind::kKeyIn) {
        const std::string key = LowerCase(TextOf(node.first_child));
        const std::uint64_t head = HashText(key, false);
        if (interp::FindSetting(key)) {
          const std::uint32_t setting = Add(Statement::kSetting, parent, node, head);
          out_.statements[setting].items.push_back(
              HashTokens(tree_[node.first_child].end, node.end));
          continue;
        }
        Answer(node, parent, active);
        // The key counts apart from its value, so that a changed value leaves some likeness.
        out_.statements[*active].items.push_back(
            Mix(head, HashTokens(tree_[node.first_child].end, node.end)));
        out_.statements[*active].items.push_back(head);
        continue;
      }
      Answer(node, parent, active);
      out_.statements[*active].items.push_back(HashTokens(node.begin, node.end));
    }
  }
  void Answer(const interp::Node& node, std::uint32_t parent, std::uint32_t* active) {
    if (*active == kNoStatement) *active = Add(Statement::kAnswers, parent, node, 0);
    out_.places.emplace_back(node.begin, *active);
  }

  void Block(Statement::Kind kind, NodeId id, std::uint32_t parent) {
    const interp::Node& node = tree_[id];
    const std::uint32_t made = Add(kind, parent, node, static_cast<std::uint64_t>(node.kind));
    NodeId block = node.kind == NodeKind::kBlock ? id : interp::kNoNode;
    for (NodeId child = node.first_child; block == interp::kNoNode && child != interp::kNoNode;
         child = tree_[child].next) {
      if (tree_[child].kind == NodeKind::kBlock) block = child;
    }
    if (block == interp::kNoNode) return;
    HashTokens(node.begin, tree_[block].begin, &out_.statements[made].items);
    out_.ends.emplace_back(tree_[block].end - 1, made);
    Statements(block, made);
  }

  // The condition, then a block for each branch.
  void If(NodeId id, std::uint32_t parent) {
    const interp::Node& node = tree_[id];
    const std::uint32_t made =
        Add(Statement::kBlock, parent, node, static_cast<std::uint64_t>(node.kind));
    const NodeId condition = node.first_child;
    if (condition == interp::kNoNode) return;
    HashTokens(tree_[condition].begin, tree_[condition].end, &out_.statements[made].items);
    for (NodeId branch = tree_[condition].next; branch != interp::kNoNode;
         branch = tree_[branch].next) {
      if (tree_[branch].kind == NodeKind::kIf) If(branch, made);
      if (tree_[branch].kind == NodeKind::kBlock) Block(Statement::kBlock, branch, made);
    }
  }

  const interp::SourceText& source_;
  const interp::SyntaxTree& tree_;
  std::vector<interp::Token> tokens_;
  StatementTree out_;
};

}  // namespace

std::uint32_t StatementTree::At(std::uint32_t offset) const {
  const auto after =
      std::upper_bound(places.begin(), places.end(), std::pair{offset, kNoStatement});
  return after == places.begin() ? 0 : std::prev(after)->second;
}

std::uint32_t StatementTree::EndingAt(std::uint32_t brace) const {
  const auto found = std::lower_bound(ends.begin(), ends.end(), std::pair{brace, std::uint32_t{0}});
  return found != ends.end() && found->first == brace ? found->second : 0;
}

std::vector<std::uint32_t> StatementTree::LoopsAround(std::uint32_t statement) const {
  std::vector<std::uint32_t> loops;
  for (std::uint32_t at = statements[statement].parent; at != kNoStatement;
       at = statements[at].parent) {
    if (statements[at].kind == Statement::kLoop) loops.push_back(at);
  }
  std::reverse(loops.begin(), loops.end());
  return loops;
}

StatementTree MakeStatementTree(const interp::Sources& sources, int depth) {
  interp::Diagnostics ignored;
  const interp::SyntaxTree tree = interp::Parse(sources, 0, {depth}, &ignored);
  return TreeBuilder(sources, tree).Build();
}

}  // namespace tranos::session
