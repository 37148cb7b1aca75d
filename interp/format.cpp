// SPDX-License-Identifier: GPL-3.0-or-later
// The one layout. Lines are the writer's: no line is joined or broken, because a separator can be
// what makes a command fire. Within a line:
// - two spaces for each open brace, two for what stands between a definition's words and its block,
//   four for a line that goes on with the statement before it;
// - `; ` and ` | ` between statements, one space between a statement's parts, two before a comment
//   behind them, ` = ` for a definition and `=` for a key;
// - `* / ^ ..` without spaces, `+ -` with them, and without in a key's value outside brackets,
// where
//   commas have none either; all other operators with spaces;
// - at most one empty line, and none just inside a block.
#include "interp/format.h"

#include <utility>

#include "interp/format_roles.h"
#include "interp/lexer.h"

namespace tranos::interp {
namespace {

bool EndsOperand(TokenKind kind) {
  return kind == TokenKind::kWord || kind == TokenKind::kNumber || kind == TokenKind::kQuoteClose ||
         kind == TokenKind::kRightParen || kind == TokenKind::kRightBracket;
}

bool Opens(TokenKind kind) {
  return kind == TokenKind::kLeftParen || kind == TokenKind::kLeftBracket;
}

bool Closes(TokenKind kind) {
  return kind == TokenKind::kRightParen || kind == TokenKind::kRightBracket;
}

// A keyword after which a bracket begins a value of its own.
bool AsksForValue(Keyword keyword) {
  switch (keyword) {
    case Keyword::kAnd:
    case Keyword::kOr:
    case Keyword::kNot:
    case Keyword::kWithin:
    case Keyword::kConsistent:
    case Keyword::kIn:
    case Keyword::kIf:
    case Keyword::kThen:
    case Keyword::kElse:
    case Keyword::kAssert:
      return true;
    default:
      return false;
  }
}

class Formatter {
 public:
  Formatter(const SourceText& source, const SyntaxTree& tree)
      : text_(source.text), comments_(tree.comments) {
    Diagnostics none;
    tokens_ = Lex(source, tree.file, &none).tokens;
    roles_ = RolesOf(tree, tokens_);
    out_.reserve(text_.size() + text_.size() / 8);
  }

  std::string Run() {
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
      WriteCommentsBefore(tokens_[i].begin);
      switch (tokens_[i].kind) {
        case TokenKind::kNewline:
          ++newlines_;
          line_roles_ = roles_[i];
          break;
        case TokenKind::kSemicolon:
        case TokenKind::kBar:
          if (separator_ == TokenKind::kEnd) separator_ = tokens_[i].kind;
          break;
        case TokenKind::kEnd:
          break;
        default:
          i = WriteToken(i);
      }
    }
    if (!out_.empty()) out_ += '\n';
    return std::move(out_);
  }

 private:
  std::string_view Text(std::uint32_t begin, std::uint32_t end) const {
    return std::string_view(text_).substr(begin, end - begin);
  }

  void WriteCommentsBefore(std::uint32_t offset) {
    for (; next_comment_ < comments_.size() && comments_[next_comment_].begin < offset;
         ++next_comment_) {
      const Comment& comment = comments_[next_comment_];
      std::string_view text = Text(comment.begin, comment.end);
      while (text.ends_with(' ') || text.ends_with('\t')) text.remove_suffix(1);
      if (out_.empty() || newlines_ > 0) {
        BreakLine(false);
        Indent(LineLevels());
      } else {
        out_ += "  ";
      }
      out_ += text;
      after_brace_ = false;
      ForgetGap();
    }
  }

  // Writes a token, or a whole string, and gives the index of its last token.
  std::size_t WriteToken(std::size_t i) {
    const TokenKind kind = tokens_[i].kind;
    const std::size_t last = kind == TokenKind::kQuoteOpen ? CloseOfString(i) : i;
    if (kind == TokenKind::kRightBrace) --braces_;
    if (Closes(kind)) --brackets_;
    WriteGap(i);
    out_ += Text(tokens_[i].begin, tokens_[last].end);
    if (kind == TokenKind::kLeftBrace) ++braces_;
    if (Opens(kind)) ++brackets_;
    after_brace_ = kind == TokenKind::kLeftBrace;
    previous_ = last;
    ForgetGap();
    return last;
  }

  std::size_t CloseOfString(std::size_t open) const {
    int depth = 0;
    for (std::size_t i = open;; ++i) {
      if (tokens_[i].kind == TokenKind::kQuoteOpen) ++depth;
      if (tokens_[i].kind == TokenKind::kQuoteClose && --depth == 0) return i;
    }
  }

