// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/format_roles.h"

#include <algorithm>

namespace tranos::interp {
namespace {

class RoleFinder {
 public:
  RoleFinder(const SyntaxTree& tree, const std::vector<Token>& tokens)
      : tree_(tree), tokens_(tokens), roles_(tokens.size(), kPlainRole) {}

  std::vector<std::uint8_t> Run() {
    for (NodeId id = 0; id < tree_.nodes.size(); ++id) Visit(id);
    return std::move(roles_);
  }

 private:
  std::size_t FirstTokenFrom(std::uint32_t offset) const {
    const auto found =
        std::lower_bound(tokens_.begin(), tokens_.end(), offset,
                         [](const Token& token, std::uint32_t at) { return token.begin < at; });
    return static_cast<std::size_t>(found - tokens_.begin());
  }

  void Mark(std::uint32_t begin, std::uint32_t end, TokenRole role) {
    for (std::size_t i = FirstTokenFrom(begin); i < tokens_.size() && tokens_[i].begin < end; ++i) {
      roles_[i] |= role;
    }
  }

  void MarkOne(std::uint32_t offset, TokenRole role) {
    std::size_t i = FirstTokenFrom(offset);
    while (tokens_[i].kind == TokenKind::kNewline) ++i;
    roles_[i] |= role;
  }

  // Where a statement's own text ends: before its first block.
  std::uint32_t HeadEnd(const Node& node) const {
    for (NodeId c = node.first_child; c != kNoNode; c = tree_[c].next) {
      if (tree_[c].kind == NodeKind::kBlock) return tree_[c].begin;
    }
    return node.end;
  }

  bool IsSum(NodeId id) const {
    const Node& node = tree_[id];
    const auto operation = static_cast<Operator>(node.detail);
    return node.kind == NodeKind::kBinary &&
           (operation == Operator::kAdd || operation == Operator::kSubtract);
  }

  void VisitBinary(const Node& node) {
    const NodeId left = node.first_child;
    if (static_cast<Operator>(node.detail) != Operator::kRange) return;
    if (IsSum(left) || IsSum(tree_[left].next)) MarkOne(tree_[left].end, kWideRange);
  }

  void Visit(NodeId id) {
    const Node& node = tree_[id];
    switch (node.kind) {
      case NodeKind::kLet:
      case NodeKind::kUnit:
      case NodeKind::kFunction:
      case NodeKind::kParam:
      case NodeKind::kInterface:
      case NodeKind::kParameter:
      case NodeKind::kUnknown:
      case NodeKind::kUse:
      case NodeKind::kAssert:
      case NodeKind::kCommand:
      case NodeKind::kKeyIns:
      case NodeKind::kForCount:
      case NodeKind::kForEach:
      case NodeKind::kIf:
      case NodeKind::kGroup:
      case NodeKind::kHypothesis:
        Mark(node.begin, HeadEnd(node), kContinuation);
        break;
      case NodeKind::kDefine:
        Mark(tree_[node.first_child].end, HeadEnd(node), kHeader);
        break;
      case NodeKind::kKeyIn:
        Mark(node.begin, node.end, kInKeyIn);
        MarkOne(tree_[node.first_child].end, kKeyAssign);
        break;
      case NodeKind::kUnary:
        if (static_cast<Operator>(node.detail) == Operator::kNegate) MarkOne(node.begin, kNegation);
        break;
      case NodeKind::kBinary:
        VisitBinary(node);
        break;
      default:
        break;
    }
  }

  const SyntaxTree& tree_;
  const std::vector<Token>& tokens_;
  std::vector<std::uint8_t> roles_;
};

}  // namespace

std::vector<std::uint8_t> RolesOf(const SyntaxTree& tree, const std::vector<Token>& tokens) {
  return RoleFinder(tree, tokens).Run();
}

}  // namespace tranos::interp
