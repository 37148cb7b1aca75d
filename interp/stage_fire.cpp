// SPDX-License-Identifier: GPL-3.0-or-later
// Firing: from answers to an edit to the next state; how commands end; undo and redo.
#include <algorithm>
#include <cmath>

#include "interp/commands/firing.h"
#include "interp/deviations.h"
#include "interp/functions.h"
#include "interp/pick.h"
#include "interp/stage.h"

namespace tranos::interp {

using geom::Vec3;
using model::ElementId;
using model::ElementPtr;
using model::Value;

namespace {

constexpr std::string_view kChooseHelp =
    "choose first: `choose element;xy=…`, `choose all`; or give it: `of=NAME`";

bool TakesChosen(const Command& row) {
  return std::any_of(row.keys.begin(), row.keys.end(), [](const Key& key) {
    return key.name == "of" && key.type == Type::kElements;
  });
}

}  // namespace

Span Stage::SpanOf(const Where& where) const {
  const auto index = static_cast<std::size_t>(std::max(where.index, 0));
  switch (where.kind) {
    case Where::kCommand:
      break;
    case Where::kKey:
      if (const KeyAnswer* key = FindKey(where.key)) return key->span;
      break;
    case Where::kPoint:
      if (index < active_.point_spans.size()) return active_.point_spans[index];
      break;
    case Where::kChosen:
      if (const KeyAnswer* key = FindOf()) return key->span;
      break;
  }
  return active_.span;
}

Diagnostic Stage::MakeDiagnostic(const CommandError& error) const {
  return {error.code, SpanOf(error.where), error.message, error.label, error.help};
}

void Stage::AddChosen(const ElementPtr& element, Span span, ChosenOnce* out) const {
  const model::Model& model = state_.model;
  if (element->id < model.entries.size()) {
    const model::Standing standing = model.entries[element->id].standing;
    const std::string name = element->name ? "`" + Printable(*element->name) + "`" : "the element";
    if (standing == model::Standing::kDeleted)
      Fail(Code::kNoLongerThere, span, name + " was deleted");
    const ElementPtr current = model.Current(element->id);
    if (out->ids.insert(element->id).second) out->elements.push_back(current);
    return;
  }
  out->elements.push_back(element);  // a part of a placed element: geometry alone
}

// The `of=` that the next firing works on: a picking command's counts once, a transforming one's
// until a firing leaves something chosen.
const Stage::KeyAnswer* Stage::FindWorkingOf() const {
  const KeyAnswer* of = FindOf();
  if (!of || active_.selected) return nullptr;
  const bool picking =
      active_.row->manner == Manner::kPicks || active_.row->manner == Manner::kEdits;
  return picking && of->used ? nullptr : of;
}

std::vector<ElementPtr> Stage::Chosen(Span span) const {
  ChosenOnce out;
  if (const KeyAnswer* of = FindWorkingOf()) {
    for (const Value& item : of->value.list()) AddChosen(item.element(), of->span, &out);
    return std::move(out.elements);
  }
  const bool picking =
      active_.row->manner == Manner::kPicks || active_.row->manner == Manner::kEdits;
  // What was chosen before is used by a picking command's first firing alone.
  if (!picking || active_.firings == 0) {
    for (ElementId id : state_.drawing.selection) AddChosen(state_.model.Current(id), span, &out);
  }
  for (ElementId id : active_.picks) AddChosen(state_.model.Current(id), span, &out);
  return std::move(out.elements);
}

std::size_t Stage::ChosenCount() const {
  if (const KeyAnswer* of = FindWorkingOf()) return of->value.list().size();
  const bool picking =
      active_.row->manner == Manner::kPicks || active_.row->manner == Manner::kEdits;
  std::size_t count = active_.picks.size();
  if (!picking || active_.firings == 0) count += state_.drawing.selection.size();
  return count;
}

void Stage::PickOrAccept(const Vec3& point, Span span) {
  const PickResult pick = Pick(state_, point);
  if (!pick.within) {
    const std::size_t chosen = ChosenCount();
    if (chosen == 0) return;
    if (chosen < static_cast<std::size_t>(active_.row->least)) TooFew(span);
    return Fire(span);
  }
  if (pick.ambiguous) {
    links_.diagnostics->Add({Code::kAmbiguousPick, span, "several elements are equally near",
                             "the one made last is picked",
                             "pick at another place, or give `of=NAME`"});
  }
  const ElementId id = pick.element->id;
  if (links_.trail) links_.trail->push_back({span, id});
  ++active_.begun;
  const model::Selection& selection = state_.drawing.selection;
  const bool chosen = active_.firings == 0 && selection.Contains(id);
  if (!chosen && std::find(active_.picks.begin(), active_.picks.end(), id) == active_.picks.end()) {
    active_.picks.push_back(id);
  }
}

Answers Stage::MakeAnswers(Span span) const {
  Answers answers;
  answers.points = active_.points;
  answers.answered = active_.answered;
  if (TakesChosen(*active_.row)) answers.chosen = Chosen(span);
  answers.words = active_.words;
  for (std::size_t i = 0; i < active_.keys.size(); ++i) {
    if (active_.keys[i].given)
      answers.keys.emplace_back(active_.row->keys[i].name, active_.keys[i].value);
  }
  answers.first = active_.firings == 0;
  return answers;
}

// Whether the interface that the element is placed on has a measure of this name.
bool Stage::IsMeasured(std::string_view name) const {
  return std::any_of(active_.measures.begin(), active_.measures.end(),
                     [&](const auto& measure) { return measure.first == name; });
}

void Stage::CheckRequired(Span span) const {
  for (std::size_t i = 0; i < active_.keys.size(); ++i) {
    const Key& key = active_.row->keys[i];
    if (!key.required || active_.keys[i].given) continue;
    if (IsMeasured(key.name)) continue;
    Fail(Code::kMissingValue, active_.span,
         "`" + std::string(active_.row->words) + "` needs `" + std::string(key.name) + "=`",
         std::string(key.summary), "tranos help " + std::string(active_.row->words),
         span.begin == active_.span.begin ? std::vector<Note>{}
                                          : std::vector<Note>{{span, "it would fire here"}});
  }
}

// What was made into something else, and parts of placed elements, lend their geometry alone.
void Stage::GuardChanges(model::Edit* edit) const {
  const auto& entries = state_.model.entries;
  const auto guard = [&](ElementId id) {
    const KeyAnswer* of = FindOf();
    const Span at = of ? of->span : active_.span;
    const std::string verb = "`" + std::string(active_.row->words) + "`";
    if (id >= entries.size()) {
      Fail(Code::kWrongElement, at, verb + " cannot change a part of a placed element by itself",
           "", "`drop` the placed element first, or `copy` the part");
    }
    const model::Entry& entry = entries[id];
    if (entry.standing != model::Standing::kConsumed) return;
    const std::string name =
        entry.element->name ? "`" + Printable(*entry.element->name) + "`" : "the element";
    Fail(Code::kNoLongerThere, at,
         name + " was made into something else, so " + verb + " cannot change it", "",
         "`copy` takes its geometry, `keep=true` would have left it in the model");
  };
  for (const ElementPtr& element : edit->replaced) guard(element->id);
  for (const ElementId id : edit->deleted) guard(id);
  std::erase_if(edit->consumed, [&](ElementId id) { return id >= entries.size(); });
}

// Takes down the placing of one element by what was answered alone.
void Stage::NotePlaced(const Answers& answers, const model::Edit& edit) const {
  Slice* const slice = SliceInUse();
  if (!slice) return;
  const Command& row = *active_.row;
  const bool places = row.manner == Manner::kPlaces || row.manner == Manner::kGathers;
  if (!places || !row.execute || row.dots || edit.added.size() != 1) return;
  slice->NoteFiring({&row, answers, state_, active_.point_notes,
                     static_cast<model::ElementId>(state_.model.entries.size())});
}

// What is made from what was drawn through a photograph hangs on the same sources.
void Stage::Carry(const Answers& answers, model::Edit* edit, Span span) const {
  if (IsUnsolved()) return;
  const auto times =
      CarryDeviations(*active_.row, state_, answers, active_.point_terms, *links_.sources, edit);
  if (times) return links_.budget->ChargeSteps(static_cast<std::uint64_t>(*times), span);
  links_.diagnostics->Add(
      {Code::kNoDeviation, active_.span,
       "`" + std::string(active_.row->words) +
           "` cannot be carried out within the noise of what it is made from, so that what it "
           "makes has no deviations",
       "",
       "where ends should meet, let them go on from one another, or draw both by the same dot"});
}

// What `calibrate` would have gone by, and stands after it; traces of stated cameras are for
// their penalty.
void Stage::WarnTooLate(const model::Edit& edit) const {
  for (const ElementPtr& element : edit.added) {
    const auto* trace = std::get_if<model::TracePtr>(&element->geometry);
    const ElementPtr of = trace ? state_.model.Current((*trace)->photograph) : nullptr;
    const auto* photograph = of ? std::get_if<model::PhotographPtr>(&of->geometry) : nullptr;
    if (photograph && !(*photograph)->attached) return;
  }
  links_.diagnostics->Add(
      {Code::kTakesNoPart, active_.span,
       "`" + std::string(active_.row->words) + "` stands after `calibrate` and takes no part in it",
       "", "write it before `calibrate`"});
}

void Stage::Fire(Span span) {
  const Command& row = *active_.row;
  CheckRequired(span);
  if (row.history != HistoryStep::kNone) return FireHistory(span);
  if (active_.definition) return FirePlacement(span);
  const Answers answers = MakeAnswers(span);
  if (row.manner == Manner::kTransforms && answers.chosen.empty()) {
    Fail(Code::kNothingChosen, active_.span,
         "nothing is chosen for `" + std::string(row.words) + "`", "", std::string(kChooseHelp));
  }
  Fired fired = Execute(row, answers, span);
  Carry(answers, &fired.edit, span);
  GuardChanges(&fired.edit);
  wall_voids_.Follow(state_.model, &fired.edit);
  links_.solids->Note(fired.edit.added, active_.span);
  links_.solids->Note(fired.edit.replaced, active_.span);
  if (calibrated_ && row.informs) WarnTooLate(fired.edit);
  for (const CommandError& warning : fired.warnings)
    links_.diagnostics->Add(MakeDiagnostic(warning));
  for (const std::string& line : fired.messages) {
    if (links_.host->print) links_.host->print(line);
  }
  if (!links_.outputs && !fired.edit.outputs.empty()) {
    Fail(Code::kMisplaced, active_.span, "a definition's body draws no picture and writes no file",
         "", "`" + std::string(active_.row->words) + "` stands in the script");
  }
  if (links_.outputs) {
    const Span named = SpanOf({Where::kKey, 0, "file"});
    for (model::OutputRequest& output : fired.edit.outputs) {
      links_.outputs->push_back(output);
      links_.output_spans->push_back(named);
    }
  }
  if (links_.trail && fired.edit.selection && row.family == "choose") {
    for (const ElementId id : *fired.edit.selection) links_.trail->push_back({span, id});
  }
  links_.budget->ChargeElements(fired.edit.added.size(), span);
  TakeIds();
  if (fired.edit.ChangesModel()) history_.push_back(state_);
  NotePlaced(answers, fired.edit);
  for (std::size_t i = 0; i < fired.edit.added.size(); ++i) {
    if (std::holds_alternative<model::TracePtr>(fired.edit.added[i]->geometry))
      trace_spans_[static_cast<ElementId>(state_.model.entries.size() + i)] = active_.span;
  }
  Commit(fired.edit, span);
  if (row.calibrates) {  // what it stands on cannot be undone
    history_base_ = history_.size();
    undone_.clear();
    calibrated_ = true;
  }
  AskAgain();
}

Fired Stage::Execute(const Command& row, const Answers& answers, Span span) const {
  if (row.calibrates) return links_.calibrate(answers, state_, span);
  const std::function<void(std::uint64_t)> charge = [&](std::uint64_t steps) {
    links_.budget->ChargeSteps(steps, span);
  };
  CommandResult result =
      row.execute_with
          ? row.execute_with(state_, answers,
                             {*links_.host, *links_.sources, *links_.photographs, charge})
          : row.execute(state_, answers);
  if (!result) throw RunFailure{MakeDiagnostic(result.error())};
  return *std::move(result);
}

// A placed element with how it moves with the point that it was placed at.
ElementPtr Stage::Drawn(const model::Element& placed) const {
  const model::Instance& instance = *std::get<model::InstancePtr>(placed.geometry);
  std::vector<model::Moved> moved;
  for (const auto& [source, term] : active_.point_terms[0]) {
    const double step = model::kMovedBy * (*links_.sources)[source].sigma;
    if (!(step > 0)) continue;
    const auto beside = [&, slope = term](double by) {
      model::Instance aside = instance;
      aside.world_from_prototype.pretranslate(by * slope);
      return std::make_shared<const model::Instance>(std::move(aside));
    };
    moved.push_back({source, step, beside(step), beside(-step)});
  }
  return model::WithMoved(placed, std::move(moved));
}

void Stage::FirePlacement(Span span) {
  if (const auto error = TooFar(MakeAnswers(span))) throw RunFailure{MakeDiagnostic(*error)};
  Placement placement{active_.definition,       {},           {},
                      geom::Affine::Identity(), active_.span, span,
                      active_.measures,         active_.own};
  for (std::size_t i = 0; i < active_.keys.size(); ++i) {
    placement.arguments.push_back(active_.keys[i].value);
    const bool given = active_.keys[i].given;
    placement.argument_spans.push_back(given ? active_.keys[i].span
                                       : IsMeasured(active_.row->keys[i].name) ? span
                                                                               : active_.span);
  }
  const model::Settings& settings = *state_.drawing.settings;
  geom::Frame frame = active_.has_frame ? active_.frame : settings.plane;
  frame.origin = active_.points[0];
  placement.world_from_element = frame.WorldFromFrame();
  placement.world_from_element.rotate(Eigen::AngleAxisd(settings.angle_rad, Vec3::UnitZ()));
  placement.world_from_element.scale(settings.scale);
  model::Edit edit;
  ElementPtr placed = links_.place(placement, state_);
  if (!active_.point_terms[0].empty()) placed = Drawn(*placed);
  edit.added.push_back(std::move(placed));
  CheckNear(*edit.added.back(), span);
  links_.budget->ChargeElements(1, span);
  TakeIds();
  if (active_.host != model::kNoElement) {
    const auto id = static_cast<ElementId>(state_.model.entries.size());
    if (!wall_voids_.Place(state_.model, active_.host, id, *edit.added.back(), &edit)) {
      Fail(Code::kOutOfRange, span,
           "the opening of `" + std::string(active_.definition->words) +
               "` lies beside the wall, and cuts nothing",
           "", "give a place within the face, as wall.face(\"south\", along, up)");
    }
    links_.solids->Note(edit.replaced, active_.span);
  }
  history_.push_back(state_);
  Commit(edit, span);
  AskAgain();
}

// Scale and parameters may take a placed element beyond what its point keeps within.
void Stage::CheckNear(const model::Element& placed, Span span) const {
  const geom::Box box = model::BoundingBox(placed);
  if (box.empty()) return;
  const double farthest_m = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  if (farthest_m <= kFarthest_m) return;
  Fail(Code::kOutOfRange, span, "the placed element reaches more than a million kilometres away",
       "at most 1e9 m");
}

// Groups and placed elements are walked by recursion, so that they may not nest without bound.
void Stage::CheckDepth(const model::Edit& edit, Span span) const {
  const int most = links_.budget->limits.depth;
  for (const ElementPtr& element : edit.added) {
    if (model::DepthOf(*element) <= most) continue;
    Fail(Code::kDepthLimit, span, "elements are nested more than " + std::to_string(most) + " deep",
         "", "--limit depth=N raises the limit");
  }
}

// A group that changes what stood before it is told of: the names around it then mean something
// else.
void Stage::NoteOutside(const model::Edit& edit) {
  if (groups_.empty()) return;
  const std::size_t first = groups_.back().first_id;
  const auto outside = [&](ElementId id) { return id < first; };
  const auto element_outside = [&](const ElementPtr& element) { return outside(element->id); };
  groups_.back().touches_outside =
      groups_.back().touches_outside ||
      std::any_of(edit.replaced.begin(), edit.replaced.end(), element_outside) ||
      std::any_of(edit.released.begin(), edit.released.end(), element_outside) ||
      std::any_of(edit.consumed.begin(), edit.consumed.end(), outside) ||
      std::any_of(edit.deleted.begin(), edit.deleted.end(), outside) ||
      std::any_of(edit.grouped.begin(), edit.grouped.end(), outside);
}

// Carries an edit out, remembers what it made, and tells of it.
void Stage::Commit(const model::Edit& edit, Span span) {
  CheckDepth(edit, span);
  if (edit.ChangesModel()) undone_.clear();
  TakeIds();
  NoteOutside(edit);
  if (edit.selection) active_.selected = true;
  const bool grows = !edit.added.empty() || !edit.released.empty();
  model::Applied applied = model::Apply(std::move(state_), edit);
  state_ = std::move(applied.state);
  if (grows) {
    // `as` names what was made; what was only changed keeps its own name.
    for (std::size_t i = 0; i < applied.made_or_changed.size(); ++i) {
      const bool changed = i >= edit.added.size() && i < edit.added.size() + edit.replaced.size();
      if (!changed) made_.push_back(applied.made_or_changed[i]);
    }
  }
  if (links_.options) Tell(std::exchange(key_in_, {}), span, &edit, applied.made_or_changed);
}

void Stage::AskAgain() {
  for (KeyAnswer& key : active_.keys) key.used = key.used || key.given;
  ++active_.firings;
  active_.begun = 0;
  active_.picks.clear();
  const Command& row = *active_.row;
  if (row.manner == Manner::kGathers) {
    active_.points.clear();
    active_.point_spans.clear();
    active_.point_notes.clear();
    active_.point_terms.clear();
    return;
  }
  if (row.carries && !active_.points.empty()) {
    active_.points[0] = active_.points.back();
    active_.point_spans[0] = active_.point_spans.back();
    active_.point_notes[0] = active_.point_notes.back();
    active_.point_terms[0] = active_.point_terms.back();
  }
  for (std::size_t i = static_cast<std::size_t>(row.again); i < active_.answered.size(); ++i)
    active_.answered[i] = false;
}

// Without questions it has all it needs; with them only if keys answered them all.
bool Stage::TransformIsAnswered() const {
  return active_.firings == 0 && PromptsAnswered() && (FindOf() || active_.row->prompts.empty());
}

void Stage::EndStatement(Span span) {
  if (!active_.row || !active_.own_statement) {
    // `of=` given later fires at the end of the statement it stands in.
    if (!active_.row) return;
    const KeyAnswer* of = FindOf();
    if (of && !of->used &&
        (active_.row->manner == Manner::kPicks || active_.row->manner == Manner::kEdits))
      Fire(span);
    return;
  }
  active_.own_statement = false;
  const KeyAnswer* of = FindOf();
  switch (active_.row->manner) {
    case Manner::kImmediate:
      End(span, false);
      break;
    case Manner::kPicks:
      if (of && !of->used) Fire(span);
      break;
    case Manner::kEdits:
      if (ChosenCount() > 0 && active_.picks.empty()) Fire(span);
      break;
    case Manner::kTransforms:
      if (TransformIsAnswered()) Fire(span);
      break;
    default:
      break;
  }
}

void Stage::TooFew(Span span) const {
  const Command& row = *active_.row;
  if (row.manner == Manner::kPicks || row.manner == Manner::kEdits) {
    const std::size_t count = ChosenCount();
    if (count == 0) {
      Fail(Code::kNothingChosen, active_.span,
           "nothing is chosen for `" + std::string(row.words) + "`", "",
           std::string(kChooseHelp) + "; or pick with data points");
    }
    Fail(Code::kTooFewPoints, active_.span,
         "`" + std::string(row.words) + "` needs " + std::to_string(row.least) +
             " elements, and has " + std::to_string(count),
         "", "", {{span, "it ends here"}});
  }
  std::string asked;
  if (row.manner == Manner::kGathers) {
    asked = "at least " + std::to_string(row.least) + (row.dots ? " dots" : " points") +
            ", and has " + std::to_string(active_.points.size());
  } else {
    for (std::size_t i = 0; i < row.prompts.size() && asked.empty(); ++i) {
      if (!active_.answered[i] && !KeyAnswers(static_cast<int>(i)))
        asked = "a point: " + std::string(row.prompts[i].name);
    }
  }
  if (asked.empty()) asked = "a data point";
  Fail(Code::kTooFewPoints, active_.span, "`" + std::string(row.words) + "` asks for " + asked, "",
       std::string("give it ") +
           (row.dots ? "a dot such as dot=102.5,211" : "a data point such as xy=0,0,0") +
           ", or drop the question with `reset`",
       {{span, "it ends here"}});
}

void Stage::CheckUnused() const {
  for (std::size_t i = 0; i < active_.keys.size(); ++i) {
    if (!active_.keys[i].given || active_.keys[i].used) continue;
    const std::string name(active_.row->keys[i].name);
    Fail(Code::kUnusedParameter, active_.keys[i].span, "nothing was made with `" + name + "=`",
         "not used", "write `" + name + "=` before the point");
  }
}

void Stage::EndPicking(bool is_reset, Span span) {
  const std::size_t chosen = ChosenCount();
  const bool constructs = active_.row->manner == Manner::kPicks;
  const bool enough = chosen >= static_cast<std::size_t>(active_.row->least) && chosen > 0;
  if (enough && (constructs || !is_reset)) return Fire(span);
  if (!is_reset && (active_.begun > 0 || active_.firings == 0)) TooFew(span);
}

void Stage::End(Span span, bool is_reset) {
  if (!active_.row) return;
  const Command& row = *active_.row;
  switch (row.manner) {
    case Manner::kImmediate:
      if (active_.firings == 0) Fire(span);
      break;
    case Manner::kGathers:
      if (static_cast<int>(active_.points.size()) >= row.least) {
        Fire(span);
      } else if (!is_reset && (active_.begun > 0 || active_.firings == 0)) {
        TooFew(span);
      }
      break;
    case Manner::kPicks:
    case Manner::kEdits:
      EndPicking(is_reset, span);
      break;
    default:
      if (row.manner == Manner::kTransforms && TransformIsAnswered()) Fire(span);
      if (!is_reset && (active_.begun > 0 || active_.firings == 0)) {
        if (row.manner == Manner::kTransforms && ChosenCount() == 0) {
          Fail(Code::kNothingChosen, active_.span,
               "nothing is chosen for `" + std::string(row.words) + "`", "",
               std::string(kChooseHelp));
        }
        TooFew(span);
      }
  }
  if (!is_reset) CheckUnused();
  active_.row = nullptr;
}

void Stage::FireHistory(Span span) {
  const HistoryStep step = active_.row->history;
  const KeyAnswer* key = FindKey("name");
  const std::string name = key ? key->value.string() : "";
  if (step == HistoryStep::kMark) {
    marks_.emplace_back(name, history_.size());
  } else if (step == HistoryStep::kRedo) {
    Redo(span);
  } else if (key) {
    UndoToMark(name, span);
  } else {
    Undo(span);
  }
  AskAgain();
  if (links_.options) Tell(std::exchange(key_in_, {}), span, nullptr, {});
}

// What undo brings back: the model, the names, `last` and the selection; settings stay.
void Stage::RestoreModel(const model::State& earlier) {
  ids_given_ = std::max(ids_given_, state_.model.entries.size());
  state_.model = earlier.model;
  state_.drawing.names = earlier.drawing.names;
  state_.drawing.last = earlier.drawing.last;
  state_.drawing.selection = earlier.drawing.selection;
  state_.drawing.photograph = earlier.drawing.photograph;
}

// The ids of elements that were undone stay taken. To be called before the state becomes history,
// so that an undo does not lose what was filled in.
void Stage::TakeIds() {
  while (state_.model.entries.size() < ids_given_) {
    state_.model.entries.Append({nullptr, model::Standing::kDeleted});
  }
}

void Stage::Undo(Span span) {
  if (history_.size() <= history_base_) {
    Fail(Code::kNothingToUndo, span, "there is nothing to undo in this block");
  }
  undone_.push_back(state_);
  RestoreModel(history_.back());
  history_.pop_back();
  marks_.erase(std::remove_if(marks_.begin(), marks_.end(),
                              [&](const auto& mark) { return mark.second > history_.size(); }),
               marks_.end());
  made_.clear();
}

void Stage::UndoToMark(const std::string& name, Span span) {
  for (std::size_t i = marks_.size(); i-- > 0;) {
    if (marks_[i].first != name || marks_[i].second < history_base_) continue;
    const std::size_t target = marks_[i].second;
    marks_.resize(i + 1);
    while (history_.size() > target) Undo(span);
    return;
  }
  Fail(Code::kUnknownMark, span, "there is no mark \"" + Printable(name) + "\" in this block", "",
       "mark \"" + Printable(name) + "\" sets one");
}

void Stage::Redo(Span span) {
  if (undone_.empty()) Fail(Code::kNothingToUndo, span, "there is nothing to redo");
  history_.push_back(state_);
  RestoreModel(undone_.back());
  undone_.pop_back();
}

void Stage::Tell(std::string key_in, Span span, const model::Edit* edit,
                 const std::vector<ElementId>& ids) {
  if (!links_.options || !links_.options->on_step) return;
  Step step;
  step.key_in = std::move(key_in);
  step.span = span;
  step.edit = edit;
  step.ids = ids;
  step.state = &state_;
  step.statement = active_.span;
  step.turns = *links_.turns;
  for (const Value* value : *links_.turn_values) step.turn_values.push_back(*value);
  step.sources = links_.program->sources.get();
  if (!active_.row) step.statement = span;
  if (active_.row) {
    step.command = active_.row->words;
    if (edit) {
      for (std::size_t i = 0; i < active_.points.size(); ++i) {
        const bool gathers = active_.row->manner == Manner::kGathers;
        if (!gathers && i < active_.answered.size() && !active_.answered[i]) continue;
        step.answers.emplace_back(gathers || i >= active_.row->prompts.size()
                                      ? "point"
                                      : std::string(active_.row->prompts[i].name),
                                  Value::OfPoint(active_.points[i]));
      }
      for (std::size_t i = 0; i < active_.keys.size(); ++i) {
        if (active_.keys[i].given)
          step.answers.emplace_back(active_.row->keys[i].name, active_.keys[i].value);
      }
    }
  }
  links_.options->on_step(step);
}

}  // namespace tranos::interp
