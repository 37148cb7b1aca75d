// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/lexer.h"

#include <fmt/format.h>
#include <utf8proc.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>

namespace tranos::interp {
namespace {

enum CharClass : std::uint8_t { kLetter = 1, kDigit = 2, kPlainInString = 4, kPlainInComment = 8 };

constexpr std::array<std::uint8_t, 256> MakeClasses() {
  std::array<std::uint8_t, 256> classes{};
  for (int c = 'a'; c <= 'z'; ++c) classes[c] = classes[c - 'a' + 'A'] = kLetter;
  for (int c = '0'; c <= '9'; ++c) classes[c] = kDigit;
  classes['_'] = kLetter;
  for (int c = 0; c < 128; ++c) {
    if ((c < ' ' && c != '\t') || c == 0x7f) continue;
    classes[c] |= kPlainInComment;
    if (c != '"' && c != '\\' && c != '{' && c != '}') classes[c] |= kPlainInString;
  }
  return classes;
}
constexpr std::array<std::uint8_t, 256> kClasses = MakeClasses();

struct KeywordEntry {
  std::string_view text;
  Keyword keyword;
};
constexpr KeywordEntry kKeywords[] = {
    {"if", Keyword::kIf},
    {"or", Keyword::kOr},
    {"in", Keyword::kIn},
    {"as", Keyword::kAs},
    {"let", Keyword::kLet},
    {"for", Keyword::kFor},
    {"use", Keyword::kUse},
    {"and", Keyword::kAnd},
    {"not", Keyword::kNot},
    {"unit", Keyword::kUnit},
    {"then", Keyword::kThen},
    {"else", Keyword::kElse},
    {"true", Keyword::kTrue},
    {"last", Keyword::kLast},
    {"group", Keyword::kGroup},
    {"false", Keyword::kFalse},
    {"reset", Keyword::kReset},
    {"define", Keyword::kDefine},
    {"assert", Keyword::kAssert},
    {"within", Keyword::kWithin},
    {"unknown", Keyword::kUnknown},
    {"function", Keyword::kFunction},
    {"parameter", Keyword::kParameter},
    {"interface", Keyword::kInterface},
    {"hypothesis", Keyword::kHypothesis},
    {"consistent", Keyword::kConsistent},
};

char LowerAscii(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool IsLetter(std::int32_t code_point) {
  switch (utf8proc_category(code_point)) {
    case UTF8PROC_CATEGORY_LU:
    case UTF8PROC_CATEGORY_LL:
    case UTF8PROC_CATEGORY_LT:
    case UTF8PROC_CATEGORY_LM:
    case UTF8PROC_CATEGORY_LO:
      return true;
    default:
      return false;
  }
}

// Marks count, because a letter and its accent may be two code points.
bool IsWordPart(std::int32_t code_point) {
  switch (utf8proc_category(code_point)) {
    case UTF8PROC_CATEGORY_MN:
    case UTF8PROC_CATEGORY_MC:
    case UTF8PROC_CATEGORY_ND:
      return true;
    default:
      return IsLetter(code_point);
  }
}

// Controls, and the marks by which a text can look other than it is.
bool IsForbidden(std::int32_t code_point) {
  return (code_point < 0x20 && code_point != '\t') || (code_point >= 0x7f && code_point < 0xa0) ||
         (code_point >= 0x202a && code_point <= 0x202e) ||
         (code_point >= 0x2066 && code_point <= 0x2069) || code_point == 0xfeff;
}

std::string_view HelpFor(std::int32_t code_point) {
  switch (code_point) {
    case '&':
      return "write `and`";
    case '!':
      return "write `not`";
    case '\'':
    case 0x2018:
    case 0x2019:
    case 0x201c:
    case 0x201d:
      return "strings stand in plain double quotes: \"text\"";
    case 0x2212:
    case 0x2013:
    case 0x2014:
      return "the minus sign is the plain `-`";
    case 0xd7:
    case 0xb7:
      return "write `*`";
    case 0xb0:
      return "write `deg`, as in 30deg";
    case 0xb1:
      return "write `+-`";
    case 0xa0:
    case 0x202f:
    case 0x2009:
      return "use a plain space";
    case '\\':
      return "a statement goes on in the next line after a comma or an operator";
    default:
      return "";
  }
}

class Lexer {
 public:
  Lexer(const SourceText& source, std::uint32_t file, Diagnostics* diagnostics)
      : text_(source.text), file_(file), diagnostics_(diagnostics) {
    at_ = source.line_starts.front();
  }

  Lexed Run() {
    // A guess that is seldom too small; pages that are never written cost nothing.
    out_.tokens.reserve(text_.size() / 2 + 16);
    while (at_ < text_.size()) {
      if (!open_.empty() && open_.back().kind == TokenKind::kQuoteOpen) {
        LexStringPart();
      } else {
        LexToken();
      }
    }
    if (!open_.empty()) ReportUnclosedString();
    Emit(TokenKind::kEnd, at_);
    return std::move(out_);
  }

 private:
  // A string, or a value inside one, that is not closed yet.
  struct Open {
    TokenKind kind;
    std::uint32_t begin;
  };

  struct Decoded {
    std::int32_t code_point;
    std::uint32_t length;
  };

  char CharAt(std::size_t at) const { return at < text_.size() ? text_[at] : '\0'; }
  static bool Is(char c, std::uint8_t char_class) {
    return (kClasses[static_cast<unsigned char>(c)] & char_class) != 0;
  }

  Decoded DecodeAt(std::uint32_t at) const {
    std::int32_t code_point = -1;
    const auto length =
        utf8proc_iterate(reinterpret_cast<const utf8proc_uint8_t*>(text_.data()) + at,
                         static_cast<utf8proc_ssize_t>(text_.size() - at), &code_point);
    return {code_point, length > 0 ? static_cast<std::uint32_t>(length) : 1};
  }

  void Emit(TokenKind kind, std::uint32_t begin, Keyword keyword = Keyword::kNone) {
    out_.tokens.push_back({begin, at_, kind, keyword});
  }
  void EmitNext(TokenKind kind, std::uint32_t length) {
    const std::uint32_t begin = at_;
    at_ += length;
    Emit(kind, begin);
  }

  void Report(Code code, std::uint32_t begin, std::uint32_t end, std::string message,
              std::string label, std::string help) {
    diagnostics_->Add(
        {code, {file_, begin, end}, std::move(message), std::move(label), std::move(help)});
  }

  void LexToken() {
    const char c = text_[at_];
    if (c == ' ' || c == '\t') {
      ++at_;
    } else if (Is(c, kLetter)) {
      LexWord();
    } else if (Is(c, kDigit)) {
      LexNumber();
    } else if (c == '\n' || (c == '\r' && CharAt(at_ + 1) == '\n')) {
      LexNewline();
    } else if (c == '#' && open_.empty()) {
      LexComment();
    } else if (c == '"') {
      if (open_.empty()) first_of_string_ = out_.tokens.size();
      open_.push_back({TokenKind::kQuoteOpen, at_});
      EmitNext(TokenKind::kQuoteOpen, 1);
    } else if (!LexOperator()) {
      LexOther();
    }
  }

  void LexNewline() {
    if (!open_.empty()) ReportUnclosedString();
    EmitNext(TokenKind::kNewline, text_[at_] == '\r' ? 2 : 1);
  }

  // Moves over letters, digits and marks from here.
  void SkipWordParts() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (Is(c, kLetter | kDigit)) {
        ++at_;
      } else if (static_cast<signed char>(c) >= 0) {
        return;
      } else {
        const Decoded decoded = DecodeAt(at_);
        if (!IsWordPart(decoded.code_point)) return;
        at_ += decoded.length;
      }
    }
  }

