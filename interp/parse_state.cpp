// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/parse_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tranos::interp {
namespace {

// However far the user raises the limit, the stack of a sanitized build holds this much.
constexpr int kDeepest = 1000;

bool EndsOperand(TokenKind kind) {
  return kind == TokenKind::kWord || kind == TokenKind::kNumber || kind == TokenKind::kQuoteClose ||
         kind == TokenKind::kRightParen || kind == TokenKind::kRightBracket;
}

bool IsBinarySymbol(TokenKind kind) {
  return kind == TokenKind::kDotDot || (kind >= TokenKind::kEqual && kind <= TokenKind::kPercent);
}

}  // namespace

ParseState::ParseState(const SourceText& source, std::uint32_t file, const ParseLimits& limits,
                       Diagnostics* diagnostics)
    : source_(source), depth_limit_(std::min(limits.depth, kDeepest)), diagnostics_(diagnostics) {
  tree_.file = file;
  Lexed lexed = Lex(source, file, diagnostics);
  tokens_ = std::move(lexed.tokens);
  tree_.comments = std::move(lexed.comments);
  tree_.nodes.reserve(tokens_.size());  // seldom too small; unwritten pages cost nothing
}

SyntaxTree ParseState::Run() {
  tree_.root = Make(NodeKind::kScript, 0);
  Children statements;
  while (!At(TokenKind::kEnd)) {
    ParseStatements(&statements);
    if (!At(TokenKind::kRightBrace)) continue;
    Report(Code::kUnexpectedToken, SpanOfToken(Now()), "a `}` without its `{`", "",
           "remove it, or open the block it is to close");
    Advance();
  }
  Finish(tree_.root, statements);
  tree_.nodes[tree_.root].end = static_cast<std::uint32_t>(source_.text.size());
  return std::move(tree_);
}

// --- Tokens ---

const Token& ParseState::Next() const {
  std::size_t next = std::min(at_ + 1, tokens_.size() - 1);
  while (brackets_ > 0 && tokens_[next].kind == TokenKind::kNewline) ++next;
  return tokens_[next];
}

bool ParseState::AtWord(std::string_view word) const {
  if (!At(TokenKind::kWord) || Now().end - Now().begin != word.size()) return false;
  const std::string_view text = TextOf(Now());
  return std::equal(text.begin(), text.end(), word.begin(), [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
  });
}

bool ParseState::AtSeparator() const {
  return At(TokenKind::kNewline) || At(TokenKind::kSemicolon) || At(TokenKind::kBar);
}

bool ParseState::AtStatementEnd() const {
  return AtSeparator() || At(TokenKind::kRightBrace) || At(TokenKind::kEnd);
}

void ParseState::Advance() {
  last_end_ = Now().end;
  if (!At(TokenKind::kEnd)) ++at_;
  if (brackets_ > 0) SkipNewlines();
}

void ParseState::SkipNewlines() {
  while (At(TokenKind::kNewline)) ++at_;
}

void ParseState::SkipSeparators() {
  while (AtSeparator()) ++at_;
}

bool ParseState::Take(TokenKind kind) {
  if (!At(kind)) return false;
  Advance();
  return true;
}

bool ParseState::Take(Keyword keyword) {
  if (!At(keyword)) return false;
  Advance();
  return true;
}

bool ParseState::Expect(TokenKind kind, std::string_view what) {
  if (failed()) return false;
  if (Take(kind)) return true;
  FailHere(what);
  return false;
}

std::string_view ParseState::TextOf(const Token& token) const {
  return std::string_view(source_.text).substr(token.begin, token.end - token.begin);
}

void ParseState::OpenBracket() {
  ++brackets_;
  Advance();
}

bool ParseState::CloseBracket(const Token& open, TokenKind close) {
  if (failed()) return false;
  if (At(close)) {
    --brackets_;
    Advance();
    return true;
  }
  const std::string_view closing = close == TokenKind::kRightParen ? ")" : "]";
  // A line that goes on without a comma or an operator shows that the bracket was forgotten.
  const bool forgotten =
      AtStatementEnd() || At(TokenKind::kLeftBrace) || tokens_[at_ - 1].kind == TokenKind::kNewline;
  if (!forgotten) {
    FailHere(fmt::format("`,` or `{}`", closing));
    return false;
  }
  FailUnclosed(open, closing);
  return false;
}

