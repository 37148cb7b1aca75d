// SPDX-License-Identifier: GPL-3.0-or-later
// The words of a script, twelve bytes each. They live only while a file is parsed or formatted.
#pragma once

#include <cstdint>

namespace tranos::interp {

enum class TokenKind : std::uint8_t {
  kEnd,
  kNewline,
  kSemicolon,
  kBar,
  kWord,
  kNumber,  // with the unit or % that touches it
  kQuoteOpen,
  kStringText,
  kValueOpen,   // { inside a string
  kValueClose,  // } inside a string
  kQuoteClose,
  kLeftParen,
  kRightParen,
  kLeftBracket,
  kRightBracket,
  kLeftBrace,
  kRightBrace,
  kComma,
  kDot,
  kDotDot,
  kColon,
  kAssign,
  kArrow,
  kEqual,
  kNotEqual,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kPlus,
  kPlusMinus,
  kMinus,
  kStar,
  kSlash,
  kCaret,
  kPercent,
  kBad,  // already reported; the parser gives up the statement without a word
};

enum class Keyword : std::uint8_t {
  kNone,
  kIf,
  kOr,
  kIn,
  kAs,
  kLet,
  kFor,
  kUse,
  kAnd,
  kNot,
  kUnit,
  kThen,
  kElse,
  kTrue,
  kLast,
  kGroup,
  kFalse,
  kReset,
  kDefine,
  kAssert,
  kWithin,
  kUnknown,
  kFunction,
  kParameter,
  kInterface,
  kHypothesis,
  kConsistent,
};

struct Token {
  std::uint32_t begin = 0, end = 0;  // bytes of the file
  TokenKind kind = TokenKind::kEnd;
  Keyword keyword = Keyword::kNone;  // of a kWord
};
static_assert(sizeof(Token) == 12);

}  // namespace tranos::interp
