// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/evaluation.h"

#include <algorithm>
#include <cmath>

#include "interp/value_support.h"

namespace tranos::interp {

using model::Value;

namespace {

// Thrown by a trial's `calibrate`: it has all it ran for.
struct Reached {};

// A step for differences by an unknown, where a trace is read off an element.
double DifferenceStep(double value) { return 1e-6 * std::max(1.0, std::abs(value)); }

// But for the order of sums.
bool IsSame(double a, double b) { return std::abs(a - b) <= 1e-12 * (1 + std::abs(a)); }

}  // namespace

void Machine::EndTrial() { throw Reached{}; }

Machine::TrialRun::TrialRun(const Machine& main, const Host& silent, const Trial& trial)
    : options_{main.budget_.limits, {}, {}, {}},
      machine_(main.program_, options_, silent),
      steps_before_(main.budget_.steps_left) {
  machine_.budget_.steps_left = main.budget_.steps_left;  // what is left of the whole run
  machine_.trial_ = &trial;
  machine_.slice_.reset();
  machine_.photographs_ = main.photographs_;
  if (trial.factor) {
    // The solved numbers' sources come first, so that all runs number the others alike.
    machine_.sources_.assign(static_cast<std::size_t>(trial.factor->cols()), {1, ""});
  }
}

void Machine::TrialRun::Run() {
  Stage stage(machine_.LinksFor(true), true);
  machine_.stage_ = &stage;
  machine_.places_[0] = {&stage, 0};
  registers_.resize(machine_.program_.units[0].registers);
  try {
    machine_.Execute(0, registers_.data(), 0, &stage);
  } catch (const Reached&) {
  }
  state_ = stage.state();
}

Machine::Evaluation::Evaluation(Machine& main, const Host& silent, const model::State& state,
                                const Traced& start, Span span)
    : main_(main), silent_(silent), state_(state), start_(start), span_(span) {
  main_.slice_->KeepFor(start_.numbers, start_.elements);
  FindReadOff();
  FindUnknowns();
}

bool Machine::Evaluation::CanMove(std::size_t source) const {
  const Solvable& solvable = main_.solvables_[source];
  if (solvable.taken_by_unknown) return false;
  return !solvable.unknown.name.empty() || solvable.unknown.sigma > 0;
}

// The start with these sources a little aside, each by its own step, within its bounds.
Machine::Trial Machine::Evaluation::Moved(const std::vector<std::size_t>& sources) const {
  Trial trial;
  for (const std::size_t source : sources) {
    const camera::Unknown& unknown = main_.solvables_[source].unknown;
    const double step =
        DifferenceStep(unknown.start) / (1 + std::fmod(0.618 * static_cast<double>(source), 1.0));
    trial.values[source] =
        unknown.start + step <= unknown.max ? unknown.start + step : unknown.start - step;
  }
  return trial;
}

void Machine::Evaluation::FindReadOff() {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < main_.solvables_.size(); ++i) {
    if (CanMove(i)) all.push_back(i);
  }
  if (all.empty() || start_.numbers.empty()) return;
  const Trial trial = Moved(all);
  const Traced traced = Traces(trial);
  read_off_ = Beyond(traced, trial);
  if (read_off_.empty()) return;
  const Traced placed = TracesPlaced(trial);
  places_ = std::all_of(read_off_.begin(), read_off_.end(), [&](std::size_t number) {
    return IsSame(placed.numbers[number].number(), traced.numbers[number].number());
  });
  FindMovers(all);
}

// By halves: few of many sources move what is read off elements.
void Machine::Evaluation::FindMovers(const std::vector<std::size_t>& sources) {
  const Trial trial = Moved(sources);
  if (Beyond(TracesBeyond(trial), trial).empty()) return;
  if (sources.size() == 1) {
    movers_.insert(sources[0]);
    return;
  }
  const auto half = sources.begin() + static_cast<std::ptrdiff_t>(sources.size() / 2);
  FindMovers({sources.begin(), half});
  FindMovers({half, sources.end()});
}

