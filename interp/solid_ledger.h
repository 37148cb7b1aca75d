// SPDX-License-Identifier: GPL-3.0-or-later
// Which statement made each solid of a run. A solid is evaluated when something is measured or
// written, and what fails then is told of the statement that asked for it.
#pragma once

#include <functional>
#include <unordered_map>

#include "interp/source.h"
#include "model/element.h"

namespace tranos::interp {

class SolidLedger {
 public:
  // Work on solids is charged facet by facet, as steps: `charge` throws where a limit is reached.
  explicit SolidLedger(std::function<void(std::uint64_t facets, Span)> charge)
      : charge_(std::move(charge)) {}
  // The solids that these elements are or hold, as made by the statement; those known already stay
  // with theirs.
  void Note(const std::vector<model::ElementPtr>& elements, Span statement);
  // Evaluates the solids of an element; throws RunFailure at the statement that made one that
  // cannot be, or that is empty. `fallback` is for solids that no statement made.
  void Force(const model::Element& element, Span fallback) const;

 private:
  struct Made {
    model::SolidPtr solid;  // kept, so that its address stays its own
    Span statement;
  };
  std::function<void(std::uint64_t, Span)> charge_;
  std::unordered_map<const geom::Solid::Node*, Made> made_;
};

}  // namespace tranos::interp
