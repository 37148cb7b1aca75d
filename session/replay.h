// SPDX-License-Identifier: GPL-3.0-or-later
// Running a journal again and comparing each step with what was recorded.
#pragma once

#include <string_view>

#include "session/journal_reader.h"

namespace tranos::session {

struct ReplayReport {
  enum Verdict { kEqual, kWithinTolerance, kDiffers, kBroken } verdict = kEqual;
  std::uint64_t steps = 0;  // equal ones, or equal within tolerance
  std::vector<JournalFinding>
      findings;  // the first difference within tolerance, and what stopped it
};
ReplayReport Replay(const Journal& journal);

}  // namespace tranos::session
