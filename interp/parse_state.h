// SPDX-License-Identifier: GPL-3.0-or-later
// The parser: a recursive descent over flat tokens. Its functions return the node they made; after
// a mistake they return at once, `failed()` holds, and the statement's caller recovers.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "interp/lexer.h"
#include "interp/parser.h"

namespace tranos::interp {

class ParseState {
 public:
  ParseState(const SourceText& source, std::uint32_t file, const ParseLimits& limits,
             Diagnostics* diagnostics);
  SyntaxTree Run();

 private:
  // The children of a node under construction, in order.
  struct Children {
    NodeId first = kNoNode, last = kNoNode;
  };
  // Counts a level of nesting for as long as it lives.
  class Level {
   public:
    explicit Level(ParseState* state) : state_(state) { ++state_->depth_; }
    ~Level() { --state_->depth_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;

   private:
    ParseState* state_;
  };
  // The last plain number given to each setting that a plus is likely to be meant for.
  using Counters = std::array<double, 4>;

  // Tokens (parse_state.cpp).
  const Token& Now() const { return tokens_[at_]; }
  bool At(TokenKind kind) const { return tokens_[at_].kind == kind; }
  bool At(Keyword keyword) const { return tokens_[at_].keyword == keyword; }
  const Token& Next() const;  // the token after Now()
  bool AtKey() const { return At(TokenKind::kWord) && Next().kind == TokenKind::kAssign; }
  bool AtWord(std::string_view word) const;
  bool AtSeparator() const;
  bool AtStatementEnd() const;
  bool NowTouches() const { return at_ > 0 && tokens_[at_ - 1].end == Now().begin; }
  void Advance();
  void SkipNewlines();
  void SkipSeparators();
  bool Take(TokenKind kind);
  bool Take(Keyword keyword);
  bool Expect(TokenKind kind, std::string_view what);
  std::string_view TextOf(const Token& token) const;
  Span SpanOfToken(const Token& token) const { return {tree_.file, token.begin, token.end}; }
  void OpenBracket();
  bool CloseBracket(const Token& open, TokenKind close);

  // Nodes (parse_state.cpp).
  NodeId Make(NodeKind kind, std::uint32_t begin);
  NodeId MakeLeaf(NodeKind kind);  // of Now(), which is consumed
  void Append(Children* children, NodeId child);
  NodeId Finish(NodeId node, const Children& children);

  // Mistakes (parse_state.cpp).
  bool failed() const { return failed_; }
  void Report(Code code, Span span, std::string message, std::string label, std::string help);
  NodeId Fail(Code code, Span span, std::string message, std::string label, std::string help);
  NodeId FailHere(std::string_view expected, std::string help = "");
  bool EndsInPercent(const Token& token) const;
  NodeId FailTooDeep();
  NodeId FailUnclosed(const Token& open, std::string_view closing);
  Span SpanOfNow() const;
  std::string DescribeNow() const;
  std::string HelpForNow() const;
  void Recover(std::size_t statement_at, bool has_block);
  bool LineStartsStatement(std::size_t first) const;
  bool SkipInlineBraces();
  void SkipBalancedBraces();

  // Statements (parse_statement.cpp).
  void ParseStatements(Children* out);
  void ParseOneStatement(Children* out);
  NodeId ParseStatement();
  NodeId ParseKeywordStatement();
  NodeId ParseLet(NodeKind kind);
  NodeId ParseFunction();
  NodeId ParseInterface();
  NodeId ParseUnknown();
  NodeId ParseFor();
  NodeKind ParseForRange(Children* children);
  NodeId ParseIf();
  NodeId ParseGroup();
  NodeId ParseHypothesis();
  NodeId ParseUse();
  NodeId ParseAssert();
  NodeId ParseBlock();
  NodeId ParseCommand();

  bool ParseArgument(Children* out);
  NodeId ParseKeyIn();
  static std::optional<std::size_t> CounterOf(std::string_view key);
  void NoteCounter(const Token& key, NodeId value);
  std::string HelpWithPlus(const Token& number) const;
  NodeId ParseNaming();
  NodeId ParseName(std::string_view what);

  // Definitions (parse_definition.cpp).
  NodeId ParseDefine();
  NodeId ParseWords();
  void ParseHeader(Children* out);
  void RecoverHeader(std::size_t part_at);
  NodeId ParseParam();
  NodeId ParseType();
  NodeId ParseRange(bool many);
  NodeId ParseParameter();

  // Expressions (parse_expression.cpp).
  NodeId ParseExpr();
  NodeId ParseConditional();
  NodeId ParseLambda();
  NodeId ParseBinary(int least);
  NodeId ParseOperand(int least);
  NodeId ParsePrefix(Operator operation);
  NodeId ParseUnary();
  NodeId ParsePower();
  NodeId ParsePostfix();
  NodeId ParseMember(NodeId object);
  NodeId ParseCall(NodeId callee);
  NodeId ParseIndex(NodeId list);
  NodeId ParseAtom();
  NodeId ParseKeywordAtom();
  NodeId FailValue();
  NodeId ParseAfterPlus();
  NodeId ParseParen();
  NodeId ParseList();
  NodeId ParseString();
  NodeId ParseStringValue();
  NodeId ParsePlainString();
  void ParseValues(Children* out);
  NodeId MakeBinary(Operator operation, NodeId left, NodeId right);

  const SourceText& source_;
  int depth_limit_;
  Diagnostics* diagnostics_;
  std::vector<Token> tokens_;
  SyntaxTree tree_;
  std::size_t at_ = 0;
  int brackets_ = 0;            // open ( and [, in which newlines do not count
  std::uint32_t last_end_ = 0;  // of the token consumed last
  int depth_ = 0;
  bool failed_ = false;
  bool after_failed_ = false;  // the statement before this one failed: a following `else` was its
  bool end_reported_ = false;  // an unclosed brace is reported once
  std::optional<Token> key_;   // of the key-in whose first value is about to begin
  Counters counters_ = {1, 0, 0, 1};  // lv co lc wt
};

}  // namespace tranos::interp
