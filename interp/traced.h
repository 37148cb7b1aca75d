// SPDX-License-Identifier: GPL-3.0-or-later
// From what a state holds of photographs and traces to what the solver takes.
#pragma once

#include <optional>
#include <span>
#include <unordered_set>
#include <vector>

#include "camera/traces.h"
#include "model/state.h"

namespace tranos::interp {

struct Traced {
  std::vector<camera::Photograph> photographs;           // those attached, and cameras with traces
  std::vector<model::ElementId> photograph_ids;          // of each
  std::vector<std::vector<model::ElementId>> trace_ids;  // of each, by trace
  std::vector<model::Value> numbers;                     // by camera::NumberIndex, in SI
  std::vector<model::ElementId> number_owners;           // the trace that each stands for
  std::unordered_set<model::ElementId> elements;         // those that traces are of
  std::vector<std::string> facades;                      // their names, by camera's index
  // Of each: the number that gives its azimuth, with its distance after it, where a facade of that
  // name stands in the model; −1 where its place is to be found.
  std::vector<camera::NumberIndex> given_planes;
  double noise_px = 0.5;  // of the first trace
  bool noise_is_estimated = false;

  std::size_t trace_count() const {
    std::size_t count = 0;
    for (const std::vector<model::ElementId>& ids : trace_ids) count += ids.size();
    return count;
  }
};
// Of the photograph with this id, or of all attached ones, but those whose camera was read and on
// which nothing is traced.
Traced TracedIn(const model::State& state, model::ElementId only = model::kNoElement);

// The numbers' values, without derivatives.
Eigen::VectorXd ValuesOf(std::span<const model::Value> numbers);

// The penalty of a camera: the sum of squares of what lies between edges with a place in space and
// their traced lines, in deviations (the paper's Step F). Nothing if no such edge is traced.
std::optional<double> PenaltyOf(const model::State& state, const model::Element& photograph,
                                const camera::Camera& camera);

}  // namespace tranos::interp
