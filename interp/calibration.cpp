// SPDX-License-Identifier: GPL-3.0-or-later
// `calibrate`: the statements before it are a function of the unknowns (evaluation.h), solved for,
// and run once more with the solved values, whose elements, values and messages then stand.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "camera/calibrate.h"
#include "camera/dlt.h"
#include "camera/estimation.h"
#include "camera/orthocentre.h"
#include "camera/paper_method.h"
#include "camera/sweep.h"
#include "camera/trace_checks.h"
#include "interp/camera_report.h"
#include "interp/commands/drawing.h"
#include "interp/commands/firing.h"
#include "interp/evaluation.h"
#include "interp/machine.h"
#include "interp/traced.h"
#include "interp/value_support.h"

namespace tranos::interp {

using model::ElementId;
using model::ElementPtr;
using model::Value;

struct Machine::Solution {
  const Evaluation& evaluation;
  const Traced& traced;
  const Host& silent;
  Eigen::VectorXd unknowns;
  std::vector<camera::Estimate> estimates;
};

namespace {

struct Method {
  std::string name = "likelihood";
  camera::SkewRange range;
};

camera::SkewRange RangeOf(const Answers& answers, Span span) {
  camera::SkewRange range;
  double to_rad = range.at(range.count - 1);
  if (const Value* skew = answers.Find("skew")) {
    const double degree = geom::kPi / 180;
    const double in_rad = skew->dimension().plain() ? degree : 1;
    range.from_rad = skew->range().from * in_rad;
    to_rad = skew->range().to * in_rad;
  }
  range.step_rad = answers.Number("step", range.step_rad);
  const double steps = (to_rad - range.from_rad) / range.step_rad;
  const bool is_skew = range.from_rad > 0.01 && to_rad < geom::kPi - 0.01;
  if (!is_skew || !(range.step_rad > 0) || !(steps >= 0) || steps > 100'000) {
    Fail(Code::kOutOfRange, span, "the skew angles to be tried are not a range with a step", "",
         "skew=88deg..92deg step=0.01deg");
  }
  range.count = static_cast<int>(std::floor(steps + 1e-6)) + 1;
  return range;
}

// By a method that gives the camera alone, without deviations.
geom::Result<camera::Estimate> EstimateBy(const Method& method,
                                          const camera::Photograph& photograph,
                                          const camera::Numbers& numbers) {
  camera::Estimate estimate;
  if (method.name == "sweep" || method.name == "paper") {
    const auto found = method.name == "sweep"
                           ? camera::CalibrateSweep(photograph, numbers, method.range)
                           : camera::CalibratePaper(photograph, numbers, method.range);
    if (!found) return tl::unexpected(found.error());
    estimate.camera = found->camera;
    estimate.chi2 = found->penalty;
    estimate.profile = found->curve;
    if (found->at_end)
      estimate.warnings.push_back("the least penalty is at an end of the skew angles");
    return estimate;
  }
  const auto found = method.name == "dlt" ? camera::CalibrateDlt(photograph, numbers)
                                          : camera::CalibrateOrthocentre(photograph, numbers);
  if (!found) return tl::unexpected(found.error());
  estimate.camera = *found;
  return estimate;
}

// Such a method knows of no deviations; but what the data that it uses leave open to the likeliest
// camera is open to all (docs/camera.md, "Determined, or not"). None of them uses priors.
void TellOpen(const Method& method, camera::Photograph photograph, const camera::Numbers& numbers,
              camera::Estimate* estimate) {
  for (camera::Prior& prior : photograph.priors) prior = {};
  if (method.name == "dlt") {
    std::erase_if(photograph.traces, [](const camera::Trace& trace) {
      return !std::holds_alternative<camera::EdgeTrace>(trace) &&
             !std::holds_alternative<camera::PointTrace>(trace);
    });
  }
  if (method.name == "orthocentre") {  // assumed, not seen
    for (const camera::Parameter p : {camera::kAspect, camera::kSkew}) {
      estimate->parameters[p].determined = false;
      estimate->parameters[p].from_prior = true;
    }
  }
  const auto likely = camera::Calibrate(photograph, numbers);
  if (!likely) return;
  estimate->undetermined = likely->undetermined;
  for (int i = 0; i < camera::kParameters; ++i) {
    camera::ParameterEstimate& parameter = estimate->parameters[i];
    if (!parameter.from_prior) parameter.determined = likely->parameters[i].determined;
  }
}

geom::Result<std::vector<camera::Estimate>> EstimatesBy(const Method& method, const Traced& traced,
                                                        const camera::Numbers& numbers) {
  std::vector<camera::Estimate> estimates;
  for (std::size_t p = 0; p < traced.photographs.size(); ++p) {
    auto estimate = EstimateBy(method, traced.photographs[p], numbers);
    if (!estimate) {
      return tl::unexpected(camera::ErrorAmong(traced.photographs, static_cast<std::ptrdiff_t>(p),
                                               std::move(estimate.error())));
    }
    TellOpen(method, traced.photographs[p], numbers, &*estimate);
    camera::AppendWeaknesses(traced.photographs[p], numbers, &estimate->camera, estimate->warnings);
    estimates.push_back(*std::move(estimate));
  }
  return estimates;
}

}  // namespace

Fired Machine::Calibrate(const Answers& answers, const model::State& state, Span span) {
  if (trial_) EndTrial();
  const Traced traced = TracedIn(state);
  if (traced.photographs.empty()) {
    Fail(Code::kNoPhotograph, span, "there is no photograph to calibrate", "",
         "attach photo \"fire_1917.png\" format=40.5mm,26.7mm as fire");
  }
  const Host silent{.read = host_.read, .render_photo = host_.render_photo};
  Evaluation evaluation(*this, silent, state, traced, span);
  const Method method{answers.Text("method", "likelihood"), RangeOf(answers, span)};
  Eigen::VectorXd start(static_cast<Eigen::Index>(evaluation.unknowns().size()));
  for (Eigen::Index k = 0; k < start.size(); ++k) {
    start[k] = evaluation.unknowns()[static_cast<std::size_t>(k)].start;
  }
  const auto evaluate = [&](const Eigen::VectorXd& unknowns) { return evaluation(unknowns); };
  geom::Result<std::vector<camera::Estimate>> found;
  Eigen::VectorXd solved = start;
  if (method.name == "likelihood") {
    camera::CalibrateOptions options;
    options.loss = answers.Flag("robust") ? camera::Loss::kCauchy : camera::Loss::kNone;
    options.noise_px = traced.noise_px;
    options.noise_is_estimated = traced.noise_is_estimated;
    if (answers.Has("skew")) options.profile = method.range;
    options.given_planes = traced.given_planes;
    options.trials = static_cast<int>(std::min(answers.Number("trials"), 100'000.0));
    found = camera::Calibrate(traced.photographs, evaluation.unknowns(), evaluate, options);
    if (found) {
      for (Eigen::Index k = 0; k < solved.size(); ++k) {
        solved[k] = (*found)[0].unknowns[static_cast<std::size_t>(k)].value;
      }
    }
  } else {
    const std::pair<const char*, bool> given[] = {{"robust", answers.Flag("robust")},
                                                  {"trials", answers.Number("trials") > 0}};
    for (const auto& [key, is_given] : given) {
      if (!is_given) continue;
      Fail(Code::kOutOfRange, span,
           fmt::format("`{}=` has no part in `method={}`", key, method.name), "",
           "`method=likelihood` takes it");
    }
    LeaveUnknowns(method.name, span);
    const auto numbers = evaluation(start);
    found = numbers ? EstimatesBy(method, traced, *numbers)
                    : geom::Result<std::vector<camera::Estimate>>(tl::unexpected(numbers.error()));
  }
  // What ends a run is no trial that failed.
  if (evaluation.failure() && (!found || IsLimit(evaluation.failure()->diagnostic.code))) {
    throw *evaluation.failure();
  }
  if (!found) FailCalibration(found.error(), evaluation, traced, span);
  CheckUnknowns((*found)[0]);
  return Calibrated({evaluation, traced, silent, solved, *std::move(found)}, state, span);
}

namespace {

// What is said of the directions that an unknown is part of: others are closed by something else.
std::string OpenWith(const camera::Estimate& estimate, const std::string& unknown) {
  const auto said = std::ranges::find_if(estimate.undetermined, [&](const std::string& sentence) {
    return sentence.find("`" + unknown + "`") != std::string::npos;
  });
  return said == estimate.undetermined.end() ? "" : *said;
}

}  // namespace

// An unknown that nothing determines is an error, for elements may be built with it.
void Machine::CheckUnknowns(const camera::Estimate& estimate) const {
  for (const camera::UnknownEstimate& unknown : estimate.unknowns) {
    if (unknown.name.empty() || unknown.determined) continue;
    for (const UnknownInfo& info : program_.unknowns) {
      if (info.name != unknown.name) continue;
      Fail(Code::kNotDetermined, info.span, "nothing traced determines `" + unknown.name + "`",
           OpenWith(estimate, unknown.name),
           "say what is known of it, as by `unknown " + unknown.name +
               " = 4m +- 10%`, or trace what tells it");
    }
  }
}

// The methods that find the camera alone take unknowns as they start.
void Machine::LeaveUnknowns(const std::string& method, Span span) {
  for (const UnknownInfo& info : program_.unknowns) {
    if (info.is_free) {
      Fail(Code::kNotCalibrated, info.span,
           "`" + info.name + "` has no start, and `method=" + method + "` solves for no unknowns",
           "", "`method=likelihood` does");
    }
    outcome_.diagnostics.Add(
        {Code::kUnknownUnsolved, span,
         "`" + info.name + "` keeps its start: `method=" + method + "` solves for no unknowns", "",
         "`method=likelihood` does"});
  }
}

// Which trace has this index, counted through the photographs.
std::optional<Span> Machine::FindTrace(const Traced& traced, int index) const {
  for (std::size_t p = 0; p < traced.trace_ids.size() && index >= 0; ++p) {
    const auto& ids = traced.trace_ids[p];
    const int count = static_cast<int>(ids.size());
    if (index < count) {
      return stage_->trace_spans().at(ids[static_cast<std::size_t>(index)]);
    }
    index -= count;
  }
  return std::nullopt;
}

// Where the trace or, after all traces, the unknown or dimension with this index was written.
std::optional<Span> Machine::FindPart(const Evaluation& evaluation, const Traced& traced,
                                      int part) const {
  if (part < 0) return std::nullopt;
  if (const auto trace = FindTrace(traced, part)) return trace;
  const std::size_t unknown = static_cast<std::size_t>(part) - traced.trace_count();
  return solvables_[evaluation.sources()[unknown]].span;
}

// The error with the traces at fault.
void Machine::FailCalibration(const geom::Error& error, const Evaluation& evaluation,
                              const Traced& traced, Span span) const {
  Code code = Code::kNotCalibrated;
  if (error.code == geom::ErrorCode::kOutOfRange) code = Code::kTracesDisagree;
  const auto part = FindPart(evaluation, traced, error.part);
  if (!part) {
    Fail(code, span, error.detail, "",
         "`tranos explain " + std::string(InfoOf(code).code) + "` says more");
  }
  if (code == Code::kNotCalibrated) code = Code::kBadTrace;
  std::vector<Note> notes;
  if (const auto other = FindPart(evaluation, traced, error.other)) {
    notes.push_back({*other, "the other one"});
  }
  notes.push_back({span, "calibrated here"});
  const bool is_trace = FindTrace(traced, error.part).has_value();
  Fail(code, *part, error.detail, is_trace ? "this trace" : "", "", std::move(notes));
}

void Machine::WarnOfDisagreement(const camera::Disagreement& disagreement,
                                 const Evaluation& evaluation, const Traced& traced, Span span) {
  const auto part = FindPart(evaluation, traced, disagreement.part);
  std::vector<Note> notes;
  if (const auto other = FindPart(evaluation, traced, disagreement.other_part)) {
    notes.push_back({*other, "the other one"});
  }
  if (part) notes.push_back({span, "calibrated here"});
  outcome_.diagnostics.Add(
      {Code::kCameraWeak, part.value_or(span), disagreement.text, "", "", std::move(notes)});
}

namespace {

// A facade that stood in the model keeps its origin; it moves as the adjustment has it.
ElementPtr GivenFacade(const model::Element& given, camera::FacadeEstimate estimate) {
  const model::Facade& facade = model::FacadeOf(given);
  const double along_m = (facade.plane.origin - estimate.plane.origin).dot(estimate.plane.x);
  estimate.plane = facade.plane;
  if (estimate.deviations.cols() > 0)
    estimate.deviations.row(0) -= along_m * estimate.deviations.row(2);
  return model::WithMoved(given, MovedFacade(facade.name, estimate, facade.solved));
}

// Facades that traces declared, as they were found; those that were there, with their deviations.
void AdoptFacades(const std::vector<camera::FacadeEstimate>& found, const Traced& traced,
                  const model::State& solved, model::Edit* edit) {
  for (std::size_t i = 0; i < std::min(found.size(), traced.facades.size()); ++i) {
    const std::string& name = traced.facades[i];
    if (const ElementPtr given = model::FindFacade(solved.model, name)) {
      std::erase_if(edit->replaced,
                    [&](const ElementPtr& replaced) { return replaced->id == given->id; });
      edit->replaced.push_back(GivenFacade(*given, found[i]));
    } else if (found[i].determined) {
      const int index = static_cast<int>(i);
      edit->added.push_back(
          model::WithMoved(*NewElement(solved, FacadeGeometry(name, found[i].plane, index)),
                           MovedFacade(name, found[i], index)));
    }
  }
}

}  // namespace

// The state as the solution makes it: what depends on unknowns, and the photographs' cameras.
Fired Machine::Calibrated(Solution solution, const model::State& before, Span span) {
  auto& [evaluation, traced, silent, solved, found] = solution;
  Trial trial = evaluation.TrialOf(solved);
  std::erase_if(trial.values, [&](const auto& value) {
    return solvables_[value.first].unknown.name.empty();  // literals stay as they are stated
  });
  // All cameras and unknowns of the adjustment vary with the same sources.
  const Eigen::MatrixXd& deviations = found[0].deviations;
  const Eigen::MatrixXd factor =
      deviations.bottomRows(std::max<Eigen::Index>(deviations.rows() - camera::kParameters, 0));
  for (std::size_t k = 0; k < evaluation.sources().size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    if (row < factor.rows()) trial.rows[evaluation.sources()[k]] = row;
  }
  trial.factor = &factor;
  TrialRun run(*this, silent, trial);
  run.Run();
  CheckTrail(run.machine().trail_);
  CheckNumbers(evaluation, trial, run.state(), traced);
  Fired fired;
  fired.edit = Adopt(run, before, span);
  if (found[0].disagreement) WarnOfDisagreement(*found[0].disagreement, evaluation, traced, span);
  AdoptFacades(found[0].facades, traced, run.state(), &fired.edit);
  for (std::size_t p = 0; p < found.size(); ++p) {
    const ElementPtr element = run.state().model.Current(traced.photograph_ids[p]);
    model::Photograph photograph = *std::get<model::PhotographPtr>(element->geometry);
    for (const std::size_t source : evaluation.sources()) {
      photograph.unknown_dimensions.push_back(solvables_[source].dimension);
    }
    Warn(found[p], *element, traced.trace_ids[p], span);
    WarnOfOrthophotos(run.state().model, element->id, span);
    photograph.camera_file.clear();
    photograph.estimate = std::make_shared<const camera::Estimate>(std::move(found[p]));
    std::erase_if(fired.edit.replaced,
                  [&](const ElementPtr& replaced) { return replaced->id == element->id; });
    fired.edit.replaced.push_back(model::WithGeometry(
        *element, std::make_shared<const model::Photograph>(std::move(photograph))));
  }
  PrintHeld();
  return fired;
}

// Those that were made with the camera that the photograph came with.
void Machine::WarnOfOrthophotos(const model::Model& model, ElementId photograph, Span span) {
  model.ForEach([&](const ElementPtr& element) {
    const auto* made = std::get_if<model::OrthophotoPtr>(&element->geometry);
    if (!made || (*made)->photograph->id != photograph) return;
    outcome_.diagnostics.Add(
        {Code::kTakesNoPart, span,
         fmt::format("{} was made before, with the camera that the photograph came with, and keeps "
                     "it",
                     NameForMessage(*element)),
         "", "`construct orthophoto` after `calibrate` has the camera that it finds"});
  });
}

void Machine::Warn(const camera::Estimate& estimate, const model::Element& photograph,
                   const std::vector<ElementId>& trace_ids, Span span) {
  const std::string name = photograph.name ? "`" + Printable(*photograph.name) + "`: " : "";
  for (const std::string& open : estimate.undetermined) {
    outcome_.diagnostics.Add({Code::kCameraOpen, span, name + open, "", ""});
  }
  for (const std::string& warning : estimate.warnings) {
    outcome_.diagnostics.Add({Code::kCameraWeak, span, name + warning, "", ""});
  }
  if (!estimate.alternatives.empty()) {
    outcome_.diagnostics.Add({Code::kCameraWeak, span,
                              name + "a second pose explains the traces within their noise", "",
                              "`recover camera facade=…` or `near=…` chooses; `report camera` "
                              "shows both"});
  }
  for (const camera::TraceResidual& residual : estimate.residuals) {
    if (residual.weight >= 0.5) continue;
    const ElementId id = trace_ids[static_cast<std::size_t>(residual.trace)];
    outcome_.diagnostics.Add(
        {Code::kTraceDoubted, stage_->trace_spans().at(id),
         fmt::format("{}this trace is given {:.0f} % of its weight", name, 100 * residual.weight),
         "doubted", ""});
  }
}

// Picks and branches were decided at the start values; a solution that decides otherwise is none.
void Machine::CheckTrail(const Trail& solved) const {
  const std::size_t common = std::min(trail_.size(), solved.size());
  for (std::size_t i = 0; i < common; ++i) {
    if (trail_[i].what == solved[i].what) continue;
    Fail(Code::kChoiceChanged, trail_[i].span,
         "with the solved values of the unknowns this goes another way", "decided here",
         "give the unknowns starts nearer to their solution, or choose by name");
  }
  if (trail_.size() != solved.size()) {
    const Trail& longer = trail_.size() > solved.size() ? trail_ : solved;
    Fail(Code::kChoiceChanged, longer[common].span,
         "with the solved values of the unknowns the script decides something else here");
  }
}

// A number that a function such as `round` made may have jumped.
void Machine::CheckNumbers(const Evaluation& evaluation, const Trial& trial,
                           const model::State& solved, const Traced& traced) const {
  for (const std::size_t number : evaluation.Beyond(TracedIn(solved), trial)) {
    if (evaluation.is_read_off(number)) continue;
    Fail(Code::kChoiceChanged, stage_->trace_spans().at(traced.number_owners[number]),
         "with the solved values of the unknowns this trace stands on another number", "",
         "do not round what depends on an unknown, or give the unknowns starts nearer to their "
         "solution");
  }
}

namespace {

// A trace's numbers hang on the sources of the run that made it.
bool HasUncertainNumbers(const model::Element& element) {
  const auto* trace = std::get_if<model::TracePtr>(&element.geometry);
  return trace && std::ranges::any_of((*trace)->numbers, [](const Value& number) {
           return number.derivatives() != nullptr;
         });
}

}  // namespace

// Everything before `calibrate` as the solved values make it, and the edit that leads there.
model::Edit Machine::Adopt(TrialRun& solved, const model::State& before, Span span) {
  model::Edit edit;
  const model::State& after = solved.state();
  const auto& entries = before.model.entries;
  const auto differs = [&](ElementId id) {
    const model::Entry &from = entries[id], &to = after.model.entries[id];
    return from.standing != to.standing || !from.element != !to.element ||
           (from.element && from.element->geometry.index() != to.element->geometry.index());
  };
  bool changed = entries.size() != after.model.entries.size();
  for (ElementId id = 0; id < entries.size() && !changed; ++id) changed = differs(id);
  if (changed) {
    Fail(Code::kChoiceChanged, span,
         "with the solved values of the unknowns other elements are made", "",
         "give the unknowns starts nearer to their solution");
  }
  for (ElementId id = 0; id < entries.size(); ++id) {
    const model::Entry &from = entries[id], &to = after.model.entries[id];
    const bool by_itself =
        from.standing == model::Standing::kInModel || from.standing == model::Standing::kConsumed;
    if (!by_itself || !to.element) continue;
    if (from.element->hash != to.element->hash || HasUncertainNumbers(*to.element)) {
      edit.replaced.push_back(to.element);
    }
  }
  edit.settings = after.drawing.settings;
  edit.last_point = after.drawing.last_point;
  std::copy(solved.registers().begin(), solved.registers().end(), innermost_[0].registers);
  Machine& machine = solved.machine();
  budget_.steps_left -= solved.steps();
  held_ = std::move(machine.held_);
  sources_ = std::move(machine.sources_);
  prototypes_ = std::move(machine.prototypes_);
  closures_made_ = machine.closures_made_;
  outcome_.diagnostics = std::move(machine.outcome_.diagnostics);
  outcome_.asserts = std::move(machine.outcome_.asserts);
  outcome_.outputs = std::move(machine.outcome_.outputs);
  outcome_.output_spans = std::move(machine.outcome_.output_spans);
  return edit;
}

bool Machine::DependsOnUnknown(const Value& value) const {
  if (value.is_list() && value.list().size() <= 3) {
    return std::any_of(value.list().begin(), value.list().end(),
                       [&](const Value& item) { return DependsOnUnknown(item); });
  }
  if (value.from_unknown()) return true;
  if (value.is_string()) return slice_ && slice_->HoldsText(value);
  if (value.kind() != Value::Kind::kUncertain) return false;
  const auto& terms = value.derivatives()->terms;
  return std::any_of(terms.begin(), terms.end(), [&](const auto& term) {
    return term.first < sources_.size() && !sources_[term.first].name.empty();
  });
}

void Machine::RefuseUnknown(const Value& value, Span span, std::string_view as) const {
  if (!DependsOnUnknown(value)) return;
  Fail(Code::kUnknownDecides, span,
       fmt::format("{} depends on an unknown before `calibrate` has found it", as), "",
       "write it after `calibrate`");
}

void Machine::Decide(const Value& condition, Span span) {
  if (!unsolved_) return;
  if (condition.from_unknown()) RefuseUnknown(condition, span, "a condition");
  trail_.push_back({span, condition.boolean()});
}

std::string Machine::WordsOf(const Solvable& literal) const {
  const SourceList own{{literal.unknown.sigma, ""}};
  const Value stated = Value::Uncertain({literal.stated, {{{0, 1.0}}}}, literal.dimension);
  return Format(stated, program_.measures[0], -1, &own);
}

// A number with the error that this run tries for the literal it was just made with.
Value Machine::WithError(Value number, Span span) {
  if (!unsolved_) return number;
  const std::size_t met = solvables_.size();
  solvables_.push_back({{"", 0, sources_.back().sigma}, number.dimension(), span, number.number()});
  if (!trial_) return number;
  const auto error = trial_->values.find(met);
  if (error == trial_->values.end()) return number;
  sources_.back().tried = error->second;
  return Value::Uncertain({number.number() + error->second, *number.derivatives()},
                          number.dimension());
}

Value Machine::UnknownValue(const UnknownInfo& info, const Value& start, const Value* r,
                            Span span) {
  if (!start.is_number()) {
    Fail(Code::kWrongType, span, "an unknown is a number, not " + Describe(start));
  }
  if (!unsolved_) {
    if (info.is_free) {
      Fail(Code::kUnknownDecides, span,
           "`" + info.name + "` has no start, and nothing solves for it", "",
           program_.calibrates
               ? "write it before `calibrate`, which solves for what stands before it"
               : "`calibrate` would; or give it a start: `unknown " + info.name + " = 4m`");
    }
    outcome_.diagnostics.Add(
        {Code::kUnknownUnsolved, span,
         "`" + info.name + "` keeps its start, " + Format(start, program_.measures[0], -1), "",
         program_.calibrates ? "write it before `calibrate`, which solves for what stands before it"
                             : "`calibrate` would solve for it"});
    return start;
  }
  Solvable solvable{{info.name, start.number(), Sigma(start, sources_)}, start.dimension(), span};
  if (info.range != UnknownInfo::kNoRange && r[info.range].kind() == Value::Kind::kRange) {
    Value from = Value::Number(r[info.range].range().from, r[info.range].dimension());
    Value to = Value::Number(r[info.range].range().to, r[info.range].dimension());
    solvable.unknown.min = ReadBare(from, start.dimension(), program_.measures[0]).number();
    solvable.unknown.max = ReadBare(to, start.dimension(), program_.measures[0]).number();
  }
  // The deviation is now the unknown's own, and the literal's no longer.
  const model::Derivatives* derivatives = start.derivatives();
  if (derivatives && derivatives->terms.size() == 1 &&
      derivatives->terms[0].first + std::size_t{1} == sources_.size() && !solvables_.empty()) {
    solvables_.back().taken_by_unknown = true;
  }
  const std::size_t met = solvables_.size();
  solvables_.push_back(solvable);
  const auto source = static_cast<model::SourceId>(sources_.size());
  const double value =
      trial_ && trial_->values.contains(met) ? trial_->values.at(met) : start.number();
  if (trial_ && trial_->factor) {  // solved: what it varies with is known
    model::Derivatives shared;
    const auto row = trial_->rows.find(met);
    for (Eigen::Index j = 0; row != trial_->rows.end() && j < trial_->factor->cols(); ++j) {
      const double slope = (*trial_->factor)(row->second, j);
      if (slope != 0) shared.terms.emplace_back(static_cast<model::SourceId>(j), slope);
    }
    sources_.push_back({0, ""});
    if (shared.terms.empty()) return Value::Number(value, start.dimension());
    return Value::Uncertain({value, std::move(shared)}, start.dimension());
  }
  sources_.push_back({solvable.unknown.sigma, info.name});
  return Value::Uncertain({value, {{{source, 1.0}}}}, start.dimension());
}

}  // namespace tranos::interp