  // What separates token i from what was written before it.
  void WriteGap(std::size_t i) {
    const TokenKind kind = tokens_[i].kind;
    if (out_.empty()) return;
    if (newlines_ > 0) {
      BreakLine(kind == TokenKind::kRightBrace);
      Indent(kind == TokenKind::kRightBrace || kind == TokenKind::kLeftBrace ? braces_
             : Closes(kind) && brackets_ == 0                                ? braces_
                                                                             : LineLevels());
    } else if (separator_ != TokenKind::kEnd && !after_brace_ && kind != TokenKind::kRightBrace) {
      out_ += separator_ == TokenKind::kBar ? " | " : "; ";
    } else if (NeedsSpace(i)) {
      out_ += ' ';
    }
  }

  int LineLevels() const {
    return braces_ + ((line_roles_ & kHeader) != 0 ? 1 : 0) +
           ((line_roles_ & kContinuation) != 0 ? 2 : 0);
  }

  void BreakLine(bool before_close) {
    if (out_.empty()) return;
    out_ += '\n';
    if (newlines_ > 1 && !after_brace_ && !before_close) out_ += '\n';
  }

  void Indent(int levels) { out_.append(static_cast<std::size_t>(levels) * 2, ' '); }

  void ForgetGap() {
    newlines_ = 0;
    line_roles_ = kPlainRole;
    separator_ = TokenKind::kEnd;
  }

  bool Has(std::size_t i, TokenRole role) const { return (roles_[i] & role) != 0; }
  // In a key's value outside brackets, where spaces would look like ends of it.
  bool IsTight(std::size_t i) const { return brackets_ == 0 && Has(i, kInKeyIn); }

  bool NeedsSpace(std::size_t i) const {
    const TokenKind before = tokens_[previous_].kind;
    const TokenKind kind = tokens_[i].kind;
    if (after_brace_ || kind == TokenKind::kRightBrace) {
      return !after_brace_ || kind != TokenKind::kRightBrace;
    }
    if (kind == TokenKind::kComma || Closes(kind) || Opens(before)) return false;
    if (before == TokenKind::kComma) return !IsTight(previous_);
    if (kind == TokenKind::kDot || before == TokenKind::kDot) return false;
    if (Has(previous_, kNegation)) return false;
    if (Opens(kind) && EndsOperand(before)) return !CallsOrIndexes(i);
    if (Has(i, kNegation) && before == TokenKind::kPlus) return true;  // `+-` is another operator
    if (EndsOperand(before)) return NeedsSpaceBefore(i);
    return IsWide(previous_);
  }

  bool NeedsSpaceBefore(std::size_t operation) const {
    const TokenKind kind = tokens_[operation].kind;
    const bool sign = kind == TokenKind::kPlus || kind == TokenKind::kMinus;
    if (sign && EndsInBareE(tokens_[previous_])) return true;
    return IsWide(operation);
  }

  // `2e` is a number with the unit e, and `2e-3` a number with an exponent.
  bool EndsInBareE(const Token& token) const {
    if (token.kind != TokenKind::kNumber) return false;
    const std::string_view text = Text(token.begin, token.end);
    return text.ends_with('e') || text.ends_with('E');
  }

  // Whether spaces stand around a token other than brackets, commas and points.
  bool IsWide(std::size_t i) const {
    switch (tokens_[i].kind) {
      case TokenKind::kStar:
      case TokenKind::kSlash:
      case TokenKind::kCaret:
        return false;
      case TokenKind::kDotDot:
        return Has(i, kWideRange) && !IsTight(i);
      case TokenKind::kPlus:
      case TokenKind::kMinus:
        return !IsTight(i);
      case TokenKind::kAssign:
        return !Has(i, kKeyAssign);
      default:
        return true;
    }
  }

  bool CallsOrIndexes(std::size_t open) const {
    const Token& callee = tokens_[previous_];
    if (callee.end != tokens_[open].begin) return false;
    const bool is_member = previous_ > 0 && tokens_[previous_ - 1].kind == TokenKind::kDot;
    return is_member || !AsksForValue(callee.keyword);
  }

  const std::string& text_;
  const std::vector<Comment>& comments_;
  std::vector<Token> tokens_;
  std::vector<std::uint8_t> roles_;
  std::string out_;
  std::size_t next_comment_ = 0;
  std::size_t previous_ = 0;  // the token written last
  int braces_ = 0, brackets_ = 0;
  // The gap since what was written last.
  int newlines_ = 0;
  std::uint8_t line_roles_ = kPlainRole;
  TokenKind separator_ = TokenKind::kEnd;
  bool after_brace_ = false;
};

}  // namespace

std::string Format(const SourceText& source, const SyntaxTree& tree) {
  return Formatter(source, tree).Run();
}

}  // namespace tranos::interp