// All unknowns, and each `+-` literal that a trace depends on.
void Machine::Evaluation::FindUnknowns() {
  std::set<std::size_t> wanted = movers_;
  for (const Value& number : start_.numbers) {
    if (!number.derivatives()) continue;
    for (const auto& [source, slope] : number.derivatives()->terms) wanted.insert(source);
  }
  for (std::size_t i = 0; i < main_.solvables_.size(); ++i) {
    const camera::Unknown& unknown = main_.solvables_[i].unknown;
    if (!CanMove(i) || (unknown.name.empty() && !wanted.contains(i))) continue;
    column_[i] = static_cast<Eigen::Index>(sources_.size());
    sources_.push_back(i);
    unknowns_.push_back(unknown);
    if (unknown.name.empty()) unknowns_.back().words = main_.WordsOf(main_.solvables_[i]);
  }
}

Machine::Trial Machine::Evaluation::TrialOf(const Eigen::VectorXd& unknowns) const {
  Trial trial;
  for (std::size_t k = 0; k < sources_.size(); ++k) {
    trial.values[sources_[k]] = unknowns[static_cast<Eigen::Index>(k)];
  }
  return trial;
}

// `+-` of the slice: the errors that are tried, from the sources that it first added.
Value Machine::Evaluation::WithErrors(const Trial& trial, const Slice::Operation& operation,
                                      const Value* registers) const {
  const Instruction& i = operation.unit->code[operation.at];
  const Value* const k = operation.unit->constants.data();
  std::size_t source = operation.source;
  return ForEachCoordinate(Get(i.b, registers, k), [&](const Value& value) {
    SourceList own;
    const Value number = PlusMinus(value, Get(i.c, registers, k), i.flags & 1,
                                   {&main_.program_.measures[i.n], &own});
    model::Derivatives derivatives = *number.derivatives();
    derivatives.terms.back().first = static_cast<model::SourceId>(source);
    const auto tried = trial.values.find(source++);
    const double error = tried == trial.values.end() ? 0 : tried->second;
    return Value::Uncertain({number.number() + error, std::move(derivatives)}, number.dimension());
  });
}

// One operation of the slice, its registers filled in.
Value Machine::Evaluation::Again(const Trial& trial, const Slice::Operation& operation,
                                 Value* registers) const {
  const CodeUnit& unit = *operation.unit;
  const Instruction& i = unit.code[operation.at];
  const Span span = unit.spans[operation.at];
  if (i.op == Op::kUnknown) {
    const auto tried = trial.values.find(operation.source);
    const double value = tried == trial.values.end() ? operation.result.number() : tried->second;
    return Value::Uncertain({value, *operation.result.derivatives()}, operation.result.dimension());
  }
  try {
    if (i.op == Op::kPlusMinus) return WithErrors(trial, operation, registers);
    main_.ComputeValue(i, unit, registers, span);
    return registers[i.a];
  } catch (const OpFailure& failure) {
    main_.Throw(failure, span, &unit, operation.at);
  }
}

Slice::Known Machine::Evaluation::Known(const Trial& trial) const {
  main_.budget_.ChargeSteps(main_.slice_->size(), span_);
  return main_.slice_->Evaluated([&](const Slice::Operation& operation, Value* registers) {
    return Again(trial, operation, registers);
  });
}

std::vector<Value> Machine::Evaluation::Sliced(const Trial& trial) const {
  const Slice::Known known = Known(trial);
  std::vector<Value> now;
  for (const Value& number : start_.numbers) now.push_back(Slice::Now(number, known));
  return now;
}

std::set<std::size_t> Machine::Evaluation::Beyond(const Traced& traced, const Trial& trial) const {
  CheckCount(traced);
  const std::vector<Value> sliced = Sliced(trial);
  std::set<std::size_t> beyond;
  for (std::size_t i = 0; i < sliced.size(); ++i) {
    if (!IsSame(sliced[i].number(), traced.numbers[i].number())) beyond.insert(i);
  }
  return beyond;
}

// What everything before `calibrate` gives.
Traced Machine::Evaluation::Traces(const Trial& trial) const {
  TrialRun run(main_, silent_, trial);
  try {
    run.Run();
  } catch (RunFailure& failure) {
    if (failure.diagnostic.code == Code::kStepLimit) failure.diagnostic.span = span_;
    throw;
  }
  main_.budget_.ChargeSteps(run.steps(), span_);
  Traced traced = TracedIn(run.state());
  CheckCount(traced);
  return traced;
}

