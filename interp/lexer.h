// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>
#include <vector>

#include "interp/diagnostic.h"
#include "interp/syntax.h"
#include "interp/token.h"

namespace tranos::interp {

// A file's tokens, the last of which is kEnd, and apart from them its comments.
struct Lexed {
  std::vector<Token> tokens;
  std::vector<Comment> comments;
};

// Cuts well-formed UTF-8 into tokens. What is wrong is reported and leaves a kBad token where the
// parser could otherwise be misled.
Lexed Lex(const SourceText& source, std::uint32_t file, Diagnostics* diagnostics);

// The keyword that a word is, in any case of its letters.
Keyword KeywordOf(std::string_view word);

}  // namespace tranos::interp
