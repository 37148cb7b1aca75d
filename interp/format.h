// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "interp/syntax.h"

namespace tranos::interp {

// The script in the one layout, comments kept; formatting the result again changes nothing, and its
// effect is that of the text formatted. For a tree without errors.
std::string Format(const SourceText& source, const SyntaxTree& tree);

}  // namespace tranos::interp
