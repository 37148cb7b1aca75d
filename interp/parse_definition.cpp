// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "interp/parse_state.h"

namespace tranos::interp {

NodeId ParseState::ParseDefine() {
  const NodeId node = Make(NodeKind::kDefine, Now().begin);
  Children parts;
  Advance();
  const std::size_t words_at = at_;
  Append(&parts, ParseWords());
  if (failed()) RecoverHeader(words_at);
  ParseHeader(&parts);
  if (failed()) return kNoNode;
  Append(&parts, ParseBlock());
  return Finish(node, parts);
}

NodeId ParseState::ParseWords() {
  const NodeId node = Make(NodeKind::kWords, Now().begin);
  Children names;
  do {
    Append(&names, ParseName("the words of the new command"));
  } while (!failed() && At(TokenKind::kWord) && Next().kind != TokenKind::kColon);
  return failed() ? kNoNode : Finish(node, names);
}

// What stands between the words and the block. A mistake in one parameter spoils only its line.
void ParseState::ParseHeader(Children* out) {
  SkipSeparators();
  if (At(TokenKind::kQuoteOpen)) {
    const std::size_t string_at = at_;
    Append(out, ParsePlainString());
    if (failed()) RecoverHeader(string_at);
    SkipSeparators();
  }
  while (At(TokenKind::kWord)) {
    const std::size_t param_at = at_;
    Append(out, ParseParam());
    const bool ends = AtSeparator() || At(TokenKind::kLeftBrace) || At(TokenKind::kWord);
    if (!failed() && !ends) FailHere("the end of the parameter");
    if (failed()) RecoverHeader(param_at);
    SkipSeparators();
  }
  if (!At(TokenKind::kLeftBrace)) {
    FailHere("a parameter, or the definition's block in { }",
             "a parameter is: name : type = value in range \"description\"");
  }
}

void ParseState::RecoverHeader(std::size_t part_at) {
  failed_ = false;
  brackets_ = 0;
  if (at_ > part_at + 1 && tokens_[at_ - 1].kind == TokenKind::kNewline) --at_;
  while (!AtStatementEnd() && !At(TokenKind::kLeftBrace)) ++at_;
}

NodeId ParseState::ParseParam() {
  const NodeId node = Make(NodeKind::kParam, Now().begin);
  Children parts;
  Append(&parts, ParseName("a parameter's name"));
  if (!Expect(TokenKind::kColon, "`:` and the parameter's type")) return kNoNode;
  Append(&parts, ParseType());
  if (!failed() && At(TokenKind::kAssign)) {
    const NodeId standard = Make(NodeKind::kDefault, Now().begin);
    Children value;
    Advance();
    SkipNewlines();
    Append(&value, ParseExpr());
    Append(&parts, Finish(standard, value));
  }
  if (!failed() && At(Keyword::kIn)) Append(&parts, ParseRange(true));
  if (!failed() && At(TokenKind::kQuoteOpen)) Append(&parts, ParsePlainString());
  return failed() ? kNoNode : Finish(node, parts);
}

NodeId ParseState::ParseType() {
  const NodeId node = Make(NodeKind::kType, Now().begin);
  Children name;
  if (AtWord("list") && Next().kind == TokenKind::kWord) {
    Advance();
    if (!AtWord("of")) return FailHere("`of` and the type of the list's items");
    Advance();
    tree_.nodes[node].detail = 1;
  }
  Append(&name, ParseName("a type, such as length"));
  return failed() ? kNoNode : Finish(node, name);
}

NodeId ParseState::ParseRange(bool many) {
  const NodeId node = Make(NodeKind::kRange, Now().begin);
  Children values;
  Advance();
  SkipNewlines();
  if (many) {
    ParseValues(&values);
  } else {
    Append(&values, ParseExpr());
  }
  return failed() ? kNoNode : Finish(node, values);
}

NodeId ParseState::ParseParameter() {
  const NodeId node = Make(NodeKind::kParameter, Now().begin);
  Children parts;
  Advance();
  Append(&parts, ParseParam());
  return failed() ? kNoNode : Finish(node, parts);
}

}  // namespace tranos::interp
