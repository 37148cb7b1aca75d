// SPDX-License-Identifier: GPL-3.0-or-later
// The statements before `calibrate` as a function of the unknowns. Numbers are computed again by
// the slice that was recorded as they ran, and elements that traces are of are placed again by it;
// what else is read off an element that unknowns move, by running all of them in a machine of its
// own, silently. Private to this room.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "camera/traces.h"
#include "interp/machine.h"
#include "interp/traced.h"

namespace tranos::interp {

// Whether it ends a run, and is no fault of the values that were tried.
inline bool IsLimit(Code code) {
  return code == Code::kStepLimit || code == Code::kElementLimit || code == Code::kMemoryLimit ||
         code == Code::kDepthLimit;
}

// What the sources of a run are given in place of their own.
struct Machine::Trial {
  // By the order in which they are met: the value of an unknown, the error of a `+-` literal.
  std::map<std::size_t, double> values;
  // In the last run: each unknown's deviations by independent sources that all solved numbers
  // share.
  const Eigen::MatrixXd* factor = nullptr;  // a row for each of `rows`
  std::map<std::size_t, Eigen::Index> rows;
};

// One value of the unknowns, tried on everything before `calibrate`.
class Machine::TrialRun {
 public:
  TrialRun(const Machine& main, const Host& silent, const Trial& trial);
  // Runs to `calibrate`; an error of the script is thrown.
  void Run();
  std::uint64_t steps() const { return steps_before_ - machine_.budget_.steps_left; }

  const model::State& state() const { return state_; }
  Machine& machine() { return machine_; }
  Registers& registers() { return registers_; }

 private:
  RunOptions options_;
  Machine machine_;
  std::uint64_t steps_before_;
  Registers registers_;
  model::State state_;
};

// Numbers read off elements, with their derivatives by each source that moves them.
struct Machine::ReadOff {
  Eigen::VectorXd values;
  std::vector<Eigen::VectorXd> slopes;
};

// Gives the numbers that traces stand on for any values of the unknowns.
class Machine::Evaluation {
 public:
  // Finds what the numbers depend on: by their derivatives; and by running everything once with
  // all unknowns moved a little, which tells the numbers that are read off elements, and whether
  // placing these again gives them.
  Evaluation(Machine& main, const Host& silent, const model::State& state, const Traced& start,
             Span span);

  const std::vector<camera::Unknown>& unknowns() const { return unknowns_; }
  const std::vector<std::size_t>& sources() const { return sources_; }
  // What the last trial that gave no numbers failed by, or the first that reached a limit of the
  // run.
  const std::optional<RunFailure>& failure() const { return failure_; }

  geom::Result<camera::Numbers> operator()(const Eigen::VectorXd& unknowns);
  Trial TrialOf(const Eigen::VectorXd& unknowns) const;
  // The numbers by the slice alone.
  std::vector<model::Value> Sliced(const Trial& trial) const;
  // Those of the numbers that differ from what the slice gives.
  std::set<std::size_t> Beyond(const Traced& traced, const Trial& trial) const;
  bool is_read_off(std::size_t number) const { return read_off_.contains(number); }

 private:
  void FindReadOff();
  void FindMovers(const std::vector<std::size_t>& sources);
  void FindUnknowns();
  Trial Moved(const std::vector<std::size_t>& sources) const;
  model::Value WithErrors(const Trial& trial, const Slice::Operation& operation,
                          const model::Value* registers) const;
  model::Value Again(const Trial& trial, const Slice::Operation& operation,
                     model::Value* registers) const;
  Slice::Known Known(const Trial& trial) const;
  Traced Traces(const Trial& trial) const;
  Traced TracesPlaced(const Trial& trial) const;
  Traced TracesBeyond(const Trial& trial) const;
  const ReadOff& ReadOffAt(const Eigen::VectorXd& unknowns);
  void AddReadOff(const Eigen::VectorXd& unknowns, camera::Numbers* numbers);
  void CheckCount(const Traced& traced) const;
  bool CanMove(std::size_t source) const;

  Machine& main_;
  const Host& silent_;
  const model::State& state_;  // at `calibrate`, with the start values
  const Traced& start_;
  const Span span_;                 // of `calibrate`
  std::set<std::size_t> read_off_;  // numbers that elements give which unknowns move
  bool places_ = false;             // all of these: placing their elements again gives them
  std::set<std::size_t> movers_;    // the sources that move them
  std::map<std::vector<double>, ReadOff> known_;  // by the movers' values
  std::vector<std::size_t> sources_;              // of each unknown of the adjustment
  std::map<std::size_t, Eigen::Index> column_;
  std::vector<camera::Unknown> unknowns_;
  std::optional<RunFailure> failure_;
};

}  // namespace tranos::interp
