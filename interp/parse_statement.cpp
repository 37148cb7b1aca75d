// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interp/parse_state.h"

namespace tranos::interp {
namespace {

bool StartsBlockStatement(const Token& token) {
  switch (token.keyword) {
    case Keyword::kFor:
    case Keyword::kIf:
    case Keyword::kElse:
    case Keyword::kGroup:
    case Keyword::kHypothesis:
    case Keyword::kDefine:
      return true;
    default:
      return false;
  }
}

bool EndsInBlock(NodeKind kind) {
  switch (kind) {
    case NodeKind::kBlock:
    case NodeKind::kDefine:
    case NodeKind::kForCount:
    case NodeKind::kForEach:
    case NodeKind::kIf:
    case NodeKind::kGroup:
    case NodeKind::kHypothesis:
      return true;
    default:
      return false;
  }
}

}  // namespace

void ParseState::ParseStatements(Children* out) {
  SkipSeparators();
  while (!At(TokenKind::kEnd) && !At(TokenKind::kRightBrace)) {
    ParseOneStatement(out);
    SkipSeparators();
  }
}

void ParseState::ParseOneStatement(Children* out) {
  while (At(Keyword::kElse) && !AtKey()) {
    if (!after_failed_) FailHere("a statement");
    failed_ = false;
    after_failed_ = true;
    Advance();
    SkipNewlines();
    if (AtStatementEnd()) return;
  }
  const std::size_t statement_at = at_;
  const bool has_block = StartsBlockStatement(Now()) && !AtKey();
  const bool after_failed = after_failed_;
  const std::uint32_t begin = Now().begin;
  NodeId node = ParseStatement();
  if (!failed() && !EndsInBlock(tree_[node].kind) && !AtStatementEnd()) {
    FailHere("the end of the statement");
  }
  if (failed()) {
    Recover(statement_at, has_block);
    node = Make(NodeKind::kError, begin);
    tree_.nodes[node].end = std::max(begin, tokens_[at_ == 0 ? 0 : at_ - 1].end);
    after_failed_ = true;
  } else {
    // A block that follows a failed statement was its block.
    after_failed_ = after_failed && tree_[node].kind == NodeKind::kBlock;
  }
  Append(out, node);
}

NodeId ParseState::ParseStatement() {
  if (At(TokenKind::kLeftBrace)) return ParseBlock();
  if (!At(TokenKind::kWord)) return FailHere("a statement, which begins with a word");
  if (AtKey() || At(Keyword::kReset) || At(Keyword::kAs) || At(Keyword::kNone))
    return ParseCommand();
  return ParseKeywordStatement();
}

NodeId ParseState::ParseKeywordStatement() {
  switch (Now().keyword) {
    case Keyword::kLet:
      return ParseLet(NodeKind::kLet);
    case Keyword::kUnit:
      return ParseLet(NodeKind::kUnit);
    case Keyword::kFunction:
      return ParseFunction();
    case Keyword::kDefine:
      return ParseDefine();
    case Keyword::kParameter:
      return ParseParameter();
    case Keyword::kInterface:
      return ParseInterface();
    case Keyword::kUnknown:
      return ParseUnknown();
    case Keyword::kFor:
      return ParseFor();
    case Keyword::kIf:
      return ParseIf();
    case Keyword::kGroup:
      return ParseGroup();
    case Keyword::kHypothesis:
      return ParseHypothesis();
    case Keyword::kUse:
      return ParseUse();
    case Keyword::kAssert:
      return ParseAssert();
    default:
      return FailHere("a statement");
  }
}

NodeId ParseState::ParseName(std::string_view what) {
  if (failed()) return kNoNode;
  if (!At(TokenKind::kWord)) return FailHere(what);
  if (At(Keyword::kNone)) return MakeLeaf(NodeKind::kName);
  const std::string message = fmt::format("`{}` is a keyword and cannot be a name", TextOf(Now()));
  const Span span = SpanOfToken(Now());
  const TokenKind next = Next().kind;
  if (next == TokenKind::kWord || next == TokenKind::kNumber) {
    return Fail(Code::kKeywordAsName, span, message, fmt::format("expected {}", what), "");
  }
  Report(Code::kKeywordAsName, span, message, fmt::format("expected {}", what),
         fmt::format("choose another name, such as `{}_`", TextOf(Now())));
  return MakeLeaf(NodeKind::kName);
}

NodeId ParseState::ParseLet(NodeKind kind) {
  const NodeId node = Make(kind, Now().begin);
  Children parts;
  Advance();
  Append(&parts, ParseName("a name"));
  if (!Expect(TokenKind::kAssign, "`=` and a value")) return kNoNode;
  SkipNewlines();
  Append(&parts, ParseExpr());
  return Finish(node, parts);
}

NodeId ParseState::ParseFunction() {
  const NodeId node = Make(NodeKind::kFunction, Now().begin);
  Children parts;
  Advance();
  Append(&parts, ParseName("the function's name"));
  if (failed()) return kNoNode;
  if (!At(TokenKind::kLeftParen)) return FailHere("`(` and the arguments' names");
  const Token open = Now();
  const NodeId params = Make(NodeKind::kParams, open.begin);
  Children names;
  OpenBracket();
  if (!At(TokenKind::kRightParen)) {
    do {
      Append(&names, ParseName("an argument's name"));
    } while (!failed() && Take(TokenKind::kComma));
  }
  if (!CloseBracket(open, TokenKind::kRightParen)) return kNoNode;
  tree_.nodes[params].end = last_end_;
  Append(&parts, Finish(params, names));
  if (!Expect(TokenKind::kAssign, "`=` and an expression")) return kNoNode;
  SkipNewlines();
  Append(&parts, ParseExpr());
  return Finish(node, parts);
}

NodeId ParseState::ParseInterface() {
  const NodeId node = Make(NodeKind::kInterface, Now().begin);
  Children parts;
  Advance();
  Append(&parts, ParseName("the interface's name"));
  while (!failed() && AtKey()) Append(&parts, ParseKeyIn());
  if (!failed() && !AtStatementEnd()) {
    return FailHere("a key", "an interface is: interface NAME at=[…] axis=[…] measure=…");
  }
  return Finish(node, parts);
}

NodeId ParseState::ParseUnknown() {
  const NodeId node = Make(NodeKind::kUnknown, Now().begin);
  Children parts;
  Advance();
  Append(&parts, ParseName("the unknown's name"));
  if (!failed() && Take(TokenKind::kColon)) Append(&parts, ParseType());
  if (!Expect(TokenKind::kAssign, "`=` and a start value")) return kNoNode;
  SkipNewlines();
  Append(&parts, ParseExpr());
  if (!failed() && At(Keyword::kIn)) Append(&parts, ParseRange(false));
  return Finish(node, parts);
}

NodeId ParseState::ParseFor() {
  const NodeId node = Make(NodeKind::kForCount, Now().begin);
  Children parts;
  Advance();
  Append(&parts, ParseName("the name that counts"));
  if (failed()) return kNoNode;
  tree_.nodes[node].kind = ParseForRange(&parts);
  if (failed()) return kNoNode;
  Append(&parts, ParseBlock());
  return Finish(node, parts);
}

NodeKind ParseState::ParseForRange(Children* children) {
  if (!Take(TokenKind::kAssign)) {
    if (Take(TokenKind::kComma)) {
      SkipNewlines();
      Append(children, ParseName("the item's name"));
    }
    if (!failed() && !Take(Keyword::kIn)) FailHere("`= … to …` or `in` and a list");
    SkipNewlines();
    if (!failed()) Append(children, ParseExpr());
    return NodeKind::kForEach;
  }
  SkipNewlines();
  Append(children, ParseExpr());
  if (failed()) return NodeKind::kForCount;
  if (!AtWord("to")) {
    FailHere("`to` and the last value", "write `for i = 0 to 7`, or `for x in LIST`");
    return NodeKind::kForCount;
  }
  Advance();
  SkipNewlines();
  Append(children, ParseExpr());
  if (!failed() && AtWord("step")) {
    const NodeId step = Make(NodeKind::kStep, Now().begin);
    Children value;
    Advance();
    Append(&value, ParseExpr());
    Append(children, Finish(step, value));
  }
  return NodeKind::kForCount;
}

// A chain of `else if` is a loop, so that it costs no depth.
NodeId ParseState::ParseIf() {
  NodeId first = kNoNode;
  NodeId outer = kNoNode;
  Children outer_parts;
  while (true) {
    const NodeId node = Make(NodeKind::kIf, Now().begin);
    Children parts;
    Advance();
    Append(&parts, ParseExpr());
    if (!failed()) Append(&parts, ParseBlock());
    if (failed()) return kNoNode;
    Finish(node, parts);
    if (first == kNoNode) first = node;
    if (outer != kNoNode) Append(&outer_parts, node);
    outer = node;
    outer_parts = parts;
    if (!At(Keyword::kElse) || AtKey()) break;
    Advance();
    SkipNewlines();
    if (At(Keyword::kIf)) continue;
    Append(&outer_parts, ParseBlock());
    if (failed()) return kNoNode;
    break;
  }
  // All links of the chain end where its last block ends.
  for (NodeId node = first; node != kNoNode && tree_[node].kind == NodeKind::kIf;) {
    tree_.nodes[node].end = last_end_;
    const NodeId block = tree_[tree_[node].first_child].next;
    node = tree_[block].next;
  }
  return first;
}

NodeId ParseState::ParseGroup() {
  const NodeId node = Make(NodeKind::kGroup, Now().begin);
  Children parts;
  Advance();
  if (Take(Keyword::kAs)) Append(&parts, ParseName("the group's name"));
  if (failed()) return kNoNode;
  if (At(TokenKind::kWord)) return FailHere("`as` and a name, or a block in { }");
  Append(&parts, ParseBlock());
  return Finish(node, parts);
}

NodeId ParseState::ParseHypothesis() {
  const NodeId node = Make(NodeKind::kHypothesis, Now().begin);
  Children parts;
  Advance();
  Append(&parts, ParseName("the hypothesis's name"));
  if (!failed()) Append(&parts, ParseBlock());
  return Finish(node, parts);
}

NodeId ParseState::ParseUse() {
  const NodeId node = Make(NodeKind::kUse, Now().begin);
  Children parts;
  Advance();
  Append(&parts, ParsePlainString());
  return Finish(node, parts);
}

NodeId ParseState::ParseAssert() {
  const NodeId node = Make(NodeKind::kAssert, Now().begin);
  Children parts;
  Advance();
  Append(&parts, ParseExpr());
  if (!failed() && At(TokenKind::kQuoteOpen)) Append(&parts, ParseString());
  return Finish(node, parts);
}

NodeId ParseState::ParseBlock() {
  if (!At(TokenKind::kLeftBrace)) {
    const bool below = At(TokenKind::kNewline) && Next().kind == TokenKind::kLeftBrace;
    return FailHere("a block in { }", below ? "the `{` stands on the line of its statement" : "");
  }
  if (depth_ >= depth_limit_) {
    FailTooDeep();
    SkipBalancedBraces();
    return kNoNode;
  }
  const Level level(this);
  const Token open = Now();
  const NodeId node = Make(NodeKind::kBlock, open.begin);
  const Counters counters = counters_;
  Children statements;
  Advance();
  ParseStatements(&statements);
  if (!Take(TokenKind::kRightBrace) && !end_reported_) {
    FailUnclosed(open, "}");
    failed_ = false;
    end_reported_ = true;
  }
  counters_ = counters;
  tree_.nodes[node].end = last_end_;
  return Finish(node, statements);
}

NodeId ParseState::ParseCommand() {
  const bool is_command = At(Keyword::kNone) && !AtKey();
  const NodeId node = Make(is_command ? NodeKind::kCommand : NodeKind::kKeyIns, Now().begin);
  Children parts;
  while (ParseArgument(&parts)) {
  }
  return failed() ? kNoNode : Finish(node, parts);
}

bool ParseState::ParseArgument(Children* out) {
  if (failed()) return false;
  switch (Now().kind) {
    case TokenKind::kNumber:
      Append(out, MakeLeaf(NodeKind::kNumber));
      return true;
    case TokenKind::kQuoteOpen:
      Append(out, ParseString());
      return true;
    case TokenKind::kWord:
      break;
    default:
      return false;
  }
  if (Next().kind == TokenKind::kAssign) {
    Append(out, ParseKeyIn());
  } else if (At(Keyword::kReset)) {
    Append(out, MakeLeaf(NodeKind::kReset));
  } else if (At(Keyword::kAs)) {
    Append(out, ParseNaming());
  } else {
    Append(out, MakeLeaf(NodeKind::kWord));
  }
  return true;
}

NodeId ParseState::ParseKeyIn() {
  const NodeId node = Make(NodeKind::kKeyIn, Now().begin);
  const Token key = Now();
  Children parts;
  Append(&parts, MakeLeaf(NodeKind::kWord));
  Advance();  // =
  SkipNewlines();
  key_ = key;
  const NodeId word = parts.last;
  ParseValues(&parts);
  if (failed()) return kNoNode;
  const NodeId value = tree_[word].next;
  if (tree_[value].next == kNoNode) NoteCounter(key, value);
  return Finish(node, parts);
}

std::optional<std::size_t> ParseState::CounterOf(std::string_view key) {
  if (key == "lv") return 0;
  if (key == "co") return 1;
  if (key == "lc") return 2;
  if (key == "wt") return 3;
  return std::nullopt;
}

void ParseState::NoteCounter(const Token& key, NodeId value) {
  if (key.end - key.begin != 2 || tree_[value].kind != NodeKind::kNumber) return;
  const auto counter = CounterOf(TextOf(key));
  const NumberLiteral number = NumberOf(source_.Slice(tree_.SpanOf(value)));
  if (counter && number.unit.empty()) counters_[*counter] = number.value;
}

// `lv=+1` was meant either as a step up from the level before it or as the level itself.
std::string ParseState::HelpWithPlus(const Token& number) const {
  const std::string_view text = TextOf(number);
  if (!key_) return fmt::format("write `{}`", text);
  const std::string_view key = TextOf(*key_);
  const auto counter = CounterOf(key);
  const NumberLiteral literal = NumberOf(text);
  if (!counter || !literal.unit.empty()) return fmt::format("write `{}={}`", key, text);
  return fmt::format("write `{}={}` for {} more than the {} before it, or `{}={}`", key,
                     counters_[*counter] + literal.value, text, counters_[*counter], key, text);
}

NodeId ParseState::ParseNaming() {
  const NodeId node = Make(NodeKind::kNaming, Now().begin);
  Children parts;
  Advance();
  Append(&parts, ParseName("a name after `as`"));
  return failed() ? kNoNode : Finish(node, parts);
}

}  // namespace tranos::interp
