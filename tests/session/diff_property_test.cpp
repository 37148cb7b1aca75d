// SPDX-License-Identifier: GPL-3.0-or-later
// What holds of the diff of any scripts.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "runs.h"

namespace tranos::session {

namespace {

// Lines that do not depend on one another, each with its block closed.
rc::Gen<std::string> Line() {
  return rc::gen::map(
      rc::gen::tuple(rc::gen::inRange(0, 7), rc::gen::inRange(0, 4), rc::gen::inRange(1, 4)),
      [](const auto& drawn) {
        const auto [kind, at, size] = drawn;
        const std::string x = std::to_string(at), n = std::to_string(size);
        switch (kind) {
          case 0:
            return "place point xy=" + x + ",0";
          case 1:
            return "place circle radius=" + n + " xy=" + x + ",1";
          case 2:
            return "place line xy=" + x + ",0 dl=" + n + " dl=0," + n + " reset";
          case 3:
            return "for i = 1 to " + n + " { place point xy=" + x + ",i }";
          case 4:
            return "{ co=" + n + "; place block xy=" + x + ",0 dl=1," + n + " }";
          case 5:
            return "group { place point xy=" + x + ",5; place circle radius=" + n + " xy=0,0 }";
          default:
            return "place circle radius=" + n + " xy=" + x +
                   ",9; copy of=last xy=0,0 dl=20,0 reset";
        }
      });
}
rc::Gen<std::vector<std::string>> Lines() {
  return rc::gen::container<std::vector<std::string>>(Line());
}

std::string Joined(const std::vector<std::string>& lines) {
  std::string out;
  for (const std::string& line : lines) out += line + "\n";
  return out;
}

std::array<std::size_t, 4> Counts(const Difference& difference) {
  std::array<std::size_t, 4> counts{};
  for (const ElementChange& change : difference.changes) {
    if (!change.in_group) ++counts[change.kind];
  }
  return counts;
}

RC_GTEST_PROP(DiffProperty, NothingDiffersFromItself, ()) {
  const std::string text = Joined(*Lines());
  RC_ASSERT(DiffOf(text, text).changes.empty());
}

RC_GTEST_PROP(DiffProperty, TheOrderOfIndependentLinesIsNoDifference, ()) {
  auto lines = *Lines();
  const std::string before = Joined(lines);
  for (std::size_t i = lines.size(); i > 1; --i)
    std::swap(lines[i - 1], lines[*rc::gen::inRange<std::size_t>(0, i)]);
  RC_ASSERT(DiffOf(before, Joined(lines)).changes.empty());
}

RC_GTEST_PROP(DiffProperty, AnInsertedElementIsTheOneThingAdded, ()) {
  auto lines = *Lines();
  const std::string before = Joined(lines);
  const auto at = *rc::gen::inRange<std::size_t>(0, lines.size() + 1);
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at),
               "place circle radius=77 xy=-50,-50");
  RC_ASSERT(Summary(DiffOf(before, Joined(lines))) == "added circle\n");
  RC_ASSERT(Summary(DiffOf(Joined(lines), before)) == "removed circle\n");
}

// Each element is told at most once, and the models' sizes add up.
RC_GTEST_PROP(DiffProperty, EveryElementIsEqualOrInOneClass, ()) {
  const RunRecord a = RecordOf("a.trn", Joined(*Lines())), b = RecordOf("b.trn", Joined(*Lines()));
  const Difference difference = Diff(a, b);
  const auto counts = Counts(difference);
  const std::size_t both =
      difference.equal + counts[ElementChange::kMoved] + counts[ElementChange::kChanged];
  RC_ASSERT(both + counts[ElementChange::kAdded] == b.result.outcome.state.model.live);
  // An element that went into a group, or out of one, stands in one of the models alone.
  RC_ASSERT(both + counts[ElementChange::kRemoved] <=
            a.result.outcome.state.model.live + b.result.outcome.state.model.live);
}

RC_GTEST_PROP(DiffProperty, TheOtherWayRoundAddedIsRemoved, ()) {
  const RunRecord a = RecordOf("a.trn", Joined(*Lines())), b = RecordOf("b.trn", Joined(*Lines()));
  const auto there = Counts(Diff(a, b)), back = Counts(Diff(b, a));
  RC_ASSERT(there[ElementChange::kAdded] == back[ElementChange::kRemoved]);
  RC_ASSERT(there[ElementChange::kRemoved] == back[ElementChange::kAdded]);
}

// What both models hold with the same content is never told.
RC_GTEST_PROP(DiffProperty, WhatIsEqualIsNeverTold, ()) {
  const auto shared = *Lines();
  auto one = shared, other = shared;
  one.push_back("place circle radius=55 xy=0,0");
  other.insert(other.begin(), "place block xy=70,70 dl=5,5");
  RC_ASSERT(Summary(DiffOf(Joined(one), Joined(other))) == "added shape\nremoved circle\n");
}

}  // namespace

}  // namespace tranos::session