  void LexWord() {
    const std::uint32_t begin = at_;
    SkipWordParts();
    Emit(TokenKind::kWord, begin, KeywordOf(text_.substr(begin, at_ - begin)));
  }

  void SkipDigits() {
    while (Is(CharAt(at_), kDigit)) ++at_;
  }

  bool AtLetter() const {
    if (at_ >= text_.size()) return false;
    const char c = text_[at_];
    if (static_cast<signed char>(c) >= 0) return Is(c, kLetter);
    return IsLetter(DecodeAt(at_).code_point);
  }

  void LexNumber() {
    const std::uint32_t begin = at_;
    SkipDigits();
    if (CharAt(at_) == '.' && Is(CharAt(at_ + 1), kDigit)) {
      ++at_;
      SkipDigits();
    }
    if (CharAt(at_) == 'e' || CharAt(at_) == 'E') {
      const bool is_signed = CharAt(at_ + 1) == '+' || CharAt(at_ + 1) == '-';
      if (Is(CharAt(at_ + (is_signed ? 2 : 1)), kDigit)) {
        at_ += is_signed ? 2 : 1;
        SkipDigits();
      }
    }
    // Only an exponent or very many digits can leave the range; reading each number twice costs.
    if (at_ - begin > 20 || text_.substr(begin, at_ - begin).find_first_of("eE") != text_.npos) {
      CheckRange(begin);
    }
    if (AtLetter()) {
      SkipWordParts();
    } else if (CharAt(at_) == '%') {
      TakePercent(begin);
    }
    Emit(TokenKind::kNumber, begin);
  }

