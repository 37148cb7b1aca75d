// SPDX-License-Identifier: GPL-3.0-or-later
// What two runs differ in, element by element.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "session/origin.h"

namespace tranos::session {

struct Measures {
  std::optional<double> length_m, area_m2, volume_m3;
};

// A parameter, answer, attribute or name with another value; "" where there is none.
struct ParameterChange {
  std::string name, before, after;
};

// Where an element comes from.
struct SourcePlace {
  std::string path;
  std::uint32_t line = 0;
  std::vector<std::string> turns = {};  // what the variable of each loop around it stood for
};

struct ElementChange {
  enum Kind { kAdded, kRemoved, kMoved, kChanged } kind = kChanged;
  std::string name;       // qualified by the groups around it; "" if it has none
  std::string type;       // of the later one
  bool in_group = false;  // of a group that is there before and after
  std::optional<SourcePlace> place_before, place_after;
  std::optional<double> largest_m;  // of corresponding points; of what is moved or changed
  std::optional<geom::Vec3> by_m;   // moved without being turned
  std::vector<ParameterChange> parameters;
  Measures before, after;
};

struct Difference {
  std::vector<ElementChange> changes;  // added, removed, moved, changed; each in the scripts' order
  std::size_t equal = 0;               // elements of the later model that are as they were
};

// Both have run. Elements are those of the models, and members of groups that differ.
Difference Diff(const RunRecord& a, const RunRecord& b);

// For people: a line for each element, and a summary.
std::string RenderText(const Difference& difference);
// One object; SI units.
std::string RenderJson(const Difference& difference);

}  // namespace tranos::session