// --- Nodes ---

NodeId ParseState::Make(NodeKind kind, std::uint32_t begin) {
  Node node{kind};
  node.begin = begin;
  node.end = begin;
  tree_.nodes.push_back(node);
  return static_cast<NodeId>(tree_.nodes.size() - 1);
}

NodeId ParseState::MakeLeaf(NodeKind kind) {
  const NodeId node = Make(kind, Now().begin);
  tree_.nodes[node].end = Now().end;
  Advance();
  return node;
}

void ParseState::Append(Children* children, NodeId child) {
  if (child == kNoNode) return;
  if (children->first == kNoNode) {
    children->first = child;
  } else {
    tree_.nodes[children->last].next = child;
  }
  children->last = child;
}

NodeId ParseState::Finish(NodeId node, const Children& children) {
  Node& made = tree_.nodes[node];
  made.first_child = children.first;
  if (children.last != kNoNode) made.end = std::max(made.end, tree_.nodes[children.last].end);
  return node;
}

// --- Mistakes ---

void ParseState::Report(Code code, Span span, std::string message, std::string label,
                        std::string help) {
  diagnostics_->Add({code, span, std::move(message), std::move(label), std::move(help)});
}

NodeId ParseState::Fail(Code code, Span span, std::string message, std::string label,
                        std::string help) {
  if (!failed_) Report(code, span, std::move(message), std::move(label), std::move(help));
  failed_ = true;
  return kNoNode;
}

Span ParseState::SpanOfNow() const {
  if (!At(TokenKind::kEnd) && !At(TokenKind::kNewline)) return SpanOfToken(Now());
  // The end of a line is shown behind what stands on it.
  std::size_t last = at_;
  while (last > 0 && (tokens_[last].kind == TokenKind::kNewline || last == at_)) --last;
  const std::uint32_t place = last == at_ ? Now().begin : tokens_[last].end;
  return {tree_.file, place, place};
}

NodeId ParseState::FailHere(std::string_view expected, std::string help) {
  if (failed_ || At(TokenKind::kBad)) {
    failed_ = true;
    return kNoNode;
  }
  const bool opens = At(TokenKind::kLeftParen) || At(TokenKind::kLeftBracket);
  if (opens && at_ > 0 && EndsOperand(tokens_[at_ - 1].kind) && !NowTouches()) {
    const std::string bracket(TextOf(Now()));
    return Fail(Code::kMustTouch, SpanOfToken(Now()),
                fmt::format("the `{}` does not touch what is before it", bracket),
                "calls and indices touch: f(1), list[0]",
                fmt::format("write `{}{}…`", TextOf(tokens_[at_ - 1]), bracket));
  }
  if (at_ > 0 && EndsInPercent(tokens_[at_ - 1]) &&
      (EndsOperand(Now().kind) || opens || At(TokenKind::kQuoteOpen))) {
    return Fail(Code::kPercentOrRemainder, SpanOfNow(), DescribeNow() + " after a per cent", "",
                "`%` that touches the number before it is per cent; the remainder is `5 % 3`");
  }
  if (help.empty()) help = HelpForNow();
  return Fail(Code::kUnexpectedToken, SpanOfNow(), DescribeNow(),
              fmt::format("expected {}", expected), std::move(help));
}

bool ParseState::EndsInPercent(const Token& token) const {
  return token.kind == TokenKind::kNumber && TextOf(token).ends_with('%');
}

NodeId ParseState::FailTooDeep() {
  return Fail(Code::kTooDeep, SpanOfToken(Now()),
              fmt::format("syntax is nested deeper than {} levels", depth_limit_),
              "this is one level too many", "bind the inner part to a name with `let`");
}

