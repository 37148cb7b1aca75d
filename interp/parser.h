// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "interp/diagnostic.h"
#include "interp/syntax.h"

namespace tranos::interp {

struct ParseLimits {
  int depth = 200;  // of nested syntax
};

// The tree of one file's text. After an error the parser goes on at the next statement, so that one
// pass reports all; the tree then holds kError nodes. Grammar: docs/language.md, "Grammar".
SyntaxTree Parse(const Sources& sources, std::uint32_t file, const ParseLimits& limits,
                 Diagnostics* diagnostics);

}  // namespace tranos::interp
