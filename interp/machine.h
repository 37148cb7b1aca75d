// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a program's instructions. Private to this room.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "camera/estimate.h"
#include "interp/functions.h"
#include "interp/run.h"
#include "interp/slice.h"
#include "interp/solid_ledger.h"
#include "interp/stage.h"
#include "interp/traced.h"

namespace tranos::interp {

// An operand's value: a register, or a constant of the unit.
inline const model::Value& Get(Operand operand, const model::Value* registers,
                               const model::Value* constants) {
  return operand & kConstantBit ? constants[operand & ~kConstantBit] : registers[operand];
}

class Machine {
 public:
  Machine(const Program& program, const RunOptions& options, const Host& host);
  Outcome Run();

 private:
  using Registers = std::vector<model::Value>;
  // What a unit's code runs on; the innermost one of each unit is what code within it sees.
  struct Activation {
    model::Value* registers = nullptr;
    const Stage* stage = nullptr;
  };
  // One elements' scope that is open: the stage it belongs to, and how many groups deep.
  struct ScopePlace {
    Stage* stage = nullptr;
    std::size_t depth = 0;
  };
  struct ClosureCode {
    std::uint32_t unit;
    std::uint64_t stage;   // where it was made
    std::uint64_t serial;  // tells function values of a run apart
  };

  model::Value Execute(std::uint32_t unit, model::Value* registers, std::uint32_t from,
                       Stage* stage);
  model::Value CallUnit(std::uint32_t unit, std::span<const model::Value> arguments,
                        std::span<const model::Value> captured, Span span);
  model::Value CallClosure(const model::Value& closure, std::span<const model::Value> arguments,
                           Span span);
  // The slower instructions, each in a function of its own. Before `calibrate` Compute also notes
  // what is computed from unknowns.
  void Compute(const Instruction& instruction, const CodeUnit& unit, model::Value* registers,
               Span span);
  void ComputeValue(const Instruction& instruction, const CodeUnit& unit, model::Value* registers,
                    Span span);
  bool BeginCount(const Instruction& i, model::Value* registers, Span span);
  bool NextCount(const Instruction& i, model::Value* registers, Span span);
  bool BeginEach(const Instruction& i, model::Value* registers, Span span);
  bool NextEach(const Instruction& i, model::Value* registers, Span span);
  model::Value LoadName(const Instruction& i, const model::Value* registers,
                        const Instruction& next, Span span);
  model::Value Detached(const model::Value& value, Span span, int depth = 0);
  void Effect(const Instruction& i, const CodeUnit& unit, model::Value* registers, Stage* stage,
              Span span);
  void PointEffect(const Instruction& i, const CodeUnit& unit, const model::Value* registers,
                   Stage* stage, Span span);
  void NoteAssert(const Instruction& i, const CodeUnit& unit, const model::Value* registers,
                  Span span);
  void CheckRange(const Instruction& i, const CodeUnit& unit, const model::Value* registers,
                  Span span);
  void NoteInterface(const Instruction& i, const CodeUnit& unit, const model::Value* registers,
                     Span span);
  // Definitions (placing.cpp).
  model::ElementPtr Place(const Placement& placement, const model::State& state);
  model::PrototypePtr PrototypeOf(const Placement& placement, Registers registers);
  model::PrototypePtr Build(const Definition& definition, Registers registers, Span span);
  model::Hash128 KeyOf(const Definition& definition, const Registers& registers, Span span);
  const std::vector<std::pair<std::uint32_t, std::uint32_t>>& OuterOf(std::uint32_t unit);