// What the traces' elements give, placed again.
Traced Machine::Evaluation::TracesPlaced(const Trial& trial) const {
  const Slice::Known known = Known(trial);
  model::Edit edit;
  for (const Slice::Firing& firing : main_.slice_->firings()) {
    const model::ElementPtr current = state_.model.Current(firing.placed);
    if (!current) continue;
    const CommandResult placed =
        firing.row->execute(firing.before, main_.slice_->Now(firing, known));
    if (!placed) Fail(placed.error().code, span_, placed.error().message);
    edit.replaced.push_back(model::WithGeometry(*current, placed->edit.added.front()->geometry));
  }
  return TracedIn(model::Apply(state_, edit).state);
}

Traced Machine::Evaluation::TracesBeyond(const Trial& trial) const {
  return places_ ? TracesPlaced(trial) : Traces(trial);
}

void Machine::Evaluation::CheckCount(const Traced& traced) const {
  if (traced.numbers.size() == start_.numbers.size()) return;
  Fail(Code::kChoiceChanged, span_, "other traces are made with other values of the unknowns", "",
       "give the unknowns starts nearer to their solution");
}

geom::Result<camera::Numbers> Machine::Evaluation::operator()(const Eigen::VectorXd& unknowns) {
  try {
    const std::vector<Value> now = Sliced(TrialOf(unknowns));
    camera::Numbers numbers{
        ValuesOf(now),
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(now.size()), unknowns.size())};
    for (std::size_t i = 0; i < now.size(); ++i) {
      const model::Derivatives* derivatives = now[i].derivatives();
      if (!derivatives) continue;
      for (const auto& [source, slope] : derivatives->terms) {
        const auto column = column_.find(source);
        if (column == column_.end()) continue;
        numbers.by_unknown(static_cast<Eigen::Index>(i), column->second) = slope;
      }
    }
    if (!read_off_.empty()) AddReadOff(unknowns, &numbers);
    return numbers;
  } catch (const RunFailure& failure) {
    // What ends a run stays what failed, whatever fails after it.
    if (!failure_ || !IsLimit(failure_->diagnostic.code)) failure_ = failure;
    return tl::unexpected(geom::Error{geom::ErrorCode::kOutOfRange, failure.diagnostic.message});
  }
}

// Elements carry no derivatives: what is read off them is evaluated on both sides, for each source
// that moves it. The solver asks again for what it has seen, from other starts of the camera.
const Machine::ReadOff& Machine::Evaluation::ReadOffAt(const Eigen::VectorXd& unknowns) {
  std::vector<double> moved;
  for (const std::size_t source : movers_) moved.push_back(unknowns[column_.at(source)]);
  constexpr std::size_t kMostKept = 64;
  if (known_.size() > kMostKept) known_.clear();
  const auto known = known_.find(moved);
  if (known != known_.end()) return known->second;
  const auto values_at = [&](const Eigen::VectorXd& at) {
    const Eigen::VectorXd all = ValuesOf(TracesBeyond(TrialOf(at)).numbers);
    Eigen::VectorXd values(static_cast<Eigen::Index>(read_off_.size()));
    Eigen::Index n = 0;
    for (const std::size_t number : read_off_) {
      values[n++] = all[static_cast<Eigen::Index>(number)];
    }
    return values;
  };
  ReadOff found{values_at(unknowns), {}};
  for (const std::size_t source : movers_) {
    const Eigen::Index k = column_.at(source);
    const double step = DifferenceStep(unknowns[k]);
    Eigen::VectorXd beside = unknowns;
    beside[k] += step;
    const Eigen::VectorXd after = values_at(beside);
    beside[k] -= 2 * step;
    found.slopes.emplace_back((after - values_at(beside)) / (2 * step));
  }
  return known_.emplace(std::move(moved), std::move(found)).first->second;
}

// Puts what is read off elements into its rows.
void Machine::Evaluation::AddReadOff(const Eigen::VectorXd& unknowns, camera::Numbers* numbers) {
  const ReadOff& read = ReadOffAt(unknowns);
  Eigen::Index n = 0;
  for (const std::size_t number : read_off_) {
    const auto row = static_cast<Eigen::Index>(number);
    numbers->values[row] = read.values[n];
    numbers->by_unknown.row(row).setZero();
    auto slopes = read.slopes.begin();
    for (const std::size_t source : movers_) {
      numbers->by_unknown(row, column_.at(source)) = (*slopes++)[n];
    }
    ++n;
  }
}

}  // namespace tranos::interp
