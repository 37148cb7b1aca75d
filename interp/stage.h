// SPDX-License-Identifier: GPL-3.0-or-later
// How a command runs (docs/language.md, "How a command runs"): the state, the active command with
// its answers, and the history that undo walks. A script has one stage; so has each body of a
// definition while it is built.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "interp/arithmetic.h"
#include "interp/commands/drawing.h"
#include "interp/failure.h"
#include "interp/run.h"
#include "interp/slice.h"
#include "interp/solid_ledger.h"
#include "interp/wall_voids.h"
#include "model/edit.h"

namespace tranos::interp {

// What a run may still use; shared by all its stages.
struct Budget {
  explicit Budget(const Limits& given) : steps_left(given.steps), limits(given) {}
  std::uint64_t steps_left;
  std::uint64_t elements_made = 0;
  Limits limits;
  const std::function<void(std::uint64_t)>* on_progress = nullptr;
  void ChargeSteps(std::uint64_t count, Span span);
  void ChargeElements(std::uint64_t count, Span span);
  // A list, string or range about to be made: refused before it takes the memory.
  void ChargeBytes(std::uint64_t bytes, Span span) const;
};

[[noreturn]] void Fail(Code code, Span span, std::string message, std::string label = {},
                       std::string help = {}, std::vector<Note> notes = {});

// Where and how a defined element is put.
struct Placement {
  const Definition* definition;
  std::vector<model::Value> arguments;  // by parameter; none where not given
  std::vector<Span> argument_spans;
  geom::Affine world_from_element;
  Span span;                                                   // of the command
  Span at;                                                     // of the point or of `on=`
  std::vector<std::pair<std::string, model::Value>> measures;  // of the interface it is placed on
  std::string own;  // that of its interfaces which is put there; "" for its origin
};

// What was decided on the way to `calibrate`: the element that a pick took, the way a condition
// went, the turns of a loop. It must be the same for all values of the unknowns.
struct Decision {
  Span span;
  std::uint32_t what;
};
using Trail = std::vector<Decision>;

// What a stage needs of the run around it.
struct StageLinks {
  const Program* program;
  Budget* budget;
  Diagnostics* diagnostics;
  const RunOptions* options;  // for on_step; null for a definition's body
  const Host* host;
  std::vector<model::OutputRequest>* outputs;  // null for a definition's body
  std::vector<Span>* output_spans;             // likewise
  std::function<model::ElementPtr(const Placement&, const model::State&)> place;
  // Solves for the camera and the unknowns; what changes by it.
  std::function<Fired(const Answers&, const model::State&, Span)> calibrate;
  const SourceList* sources;
  DotSource dot_source;
  PhotographFiles* photographs;
  SolidLedger* solids;
  Trail* trail;  // null where nothing is solved for
  // Takes down what came from unknowns, until they are solved for; null where nothing is.
  std::optional<Slice>* slice;
  std::uint64_t serial;  // tells the stages of a run apart
  const std::vector<std::uint32_t>* turns;
  const std::vector<const model::Value*>* turn_values;  // the loops' variables
};

// Where a data point lies: by its values, the settings in force, the axes of the view, and the
// point before.
geom::Vec3 PlaceOf(PointKey kind, const model::Value& values, const model::Drawing& drawing,
                   const geom::Frame& view, const geom::Vec3& last);

class Stage {
 public:
  // At the top of a script all settings are an element's own; in a definition's body those that the
  // body sets.
  Stage(StageLinks links, bool owns_settings);

  void Start(const Command* row, const Definition* definition, Span span);
  void Option(const std::string& word, Span span);
  void BareString(const std::string& text, Span span);
  void Parameter(std::uint32_t key, model::Value value, Span span);
  // A data point other than `on=`: a list of lengths (of di=: a length and an angle), or one
  // length.
  void Point(PointKey kind, const model::Value& values, Span span);
  // `host` is the element whose interface it is, or kNoElement.
  void On(const model::Interface& interface, const std::string& own, model::ElementId host,
          Span span);
  void Set(const SettingRow& row, const model::Value& value, Span span);
  void Reset(Span span);
  void EndStatement(Span span);
  void EndCommand(Span span);
  void BlockBegin(bool restores);
  void BlockEnd(Span span);
  void GroupBegin(std::uint32_t scope, Span span);
  void GroupEnd(Span span);
  // `as`: from is where this turn's elements begin, in a loop.
  void Name(const std::string& name, std::uint32_t index, bool in_turn, std::size_t from,
            Span span);
  // Where each trace was keyed in.
  const std::unordered_map<model::ElementId, Span>& trace_spans() const { return trace_spans_; }
  // The names of the innermost group (0 out), of the one around it, … of the script or definition.
  const model::Names& NamesOut(std::size_t groups_out) const;

  const model::State& state() const { return state_; }
  std::uint64_t serial() const { return links_.serial; }
  // Whether the active command takes data points as picks.
  bool picks() const {
    return active_.row &&
           (active_.row->manner == Manner::kPicks || active_.row->manner == Manner::kEdits ||
            active_.row->manner == Manner::kChooses);
  }
  std::size_t groups() const { return groups_.size(); }
  // What the names of the scope stand for, as a group or prototype keeps them.
  std::vector<model::NamedElements> NamesOf(std::uint32_t scope) const;