NodeId ParseState::FailUnclosed(const Token& open, std::string_view closing) {
  if (!failed_ && !At(TokenKind::kBad)) {
    diagnostics_->Add({Code::kUnclosedBracket,
                       SpanOfNow(),
                       fmt::format("the `{}` is not closed", TextOf(open)),
                       fmt::format("expected `{}`", closing),
                       "",
                       {{SpanOfToken(open), "opened here"}}});
  }
  failed_ = true;
  return kNoNode;
}

std::string ParseState::DescribeNow() const {
  if (At(TokenKind::kEnd)) return "the file ends too early";
  if (At(TokenKind::kNewline)) return "the line ends too early";
  if (At(TokenKind::kQuoteOpen)) return "a string cannot stand here";
  return fmt::format("`{}` cannot stand here", TextOf(Now()).substr(0, 60));
}

std::string ParseState::HelpForNow() const {
  const bool starts_line = at_ == 0 || tokens_[at_ - 1].kind == TokenKind::kNewline;
  if (At(Keyword::kThen)) return "`if` first in a statement takes a block: if … { … }";
  if (TextOf(Now()) == "to") return "`for i = 1 to 3` counts; `for x in LIST` goes through a list";
  if (At(Keyword::kElse)) return "`else` stands on the line of the `}`";
  if (At(Keyword::kNot) || At(Keyword::kIf)) return "put that part in parentheses";
  switch (Now().kind) {
    case TokenKind::kComma:
      return "a point is given by its key: xy=1,2,3; a list is written in brackets: [1, 2]";
    case TokenKind::kDotDot:
    case TokenKind::kPlusMinus:
      return "put one of the two in parentheses";
    case TokenKind::kAssign:
    case TokenKind::kEqual:
      return "`==` compares; a single `=` gives a value to a key or a name";
    case TokenKind::kLeftBrace:
      return "this statement takes no block";
    case TokenKind::kLeftParen:
      return "a command is given its values by keys: key=…";
    default:
      break;
  }
  if (!IsBinarySymbol(Now().kind)) return "";
  if (starts_line) return "a line goes on in the next one if it ends in the operator";
  return "an expression stands after a key: key=…";
}

bool ParseState::LineStartsStatement(std::size_t first) const {
  const Token& token = tokens_[first];
  if (token.kind == TokenKind::kEnd || token.kind == TokenKind::kRightBrace) return true;
  if (token.kind != TokenKind::kWord) return false;
  const TokenKind next = tokens_[first + 1].kind;
  return next == TokenKind::kWord || next == TokenKind::kAssign;
}

void ParseState::Recover(std::size_t statement_at, bool has_block) {
  failed_ = false;
  if (at_ > statement_at + 1 && tokens_[at_ - 1].kind == TokenKind::kNewline) --at_;
  while (!At(TokenKind::kEnd) && !At(TokenKind::kRightBrace)) {
    if (At(TokenKind::kSemicolon) || At(TokenKind::kBar)) break;
    if (At(TokenKind::kNewline) && (brackets_ == 0 || LineStartsStatement(at_ + 1))) break;
    if (At(TokenKind::kLeftBrace)) {
      if (has_block || !SkipInlineBraces()) break;
      continue;
    }
    if (At(TokenKind::kLeftParen) || At(TokenKind::kLeftBracket)) ++brackets_;
    const bool closes = At(TokenKind::kRightParen) || At(TokenKind::kRightBracket);
    if (closes && brackets_ > 0) --brackets_;
    ++at_;
  }
  brackets_ = 0;
}

bool ParseState::SkipInlineBraces() {
  int open = 0;
  for (std::size_t i = at_;; ++i) {
    const TokenKind kind = tokens_[i].kind;
    if (kind == TokenKind::kNewline || kind == TokenKind::kEnd) return false;
    if (kind == TokenKind::kLeftBrace) ++open;
    if (kind == TokenKind::kRightBrace && --open == 0) {
      at_ = i + 1;
      return true;
    }
  }
}

void ParseState::SkipBalancedBraces() {
  int open = 0;
  for (; !At(TokenKind::kEnd); ++at_) {
    if (At(TokenKind::kLeftBrace)) ++open;
    if (At(TokenKind::kRightBrace) && --open == 0) {
      ++at_;
      return;
    }
  }
  end_reported_ = true;
}

}  // namespace tranos::interp