  void CheckRange(std::uint32_t begin) {
    if (std::isfinite(NumberOf(text_.substr(begin, at_ - begin)).value)) return;
    Report(Code::kBadNumber, begin, at_, "the number is too large", "at most about 1.8e308", "");
  }

  // `2%` is per cent, and `5%3` is neither that nor a remainder.
  void TakePercent(std::uint32_t begin) {
    const char next = CharAt(at_ + 1);
    const bool operand = Is(next, kLetter | kDigit) || next == '(' || next == '[' || next == '"' ||
                         static_cast<signed char>(next) < 0;
    if (!operand || (next == '"' && !open_.empty())) {
      ++at_;
      return;
    }
    Report(Code::kPercentOrRemainder, at_, at_ + 1,
           "`%` that touches the number before it is per cent", "and here an operand follows",
           fmt::format("for the remainder write `{} % {}`", text_.substr(begin, at_ - begin),
                       next == '(' || next == '[' ? "(…)" : "…"));
  }

  void LexComment() {
    const std::uint32_t begin = at_;
    while (at_ < text_.size() && text_[at_] != '\n') {
      if (Is(text_[at_], kPlainInComment)) {
        ++at_;
      } else if (text_[at_] == '\r' && CharAt(at_ + 1) == '\n') {
        break;
      } else {
        TakeInnerCharacter();
      }
    }
    out_.comments.push_back({begin, at_});
  }

  // A character inside a string or comment that is not plain ASCII.
  void TakeInnerCharacter() {
    const Decoded decoded = DecodeAt(at_);
    if (IsForbidden(decoded.code_point)) {
      ReportForbidden(decoded.code_point, at_, at_ + decoded.length);
    }
    at_ += decoded.length;
  }

  void ReportForbidden(std::int32_t code_point, std::uint32_t begin, std::uint32_t end) {
    Report(Code::kStrayCharacter, begin, end,
           fmt::format("the invisible character U+{:04X} is not allowed in a script", code_point),
           "remove it", "");
  }

  // The two-character operator here, if there is one.
  std::optional<TokenKind> TwoCharacterOperator() const {
    const char next = CharAt(at_ + 1);
    switch (text_[at_]) {
      case '=':
        if (next == '=') return TokenKind::kEqual;
        if (next == '>') return TokenKind::kArrow;
        break;
      case '!':
        if (next == '=') return TokenKind::kNotEqual;
        break;
      case '<':
        if (next == '=') return TokenKind::kLessEqual;
        break;
      case '>':
        if (next == '=') return TokenKind::kGreaterEqual;
        break;
      case '.':
        if (next == '.') return TokenKind::kDotDot;
        break;
      case '+':
        if (next == '-') return TokenKind::kPlusMinus;
        break;
      default:
        break;
    }
    return std::nullopt;
  }

  static std::optional<TokenKind> OneCharacterOperator(char c) {
    switch (c) {
      case ';':
        return TokenKind::kSemicolon;
      case '|':
        return TokenKind::kBar;
      case '(':
        return TokenKind::kLeftParen;
      case ')':
        return TokenKind::kRightParen;
      case '[':
        return TokenKind::kLeftBracket;
      case ']':
        return TokenKind::kRightBracket;
      case '{':
        return TokenKind::kLeftBrace;
      case '}':
        return TokenKind::kRightBrace;
      case ',':
        return TokenKind::kComma;
      case '.':
        return TokenKind::kDot;
      case ':':
        return TokenKind::kColon;
      case '=':
        return TokenKind::kAssign;
      case '<':
        return TokenKind::kLess;
      case '>':
        return TokenKind::kGreater;
      case '+':
        return TokenKind::kPlus;
      case '-':
        return TokenKind::kMinus;
      case '*':
        return TokenKind::kStar;
      case '/':
        return TokenKind::kSlash;
      case '^':
        return TokenKind::kCaret;
      case '%':
        return TokenKind::kPercent;
      default:
        return std::nullopt;
    }
  }

  bool LexOperator() {
    if (const auto two = TwoCharacterOperator()) {
      EmitNext(*two, 2);
      return true;
    }
    const auto one = OneCharacterOperator(text_[at_]);
    if (!one) return false;
    if (open_.empty()) {
      EmitNext(*one, 1);
    } else if (*one == TokenKind::kRightBrace) {
      open_.pop_back();
      EmitNext(TokenKind::kValueClose, 1);
    } else if (*one == TokenKind::kSemicolon || *one == TokenKind::kBar ||
               *one == TokenKind::kLeftBrace) {
      LexStray({text_[at_], 1});
    } else {
      EmitNext(*one, 1);
    }
    return true;
  }