 private:
  struct KeyAnswer {
    model::Value value;
    Span span;
    bool given = false;
    bool used = false;
  };
  // The command that was started and has not ended.
  struct Active {
    const Command* row = nullptr;
    const Definition* definition = nullptr;
    Span span;
    std::size_t depth = 0;
    bool own_statement = true;  // still in the statement that began it
    std::vector<geom::Vec3> points;
    std::vector<Span> point_spans;
    std::vector<std::size_t> point_notes;  // in the slice
    std::vector<PointTerms> point_terms;   // how each hangs on sources
    std::vector<bool> answered;            // prompts that a data point answered
    int begun = 0;                         // data points since the last firing
    std::vector<KeyAnswer> keys;
    std::vector<std::string> words;
    std::vector<Span> word_spans;
    std::vector<model::ElementId> picks;
    int firings = 0;
    bool selected = false;  // a firing has left something chosen: the next works on that
    std::vector<std::pair<std::string, model::Value>> measures = {};  // of `on=`
    std::string own = {};                                             // likewise
    bool has_frame = false;
    model::ElementId host = model::kNoElement;  // whose interface `on=` names
    geom::Frame frame;                          // of `on=`
  };
  struct Block {
    model::SettingsPtr settings;
    bool restores;
    std::size_t history_base;
  };
  struct OpenGroup {
    std::uint32_t scope;  // its name scope
    model::Names names;   // those of the scope around it
    std::size_t history_size;
    std::size_t first_id;
    model::State before;
    bool touches_outside = false;  // it changed elements that stood before it
  };
  void TakePoint(const PlacedPoint& placed, Span span, bool is_dot = false);
  void AnswerPrompt(const PlacedPoint& placed, Span span);
  PlacedPoint DrawnThrough(const model::Value& values, Span span) const;
  PointTerms TermsOf(PointKey kind, const model::Value& values) const;
  // Whether numbers' sources are still what `calibrate` solves for, and no deviations yet.
  bool IsUnsolved() const { return links_.trail && !calibrated_; }
  void PickOrAccept(const geom::Vec3& point, Span span);
  bool PromptsAnswered() const;
  bool TransformIsAnswered() const;
  bool KeyAnswers(int prompt) const;
  const KeyAnswer* FindKey(std::string_view name) const;
  const KeyAnswer* FindOf() const;
  const KeyAnswer* FindWorkingOf() const;
  std::vector<model::ElementPtr> Chosen(Span span) const;
  std::size_t ChosenCount() const;
  // Elements in the order of choosing, each once.
  struct ChosenOnce {
    std::vector<model::ElementPtr> elements;
    std::unordered_set<model::ElementId> ids;
  };
  void AddChosen(const model::ElementPtr& element, Span span, ChosenOnce* out) const;
  void Fire(Span span);
  void GuardChanges(model::Edit* edit) const;
  Slice* SliceInUse() const { return links_.slice && *links_.slice ? &**links_.slice : nullptr; }
  void NotePlaced(const Answers& answers, const model::Edit& edit) const;
  void Carry(const Answers& answers, model::Edit* edit, Span span) const;
  void WarnTooLate(const model::Edit& edit) const;
  void WarnOfDeviation(const model::Value& dot, Span span) const;
  void FirePlacement(Span span);
  model::ElementPtr Drawn(const model::Element& placed) const;
  void FireHistory(Span span);
  Fired Execute(const Command& row, const Answers& answers, Span span) const;
  void AskAgain();
  bool IsMeasured(std::string_view name) const;
  void CheckRequired(Span span) const;
  void CheckUnused() const;
  Answers MakeAnswers(Span span) const;
  void CheckDepth(const model::Edit& edit, Span span) const;
  void CheckNear(const model::Element& placed, Span span) const;
  void NoteOutside(const model::Edit& edit);
  void Commit(const model::Edit& edit, Span span);
  void End(Span span, bool is_reset);
  void EndPicking(bool is_reset, Span span);
  void TooFew(Span span) const;
  void Tell(std::string key_in, Span span, const model::Edit* edit,
            const std::vector<model::ElementId>& ids);
  Span SpanOf(const Where& where) const;
  Diagnostic MakeDiagnostic(const CommandError& error) const;
  void Undo(Span span);
  void UndoToMark(const std::string& name, Span span);
  void Redo(Span span);
  void RestoreModel(const model::State& earlier);
  void TakeIds();

  StageLinks links_;
  model::State state_;
  Active active_;
  std::vector<model::ElementId> made_;  // by the active command, or the one that ended last
  std::vector<Block> blocks_;
  std::vector<OpenGroup> groups_;
  std::vector<model::State> history_;  // the state before each firing that changed the model
  std::vector<model::State> undone_;
  std::size_t history_base_ = 0;
  bool calibrated_ = false;
  std::size_t point_note_ = Slice::kNone;  // of the data point that is keyed in
  std::size_t last_note_ = Slice::kNone;   // of the last point
  PointTerms last_terms_;                  // likewise
  std::size_t ids_given_ = 0;  // an id is given once in a run, that of an undone element too
  std::vector<std::pair<std::string, std::size_t>> marks_;
  WallVoids wall_voids_;
  std::unordered_map<model::ElementId, Span> trace_spans_;
  std::string key_in_;  // text of the key-in being carried out, when steps are told
};

}  // namespace tranos::interp
