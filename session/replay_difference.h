// SPDX-License-Identifier: GPL-3.0-or-later
// How a line of a replay differs from the journal's.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tranos::session {

// Coordinates that differ by no more are equal within tolerance.
inline constexpr double kReplayTolerance_m = 1e-9;

struct LineDifference {
  bool malformed = false;              // the journal's line is no JSON object
  std::vector<std::string> differing;  // beyond tolerance: "key_in: recorded …, now …"
  std::vector<std::string> hashes;     // members that are hashes and differ
  std::size_t close = 0;               // numbers that differ within tolerance
  double largest_close = 0;            // … and by how much, in their unit
};
LineDifference CompareLines(std::string_view recorded, std::string_view found);

}  // namespace tranos::session
