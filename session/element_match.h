// SPDX-License-Identifier: GPL-3.0-or-later
// Which element of one run is which of another.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "session/origin.h"
#include "session/statement_match.h"

namespace tranos::session {

// An element of a final model, or a member of a group in it.
struct Subject {
  const model::Element* element = nullptr;
  int parent = -1;  // the group, a subject before it
  int depth = 0;
  std::string name = {};  // qualified; "" if it has none
  std::uint32_t firing = kNoFiring;
  std::uint32_t statement = 0;
  std::vector<std::uint64_t> turns =
      {};  // of the loops around the statement, as hashes of their values
};

struct ElementMatch {
  std::vector<Subject> a, b;
  static constexpr int kFree = -1;    // has no counterpart
  static constexpr int kWithin = -2;  // in a group that is equal or moved as a whole
  std::vector<int> b_of_a, a_of_b;    // by subject
};

// Equal content is matched with equal content before anything else, so that what is left is what
// differs; that by name, by the statements and turns it comes from, and by command and shape.
ElementMatch MatchElements(const RunRecord& a, const RunRecord& b);

}  // namespace tranos::session
