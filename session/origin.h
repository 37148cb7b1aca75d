// SPDX-License-Identifier: GPL-3.0-or-later
// A run with the origin of each of its elements, which is what two runs are matched by.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "interp/run.h"

namespace tranos::session {

// A command that fired and changed the model.
struct Firing {
  interp::Span
      at;  // the key-in; of a command that fired as it ended, the command; of a group, its end
  std::string command;              // its words; "" for a group
  std::vector<model::Value> turns;  // what the variable of each loop around it stood for
  std::vector<std::pair<std::string, model::Value>> answers;
};

inline constexpr std::uint32_t kNoFiring = 0xffffffff;

struct Origin {
  std::uint32_t firing = kNoFiring;         // that made it
  std::uint32_t index = 0;                  // among what it made
  std::vector<std::uint32_t> changes = {};  // firings that changed it afterwards
};

struct RunRecord {
  interp::ScriptResult result;
  std::vector<Firing> firings;
  std::vector<Origin> origins;  // by element id; shorter than the entries where nothing is known
};

// To be told of a run's steps; the result is to be put in by the caller.
class OriginRecorder {
 public:
  explicit OriginRecorder(RunRecord* record) : record_(record) {}
  void Add(const interp::Step& step);

 private:
  Origin& OriginOf(model::ElementId id);
  RunRecord* record_;
};

}  // namespace tranos::session
