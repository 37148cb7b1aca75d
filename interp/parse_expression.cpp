// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <utility>

#include "interp/parse_state.h"

namespace tranos::interp {
namespace {

// How strongly the operators bind, weakest first. `not` stands between kAnd and kComparison.
enum Precedence : int { kOrs = 1, kAnds, kNots, kComparisons, kSpans, kSums, kProducts };

struct BinaryOperator {
  Operator operation;
  int precedence;
};

std::optional<BinaryOperator> BinaryOperatorOf(const Token& token) {
  switch (token.kind) {
    case TokenKind::kEqual:
      return {{Operator::kEqual, kComparisons}};
    case TokenKind::kNotEqual:
      return {{Operator::kNotEqual, kComparisons}};
    case TokenKind::kLess:
      return {{Operator::kLess, kComparisons}};
    case TokenKind::kLessEqual:
      return {{Operator::kLessEqual, kComparisons}};
    case TokenKind::kGreater:
      return {{Operator::kGreater, kComparisons}};
    case TokenKind::kGreaterEqual:
      return {{Operator::kGreaterEqual, kComparisons}};
    case TokenKind::kDotDot:
      return {{Operator::kRange, kSpans}};
    case TokenKind::kPlusMinus:
      return {{Operator::kPlusMinus, kSpans}};
    case TokenKind::kPlus:
      return {{Operator::kAdd, kSums}};
    case TokenKind::kMinus:
      return {{Operator::kSubtract, kSums}};
    case TokenKind::kStar:
      return {{Operator::kMultiply, kProducts}};
    case TokenKind::kSlash:
      return {{Operator::kDivide, kProducts}};
    case TokenKind::kPercent:
      return {{Operator::kModulo, kProducts}};
    default:
      break;
  }
  switch (token.keyword) {
    case Keyword::kOr:
      return {{Operator::kOr, kOrs}};
    case Keyword::kAnd:
      return {{Operator::kAnd, kAnds}};
    case Keyword::kWithin:
      return {{Operator::kWithin, kComparisons}};
    case Keyword::kConsistent:
      return {{Operator::kConsistent, kComparisons}};
    default:
      return std::nullopt;
  }
}

}  // namespace

NodeId ParseState::ParseExpr() {
  if (At(Keyword::kIf)) return ParseConditional();
  const bool is_name = At(TokenKind::kWord) && At(Keyword::kNone);
  if (is_name && Next().kind == TokenKind::kArrow) return ParseLambda();
  return ParseBinary(kOrs);
}

NodeId ParseState::ParseConditional() {
  if (depth_ >= depth_limit_) return FailTooDeep();
  const Level level(this);
  const NodeId node = Make(NodeKind::kConditional, Now().begin);
  Children parts;
  Advance();
  Append(&parts, ParseExpr());
  if (failed()) return kNoNode;
  if (!Take(Keyword::kThen)) return FailHere("`then`");
  SkipNewlines();
  Append(&parts, ParseExpr());
  if (failed()) return kNoNode;
  if (!Take(Keyword::kElse)) return FailHere("`else`", "a value needs both: if c then a else b");
  SkipNewlines();
  Append(&parts, ParseExpr());
  return Finish(node, parts);
}

NodeId ParseState::ParseLambda() {
  if (depth_ >= depth_limit_) return FailTooDeep();
  const Level level(this);
  const NodeId node = Make(NodeKind::kLambda, Now().begin);
  Children parts;
  Append(&parts, MakeLeaf(NodeKind::kName));
  Advance();  // =>
  SkipNewlines();
  Append(&parts, ParseExpr());
  return Finish(node, parts);
}

NodeId ParseState::MakeBinary(Operator operation, NodeId left, NodeId right) {
  const NodeId node = Make(NodeKind::kBinary, tree_.nodes[left].begin);
  tree_.nodes[node].detail = static_cast<std::uint8_t>(operation);
  Children parts;
  Append(&parts, left);
  Append(&parts, right);
  return Finish(node, parts);
}

// Operators of one precedence are a loop, so that a long sum costs no depth.
NodeId ParseState::ParseBinary(int least) {
  NodeId left = ParseOperand(least);
  int taken_alone = 0;  // the precedence of a comparison or span that has its two sides
  while (!failed()) {
    const auto found = BinaryOperatorOf(Now());
    if (!found || found->precedence < least || AtKey()) break;
    if (found->precedence == taken_alone) {
      if (taken_alone == kSpans) return FailHere("the end of the value");
      return Fail(Code::kChainedComparison, SpanOfToken(Now()), "comparisons do not chain",
                  "a second comparison", "write `a < b and b < c`");
    }
    if (found->precedence == kComparisons || found->precedence == kSpans) {
      taken_alone = found->precedence;
    }
    Advance();
    SkipNewlines();
    const NodeId right = ParseBinary(found->precedence + 1);
    if (failed()) break;
    left = MakeBinary(found->operation, left, right);
  }
  return failed() ? kNoNode : left;
}

NodeId ParseState::ParseOperand(int least) {
  if (At(Keyword::kNot) && !AtKey() && least <= kNots) return ParsePrefix(Operator::kNot);
  return ParseUnary();
}

NodeId ParseState::ParsePrefix(Operator operation) {
  if (depth_ >= depth_limit_) return FailTooDeep();
  const Level level(this);
  const NodeId node = Make(NodeKind::kUnary, Now().begin);
  tree_.nodes[node].detail = static_cast<std::uint8_t>(operation);
  Advance();
  Children operand;
  Append(&operand, operation == Operator::kNot ? ParseBinary(kNots) : ParseUnary());
  return failed() ? kNoNode : Finish(node, operand);
}

NodeId ParseState::ParseUnary() {
  if (At(TokenKind::kMinus)) return ParsePrefix(Operator::kNegate);
  if (At(TokenKind::kPlus)) return ParseAfterPlus();
  return ParsePower();
}

NodeId ParseState::ParseAfterPlus() {
  const Token plus = Now();
  while (At(TokenKind::kPlus)) Advance();
  Report(Code::kUnaryPlus, SpanOfToken(plus), "there is no unary plus", "remove the `+`",
         At(TokenKind::kNumber) ? HelpWithPlus(Now()) : "");
  return ParseUnary();
}

NodeId ParseState::ParsePower() {
  const NodeId base = ParsePostfix();
  if (failed() || !At(TokenKind::kCaret)) return base;
  if (depth_ >= depth_limit_) return FailTooDeep();
  const Level level(this);
  Advance();
  SkipNewlines();
  const NodeId exponent = ParseUnary();
  return failed() ? kNoNode : MakeBinary(Operator::kPower, base, exponent);
}

NodeId ParseState::ParsePostfix() {
  NodeId node = ParseAtom();
  while (!failed()) {
    if (At(TokenKind::kDot)) {
      node = ParseMember(node);
    } else if (At(TokenKind::kLeftParen) && NowTouches()) {
      node = ParseCall(node);
    } else if (At(TokenKind::kLeftBracket) && NowTouches()) {
      node = ParseIndex(node);
    } else {
      return node;
    }
  }
  return kNoNode;
}

NodeId ParseState::ParseMember(NodeId object) {
  const Token dot = Now();
  Advance();
  if (!At(TokenKind::kWord)) {
    const bool after_number = tree_.nodes[object].kind == NodeKind::kNumber;
    if (!after_number) return FailHere("the name of a member after `.`");
    return Fail(Code::kBadNumber, SpanOfToken(dot), "a number does not end in a point",
                "expected digits after it", "write the number without the point");
  }
  const NodeId node = Make(NodeKind::kMember, tree_.nodes[object].begin);
  Children parts;
  Append(&parts, object);
  Append(&parts, MakeLeaf(NodeKind::kName));
  return Finish(node, parts);
}

NodeId ParseState::ParseCall(NodeId callee) {
  if (depth_ >= depth_limit_) return FailTooDeep();
  const Level level(this);
  const NodeId node = Make(NodeKind::kCall, tree_.nodes[callee].begin);
  const Token open = Now();
  Children parts;
  Append(&parts, callee);
  OpenBracket();
  if (!At(TokenKind::kRightParen)) ParseValues(&parts);
  if (!CloseBracket(open, TokenKind::kRightParen)) return kNoNode;
  tree_.nodes[node].end = last_end_;
  return Finish(node, parts);
}

NodeId ParseState::ParseIndex(NodeId list) {
  if (depth_ >= depth_limit_) return FailTooDeep();
  const Level level(this);
  const NodeId node = Make(NodeKind::kIndex, tree_.nodes[list].begin);
  const Token open = Now();
  Children parts;
  Append(&parts, list);
  OpenBracket();
  Append(&parts, ParseExpr());
  if (!CloseBracket(open, TokenKind::kRightBracket)) return kNoNode;
  tree_.nodes[node].end = last_end_;
  return Finish(node, parts);
}

NodeId ParseState::ParseAtom() {
  key_.reset();
  switch (Now().kind) {
    case TokenKind::kNumber:
      return MakeLeaf(NodeKind::kNumber);
    case TokenKind::kQuoteOpen:
      return ParseString();
    case TokenKind::kWord:
      return At(Keyword::kNone) ? MakeLeaf(NodeKind::kName) : ParseKeywordAtom();
    case TokenKind::kLeftParen:
      return ParseParen();
    case TokenKind::kLeftBracket:
      return ParseList();
    case TokenKind::kDot:
      if (Next().kind != TokenKind::kNumber || Next().begin != Now().end) return FailValue();
      return Fail(Code::kBadNumber, {tree_.file, Now().begin, Next().end},
                  "a number begins with a digit", "", fmt::format("write `0.{}`", TextOf(Next())));
    default:
      return FailValue();
  }
}

// If a line ended where its value was to follow, that line is to blame and not the next.
NodeId ParseState::FailValue() {
  const bool line_ended = brackets_ == 0 && at_ > 0 && tokens_[at_ - 1].kind == TokenKind::kNewline;
  if (line_ended) --at_;
  FailHere("a value");
  if (line_ended) ++at_;
  return kNoNode;
}

NodeId ParseState::ParseKeywordAtom() {
  switch (Now().keyword) {
    case Keyword::kTrue:
      return MakeLeaf(NodeKind::kTrue);
    case Keyword::kFalse:
      return MakeLeaf(NodeKind::kFalse);
    case Keyword::kLast:
      return MakeLeaf(NodeKind::kLast);
    default:
      break;
  }
  // A keyword that could not go on here was meant as a name.
  const TokenKind next = Next().kind;
  const bool alone = next != TokenKind::kWord && next != TokenKind::kNumber &&
                     next != TokenKind::kQuoteOpen && !At(Keyword::kNot) && !At(Keyword::kIf);
  if (!alone) return FailValue();
  return Fail(Code::kKeywordAsName, SpanOfToken(Now()),
              fmt::format("`{}` is a keyword, and no value", TextOf(Now())), "expected a value",
              "");
}

NodeId ParseState::ParseParen() {
  if (depth_ >= depth_limit_) return FailTooDeep();
  const Level level(this);
  const Token open = Now();
  const NodeId node = Make(NodeKind::kParen, open.begin);
  Children inner;
  OpenBracket();
  Append(&inner, ParseExpr());
  if (!failed() && At(TokenKind::kComma)) {
    return FailHere("`)`", "a point or a list stands in square brackets: [1, 2, 3]");
  }
  if (!CloseBracket(open, TokenKind::kRightParen)) return kNoNode;
  tree_.nodes[node].end = last_end_;
  return Finish(node, inner);
}

NodeId ParseState::ParseList() {
  if (depth_ >= depth_limit_) return FailTooDeep();
  const Level level(this);
  const Token open = Now();
  const NodeId node = Make(NodeKind::kList, open.begin);
  Children items;
  OpenBracket();
  if (!At(TokenKind::kRightBracket)) ParseValues(&items);
  if (!CloseBracket(open, TokenKind::kRightBracket)) return kNoNode;
  tree_.nodes[node].end = last_end_;
  return Finish(node, items);
}

void ParseState::ParseValues(Children* out) {
  do {
    Append(out, ParseExpr());
    if (failed() || !Take(TokenKind::kComma)) return;
    SkipNewlines();
  } while (true);
}

NodeId ParseState::ParseString() {
  const NodeId node = Make(NodeKind::kString, Now().begin);
  Children parts;
  Advance();
  while (!failed()) {
    if (At(TokenKind::kStringText)) {
      Append(&parts, MakeLeaf(NodeKind::kStringText));
    } else if (At(TokenKind::kValueOpen)) {
      Append(&parts, ParseStringValue());
    } else {
      break;
    }
  }
  if (!Expect(TokenKind::kQuoteClose, "the end of the string")) return kNoNode;
  tree_.nodes[node].end = last_end_;
  return Finish(node, parts);
}

NodeId ParseState::ParseStringValue() {
  if (depth_ >= depth_limit_) return FailTooDeep();
  const Level level(this);
  const NodeId node = Make(NodeKind::kStringValue, Now().begin);
  Children inner;
  Advance();
  if (At(TokenKind::kValueClose)) {
    return FailHere("a value in the braces", "for a brace inside a string write {{ or }}");
  }
  Append(&inner, ParseExpr());
  if (!failed() && Take(TokenKind::kColon)) {
    const std::string_view digits = TextOf(Now());
    if (!At(TokenKind::kNumber)) return FailHere("the number of decimals, as in {x:2}");
    const bool plain = digits.find_first_not_of("0123456789") == digits.npos;
    if (!plain || digits.size() > 2 || NumberOf(digits).value > 17) {
      return Fail(Code::kBadNumber, SpanOfToken(Now()), "this is no number of decimals",
                  "expected a whole number from 0 to 17", "");
    }
    tree_.nodes[node].detail = static_cast<std::uint8_t>(1 + NumberOf(digits).value);
    Advance();
  }
  if (!Expect(TokenKind::kValueClose, "`}` or `:` and the number of decimals")) return kNoNode;
  tree_.nodes[node].end = last_end_;
  return Finish(node, inner);
}

NodeId ParseState::ParsePlainString() {
  if (!At(TokenKind::kQuoteOpen)) return FailHere("a string");
  const NodeId node = ParseString();
  if (failed()) return kNoNode;
  for (NodeId part = tree_[node].first_child; part != kNoNode; part = tree_[part].next) {
    if (tree_[part].kind != NodeKind::kStringValue) continue;
    Report(Code::kPlainString, tree_.SpanOf(part), "a plain string is needed here",
           "a value cannot be filled in", "for braces themselves write {{ and }}");
    break;
  }
  return node;
}

}  // namespace tranos::interp