  // Photographs and unknowns (calibration.cpp).
  struct Trial;
  class TrialRun;
  struct ReadOff;
  class Evaluation;
  struct Solution;
  // Something that the adjustment may solve for: an unknown, or the error of a `+-` literal.
  struct Solvable {
    camera::Unknown unknown;
    model::Dimension dimension;
    Span span;
    double stated = 0;              // of a literal
    bool taken_by_unknown = false;  // a literal that says what is known of an unknown
  };
  Fired Calibrate(const Answers& answers, const model::State& state, Span span);
  std::optional<Span> FindTrace(const Traced& traced, int index) const;
  std::optional<Span> FindPart(const Evaluation& evaluation, const Traced& traced, int part) const;
  [[noreturn]] void FailCalibration(const geom::Error& error, const Evaluation& evaluation,
                                    const Traced& traced, Span span) const;
  void WarnOfDisagreement(const camera::Disagreement& disagreement, const Evaluation& evaluation,
                          const Traced& traced, Span span);
  [[noreturn]] static void EndTrial();
  Fired Calibrated(Solution solution, const model::State& before, Span span);
  void WarnOfOrthophotos(const model::Model& model, model::ElementId photograph, Span span);
  void Warn(const camera::Estimate& estimate, const model::Element& photograph,
            const std::vector<model::ElementId>& trace_ids, Span span);
  model::Edit Adopt(TrialRun& solved, const model::State& before, Span span);
  void CheckUnknowns(const camera::Estimate& estimate) const;
  void LeaveUnknowns(const std::string& method, Span span);
  void CheckTrail(const Trail& solved) const;
  void CheckNumbers(const Evaluation& evaluation, const Trial& trial, const model::State& solved,
                    const Traced& traced) const;
  model::Value UnknownValue(const UnknownInfo& info, const model::Value& start,
                            const model::Value* registers, Span span);
  model::Value WithError(model::Value number, Span span);
  std::string WordsOf(const Solvable& literal) const;  // "14 m ± 0.14 m"
  bool DependsOnUnknown(const model::Value& value) const;
  bool TakesUnknownText(const Instruction& i, const CodeUnit& unit,
                        const model::Value* registers) const;
  void RefuseUnknown(const model::Value& value, Span span, std::string_view as) const;
  void Decide(const model::Value& condition, Span span);
  void Print(std::string_view line);
  void PrintHeld();

  std::optional<model::SourceId> SourceOfDot(model::ElementId photograph, const geom::Vec2& dot_px,
                                             double noise_px);
  void EvaluateSolids(const model::Model& last) const;
  CallContext ContextOf(const Instruction& i, Span span);
  StageLinks LinksFor(bool is_script);
  [[noreturn]] void Throw(const OpFailure& failure, Span span, const CodeUnit* unit,
                          std::uint32_t at) const;

  const Program& program_;
  const RunOptions& options_;
  const Host& outer_host_;
  Host host_;                      // which holds back what is printed before `calibrate`
  std::vector<std::string> held_;  // those lines
  Budget budget_;
  Outcome outcome_;
  SourceList sources_;
  std::vector<Activation> innermost_;                               // by unit
  std::vector<ScopePlace> places_;                                  // by name scope
  std::vector<std::pair<std::uint32_t, ScopePlace>> outer_places_;  // of the groups that are open
  std::vector<std::uint32_t> turns_;
  std::vector<const model::Value*> turn_values_;  // the variables of the loops that are open
  std::uint64_t closures_made_ = 0;
  bool unsolved_ = false;         // `calibrate` stands in the script and is still to come
  const Trial* trial_ = nullptr;  // the values of the unknowns that this run tries, or none
  Trail trail_;
  std::map<std::tuple<model::ElementId, double, double>, model::SourceId> dot_sources_;
  std::vector<Solvable> solvables_;  // what can be solved for, as it was met: a source each
  std::optional<Slice> slice_;       // what was computed from these; until `calibrate`, of the run
  std::uint64_t stages_made_ = 0;
  std::shared_ptr<PhotographFiles> photographs_ = std::make_shared<PhotographFiles>();
  SolidLedger solids_{
      [this](std::uint64_t facets, Span span) { budget_.ChargeSteps(facets, span); }};
  int call_depth_ = 0;
  int definition_depth_ = 0;
  Stage* stage_ = nullptr;  // of the code that runs
  const Placement* placing_ = nullptr;
  std::vector<model::Interface>* interfaces_ = nullptr;  // of the definition being built
  std::map<std::pair<std::uint32_t, model::Hash128>, model::PrototypePtr> prototypes_;
  std::unordered_map<std::uint32_t, std::vector<std::pair<std::uint32_t, std::uint32_t>>> outer_;
  std::unordered_map<std::uint32_t, std::vector<std::pair<std::uint32_t, std::uint32_t>>>
      outer_names_;
};

}  // namespace tranos::interp