  void LexOther() {
    const Decoded decoded = DecodeAt(at_);
    if (IsLetter(decoded.code_point)) {
      LexWord();
    } else {
      LexStray(decoded);
    }
  }

  void LexStray(Decoded decoded) {
    const std::uint32_t begin = at_;
    at_ += decoded.length;
    if (IsForbidden(decoded.code_point)) {
      ReportForbidden(decoded.code_point, begin, at_);
      return;  // what is invisible is left out, so that it hides no second mistake
    }
    const bool in_value = !open_.empty();
    std::string_view help = HelpFor(decoded.code_point);
    if (help.empty() && in_value) help = "for a brace inside a string write {{ or }}";
    Report(Code::kStrayCharacter, begin, at_,
           fmt::format("`{}` means nothing {}", text_.substr(begin, decoded.length),
                       in_value ? "in the value of a string" : "here"),
           "", std::string(help));
    if (utf8proc_category(decoded.code_point) == UTF8PROC_CATEGORY_ZS) return;
    Emit(TokenKind::kBad, begin);
  }

  void LexStringPart() {
    const std::uint32_t begin = at_;
    const char c = text_[at_];
    if (c == '"') {
      open_.pop_back();
      EmitNext(TokenKind::kQuoteClose, 1);
    } else if (c == '\n' || (c == '\r' && CharAt(at_ + 1) == '\n')) {
      LexNewline();
    } else if (c == '{' && CharAt(at_ + 1) != '{') {
      open_.push_back({TokenKind::kValueOpen, at_});
      EmitNext(TokenKind::kValueOpen, 1);
    } else {
      while (TakeStringCharacter()) {
      }
      Emit(TokenKind::kStringText, begin);
    }
  }

  // False where the text between quotes and values ends.
  bool TakeStringCharacter() {
    const char c = CharAt(at_);
    const char next = CharAt(at_ + 1);
    if (at_ >= text_.size() || c == '"' || c == '\n' || (c == '\r' && next == '\n')) return false;
    if (Is(c, kPlainInString)) {
      ++at_;
    } else if (c == '{') {
      if (next != '{') return false;
      at_ += 2;
    } else if (c == '}') {
      if (next != '}') {
        Report(Code::kBadEscape, at_, at_ + 1, "a single `}` in a string", "",
               "write }} for a brace");
      }
      at_ += next == '}' ? 2 : 1;
    } else if (c == '\\') {
      TakeEscape();
    } else {
      TakeInnerCharacter();
    }
    return true;
  }

  void TakeEscape() {
    const char next = CharAt(at_ + 1);
    if (next == '"' || next == '\\' || next == 'n') {
      at_ += 2;
      return;
    }
    const bool at_line_end = next == '\n' || next == '\r' || at_ + 1 >= text_.size();
    const std::uint32_t length = at_line_end ? 1 : 1 + DecodeAt(at_ + 1).length;
    Report(Code::kBadEscape, at_, at_ + length,
           at_line_end ? "a `\\` at the end of the line" : "an unknown escape in a string", "",
           "the escapes are \\\" \\\\ \\n {{ }}; write \\\\ for a backslash");
    ++at_;
  }

  // Nothing of the string is left to the parser, which could only be misled by it.
  void ReportUnclosedString() {
    const std::uint32_t begin = open_[0].begin;
    if (open_.size() == 1) {
      Report(Code::kUnclosedString, begin, at_, "the string is not closed",
             "no `\"` follows on this line", "");
    } else {
      Report(Code::kUnclosedString, open_[1].begin, open_[1].begin + 1,
             "the value in the string is not closed", "not closed on this line",
             "for a brace inside a string write {{");
    }
    open_.clear();
    out_.tokens.resize(first_of_string_);
    Emit(TokenKind::kBad, begin);
  }

  std::string_view text_;
  std::uint32_t file_;
  Diagnostics* diagnostics_;
  std::uint32_t at_ = 0;
  std::vector<Open> open_;
  std::size_t first_of_string_ = 0;  // the token that opened the outermost string
  Lexed out_;
};

}  // namespace

Keyword KeywordOf(std::string_view word) {
  if (word.size() < 2 || word.size() > 10) return Keyword::kNone;
  const char first = LowerAscii(word[0]);
  for (const KeywordEntry& entry : kKeywords) {
    if (entry.text.size() != word.size() || entry.text[0] != first) continue;
    std::size_t i = 1;
    while (i < word.size() && LowerAscii(word[i]) == entry.text[i]) ++i;
    if (i == word.size()) return entry.keyword;
  }
  return Keyword::kNone;
}

Lexed Lex(const SourceText& source, std::uint32_t file, Diagnostics* diagnostics) {
  return Lexer(source, file, diagnostics).Run();
}

}  // namespace tranos::interp
