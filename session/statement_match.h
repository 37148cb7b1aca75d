// SPDX-License-Identifier: GPL-3.0-or-later
// Which statement of one script is which of another.
#pragma once

#include <cstdint>
#include <vector>

#include "session/statement_tree.h"

namespace tranos::session {

struct StatementMatch {
  // By statement of the one, that of the other, or kNoStatement.
  std::vector<std::uint32_t> b_of_a, a_of_b;
};

// Equal statements first, in their order where possible, else moved; then statements that are
// alike, between the same neighbours or elsewhere. Blocks are matched with what is in them.
StatementMatch MatchStatements(const StatementTree& a, const StatementTree& b);

// The longest common subsequence of two sequences, as pairs of indices in ascending order; where
// the sequences are long and far apart, a shorter one.
std::vector<std::pair<std::uint32_t, std::uint32_t>> CommonSubsequence(
    const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b);

}  // namespace tranos::session
