// SPDX-License-Identifier: GPL-3.0-or-later
// What the tree knows of the tokens and their layout depends on.
#pragma once

#include <cstdint>
#include <vector>

#include "interp/syntax.h"
#include "interp/token.h"

namespace tranos::interp {

// Bits that are set for a token.
enum TokenRole : std::uint8_t {
  kPlainRole = 0,
  kKeyAssign = 1,     // the = of a key
  kNegation = 2,      // a minus with one operand
  kInKeyIn = 4,       // between a key's first letter and its value's last
  kContinuation = 8,  // a newline inside a statement
  kHeader = 16,       // between a definition's words and its block
  kWideRange = 32,    // a .. with a sum on one of its sides
};

// A set of TokenRole for each token.
std::vector<std::uint8_t> RolesOf(const SyntaxTree& tree, const std::vector<Token>& tokens);

}  // namespace tranos::interp
