// SPDX-License-Identifier: GPL-3.0-or-later
// Key-ins: data points, parameters, settings, blocks and names. Firing is in stage_fire.cpp.
#include "interp/stage.h"

#include <algorithm>
#include <map>

#include <cmath>

#include "interp/commands/placement.h"
#include "interp/functions.h"

namespace tranos::interp {

using geom::Vec3;
using model::ElementId;
using model::ElementPtr;
using model::Value;

void Fail(Code code, Span span, std::string message, std::string label, std::string help,
          std::vector<Note> notes) {
  throw RunFailure{
      {code, span, std::move(message), std::move(label), std::move(help), std::move(notes)}};
}

void Budget::ChargeSteps(std::uint64_t count, Span span) {
  if (count > steps_left) {
    Fail(Code::kStepLimit, span,
         "the limit of " + std::to_string(limits.steps) + " steps is reached", "",
         "--limit steps=N raises it");
  }
  const std::uint64_t before = steps_left;
  steps_left -= count;
  if (on_progress && (before ^ steps_left) >> 16 != 0) (*on_progress)(limits.steps - steps_left);
}

void Budget::ChargeElements(std::uint64_t count, Span span) {
  elements_made += count;
  if (elements_made > limits.elements) {
    Fail(Code::kElementLimit, span,
         "the limit of " + std::to_string(limits.elements) + " elements is reached", "",
         "--limit elements=N raises it");
  }
}

void Budget::ChargeBytes(std::uint64_t bytes, Span span) const {
  if (bytes > limits.memory) {
    Fail(Code::kMemoryLimit, span,
         "this would take more than the limit of " + std::to_string(limits.memory) + " bytes", "",
         "--limit memory=N raises it");
  }
}

Stage::Stage(StageLinks links, bool owns_settings) : links_(std::move(links)) {
  if (!owns_settings) return;
  auto attributes = std::make_shared<model::Attributes>();
  attributes->own = model::Attributes::kAll;
  auto settings = std::make_shared<model::Settings>();
  settings->attributes = std::move(attributes);
  state_.drawing.settings = std::move(settings);
}

const model::Names& Stage::NamesOut(std::size_t groups_out) const {
  return groups_out == 0 ? state_.drawing.names : groups_[groups_.size() - groups_out].names;
}

void Stage::Start(const Command* row, const Definition* definition, Span span) {
  End(span, false);
  made_.clear();
  active_.row = row;
  active_.definition = definition;
  active_.span = span;
  active_.depth = blocks_.size();
  active_.own_statement = true;
  active_.points.assign(row->prompts.size(), Vec3::Zero());
  active_.point_spans.assign(row->prompts.size(), span);
  active_.point_notes.assign(row->prompts.size(), Slice::kNone);
  active_.point_terms.assign(row->prompts.size(), {});
  active_.answered.assign(row->prompts.size(), false);
  if (row->manner == Manner::kGathers) {
    active_.points.clear();
    active_.point_spans.clear();
    active_.point_notes.clear();
    active_.point_terms.clear();
  }
  active_.begun = 0;
  active_.keys.clear();
  active_.keys.resize(row->keys.size());
  active_.words.clear();
  active_.word_spans.clear();
  active_.picks.clear();
  active_.firings = 0;
  active_.selected = false;
  active_.has_frame = false;
  active_.host = model::kNoElement;
  active_.measures.clear();
  if (links_.options) Tell(std::string(row->words), span, nullptr, {});
}

void Stage::Option(const std::string& word, Span span) {
  if (!active_.row)
    Fail(Code::kNoCommand, span, "`" + Printable(word) + "` belongs to a command that has ended");
  active_.words.push_back(word);
  active_.word_spans.push_back(span);
  if (links_.options) Tell(word, span, nullptr, {});
}

// A bare string is the key that it stands for.
void Stage::BareString(const std::string& text, Span span) {
  std::uint32_t key = 0;
  while (active_.row && key < active_.row->keys.size() &&
         active_.row->keys[key].name != active_.row->string_key)
    ++key;
  Parameter(key, Value::String(text), span);
}

namespace {

std::string Join(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

}  // namespace

void Stage::Parameter(std::uint32_t key, Value value, Span span) {
  if (!active_.row || key >= active_.keys.size()) {
    Fail(Code::kNoCommand, span, "the command that this parameter belongs to has ended", "",
         "write it before the end of its command, or start the command again");
  }
  const Key& declared = active_.row->keys[key];
  KeyAnswer& answer = active_.keys[key];
  if (answer.given && !answer.used) {
    Fail(Code::kUnusedParameter, answer.span,
         "`" + std::string(declared.name) + "=` is given again before it is used", "not used", "",
         {{span, "given again here"}});
  }
  if (declared.type == Type::kWord && !declared.words.empty() &&
      !(value.is_string() && HasWord(declared.words, value.string()))) {
    Fail(Code::kWrongType, span, "`" + std::string(declared.name) + "` takes no such word",
         "expected one of " + Join(SplitWords(declared.words)));
  }
  if (links_.options) key_in_ = std::string(declared.name) + "=" + KeyInText(value);
  answer = {std::move(value), span, true, false};
  // `of=` given anew is worked on, not what the firing before it left chosen.
  if (declared.name == "of" && declared.type == Type::kElements) active_.selected = false;
  const bool asks_points =
      active_.row->manner == Manner::kPlaces || active_.row->manner == Manner::kTransforms;
  if (asks_points && declared.prompt >= 0 && PromptsAnswered() &&
      (active_.row->manner == Manner::kPlaces || ChosenCount() > 0)) {
    return Fire(span);
  }
  if (links_.options) Tell(std::exchange(key_in_, {}), span, nullptr, {});
}

bool Stage::KeyAnswers(int prompt) const {
  for (std::size_t i = 0; i < active_.keys.size(); ++i) {
    if (active_.row->keys[i].prompt == prompt && active_.keys[i].given) return true;
  }
  return false;
}

bool Stage::PromptsAnswered() const {
  for (std::size_t i = 0; i < active_.answered.size(); ++i) {
    if (!active_.answered[i] && !KeyAnswers(static_cast<int>(i))) return false;
  }
  return true;
}

const Stage::KeyAnswer* Stage::FindKey(std::string_view name) const {
  if (!active_.row) return nullptr;
  for (std::size_t i = 0; i < active_.keys.size(); ++i) {
    if (active_.keys[i].given && active_.row->keys[i].name == name) return &active_.keys[i];
  }
  return nullptr;
}

// `of=` where it gives elements to work on.
const Stage::KeyAnswer* Stage::FindOf() const {
  if (!active_.row) return nullptr;
  for (std::size_t i = 0; i < active_.keys.size(); ++i) {
    const Key& key = active_.row->keys[i];
    if (active_.keys[i].given && key.name == "of" && key.type == Type::kElements)
      return &active_.keys[i];
  }
  return nullptr;
}

namespace {

// The coordinates of a data point's values; `given` tells how many there were.
Vec3 Coordinates(const Value& values, std::size_t* given) {
  if (!values.is_list()) {
    *given = 1;
    return {values.number(), 0, 0};
  }
  Vec3 out = Vec3::Zero();
  *given = std::min<std::size_t>(values.list().size(), 3);
  for (std::size_t i = 0; i < *given; ++i)
    out[static_cast<Eigen::Index>(i)] = values.list()[i].number();
  return out;
}

// How a point hangs on what its coordinates come from.
PointTerms TermsOfPoint(const Value& values) {
  if (!values.is_list()) return {};
  std::map<model::SourceId, Vec3> terms;
  for (std::size_t i = 0; i < std::min<std::size_t>(values.list().size(), 3); ++i) {
    const model::Derivatives* derivatives = values.list()[i].derivatives();
    if (!derivatives) continue;
    for (const auto& [source, slope] : derivatives->terms) {
      terms.try_emplace(source, Vec3::Zero()).first->second[static_cast<Eigen::Index>(i)] = slope;
    }
  }
  return {terms.begin(), terms.end()};
}

std::string PointText(PointKey kind, const Value& values) {
  static constexpr std::string_view kKeys[] = {"xy", "ax", "dl", "di", "dx", "dot", "on"};
  std::string out = std::string(kKeys[static_cast<int>(kind)]) + "=";
  if (!values.is_list()) return out + KeyInText(values);
  for (std::size_t i = 0; i < values.list().size(); ++i)
    out += (i ? "," : "") + KeyInText(values.list()[i]);
  return out;
}

}  // namespace

Vec3 PlaceOf(PointKey kind, const Value& values, const model::Drawing& drawing,
             const geom::Frame& view, const Vec3& last) {
  const geom::Frame& plane = drawing.settings->plane;
  std::size_t given = 0;
  const Vec3 v = Coordinates(values, &given);
  const double z = given > 2 ? v.z() : drawing.settings->depth_m;
  switch (kind) {
    case PointKey::kXy:
      return {v.x(), v.y(), z};
    case PointKey::kAx:
      return plane.ToWorld({v.x(), v.y(), z});
    case PointKey::kDl:
      return last + plane.ToWorld(v) - plane.origin;
    case PointKey::kDi: {
      const Vec3 local = Rotation(Vec3::Zero(), Vec3::UnitZ(), v.y()) * Vec3(v.x(), 0, 0);
      return last + plane.ToWorld(local) - plane.origin;
    }
    case PointKey::kDx:
      return last + view.ToWorld(v) - view.origin;
    case PointKey::kDot:
      return {v.x(), v.y(), 0};  // as a trace takes it
    case PointKey::kOn:
      break;  // comes through Stage::On
  }
  return last;
}

// The point of the active facade that a dot is of.
PlacedPoint Stage::DrawnThrough(const Value& values, Span span) const {
  std::size_t given = 0;
  const auto placed = DrawDot(state_, Coordinates(values, &given).head<2>(), links_.dot_source);
  if (placed) return *placed;
  Diagnostic diagnostic = MakeDiagnostic(placed.error());
  diagnostic.span = span;
  throw RunFailure{std::move(diagnostic)};
}

// How a data point hangs on sources: as its numbers do, and as the point that it goes on from.
PointTerms Stage::TermsOf(PointKey kind, const Value& values) const {
  switch (kind) {
    case PointKey::kXy:
      return IsUnsolved() ? PointTerms{} : TermsOfPoint(values);
    case PointKey::kDl:
    case PointKey::kDi:
    case PointKey::kDx:
      return last_terms_;
    case PointKey::kDot: {
      if (!active_.row || active_.row->informs) return {};
      std::size_t given = 0;
      const KeyAnswer* key = FindKey("photo");
      const ElementId photograph = key ? key->value.element()->id : state_.drawing.photograph;
      const auto source = links_.dot_source(photograph, Coordinates(values, &given).head<2>(),
                                            NoiseOf(state_, photograph));
      if (!source) return {};
      return {{*source, Vec3::UnitX()}, {*source + 1, Vec3::UnitY()}};
    }
    case PointKey::kAx:
    case PointKey::kOn:
      break;
  }
  return {};
}

void Stage::Point(PointKey kind, const Value& values, Span span) {
  if (links_.options) key_in_ = PointText(kind, values);
  if (kind == PointKey::kDot) WarnOfDeviation(values, span);
  if (kind == PointKey::kDot && active_.row && !active_.row->dots) {
    return TakePoint(DrawnThrough(values, span), span);
  }
  const model::Drawing& drawing = state_.drawing;
  // Asked for by dx= alone: most points of a long script need no view.
  const geom::Frame view =
      kind == PointKey::kDx ? model::FrameOf(*drawing.view, state_.model, "top") : geom::Frame{};
  const bool follows = kind == PointKey::kDl || kind == PointKey::kDi || kind == PointKey::kDx;
  if (Slice* const slice = SliceInUse()) {
    point_note_ =
        slice->NotePoint(kind, values, drawing, view, follows ? last_note_ : Slice::kNone);
  }
  TakePoint({PlaceOf(kind, values, drawing, view, drawing.last_point), TermsOf(kind, values)}, span,
            kind == PointKey::kDot);
  point_note_ = Slice::kNone;
}

void Stage::WarnOfDeviation(const Value& dot, Span span) const {
  const auto is_uncertain = [](const Value& coordinate) { return coordinate.derivatives(); };
  if (!dot.is_list() || std::ranges::none_of(dot.list(), is_uncertain)) return;
  links_.diagnostics->Add({Code::kDotExact, span, "the deviation of this dot is not taken", "",
                           "`noise=` says how uncertain dots are; `.value` is a number without"});
}

void Stage::On(const model::Interface& interface, const std::string& own, ElementId host,
               Span span) {
  if (!active_.row) Fail(Code::kNoCommand, span, "there is no active command to take this place");
  if (!active_.definition) {
    Fail(Code::kUnknownKey, span,
         "`on=` places defined elements; `" + std::string(active_.row->words) + "` is none", "",
         "give the point: xy=…");
  }
  active_.frame = interface.frame;
  active_.has_frame = true;
  active_.host = host;
  active_.measures = interface.measures;
  active_.own = own;
  if (links_.options) key_in_ = "on=" + interface.name + (own.empty() ? "" : "," + own);
  TakePoint({interface.frame.origin}, span);
  active_.has_frame = false;
  active_.measures.clear();
  active_.own.clear();
}

void Stage::TakePoint(const PlacedPoint& placed, Span span, bool is_dot) {
  const Vec3& point = placed.point_m;
  if (!point.allFinite()) Fail(Code::kNotFinite, span, "the data point is not finite");
  if (!active_.row) {
    Fail(Code::kNoCommand, span, "there is no active command to take this data point", "",
         "start a command first, such as `place line`");
  }
  if (active_.row->dots != is_dot) {
    Fail(Code::kNoCommand, span,
         "`" + std::string(active_.row->words) + "` takes " +
             (is_dot ? "no dots" : "dots of the photograph, not points of the world"),
         is_dot ? "" : "expected dot=u,v");
  }
  links_.budget->ChargeSteps(1, span);
  if (!is_dot) {
    state_.drawing.last_point = point;
    last_note_ = point_note_;
    last_terms_ = placed.terms;
  }
  switch (active_.row->manner) {
    case Manner::kImmediate:
      Fail(Code::kNoCommand, span,
           "`" + std::string(active_.row->words) + "` asks for no data point");
    case Manner::kPlaces:
    case Manner::kTransforms:
      AnswerPrompt(placed, span);
      break;
    case Manner::kGathers:
      if (static_cast<int>(active_.points.size()) >= active_.row->most) {
        Fail(Code::kWrongCount, span,
             "`" + std::string(active_.row->words) + "` takes at most " +
                 std::to_string(active_.row->most) + " points");
      }
      active_.points.push_back(point);
      active_.point_spans.push_back(span);
      active_.point_notes.push_back(point_note_);
      active_.point_terms.push_back(placed.terms);
      ++active_.begun;
      break;
    case Manner::kChooses:
      active_.points[0] = point;
      active_.point_spans[0] = span;
      active_.answered[0] = true;
      Fire(span);
      break;
    case Manner::kPicks:
    case Manner::kEdits:
      PickOrAccept(point, span);
      break;
  }
  if (links_.options && !key_in_.empty()) Tell(std::exchange(key_in_, {}), span, nullptr, {});
}

void Stage::AnswerPrompt(const PlacedPoint& placed, Span span) {
  for (std::size_t i = 0; i < active_.answered.size(); ++i) {
    if (active_.answered[i] || KeyAnswers(static_cast<int>(i))) continue;
    active_.points[i] = placed.point_m;
    active_.point_spans[i] = span;
    active_.point_notes[i] = point_note_;
    active_.point_terms[i] = placed.terms;
    active_.answered[i] = true;
    ++active_.begun;
    break;
  }
  if (PromptsAnswered()) Fire(span);
}

void Stage::Set(const SettingRow& row, const Value& value, Span span) {
  auto settings = std::make_shared<model::Settings>(*state_.drawing.settings);
  const auto attributes = [&](std::uint8_t own, auto change) {
    auto copy = std::make_shared<model::Attributes>(*settings->attributes);
    change(*copy);
    copy->own = static_cast<std::uint8_t>(copy->own | own);
    settings->attributes = std::move(copy);
  };
  const auto positive = [&](double number) {
    if (!(number > 0))
      Fail(Code::kOutOfRange, span, "`" + std::string(row.key) + "` is above zero");
    return number;
  };
  const auto count = [&](int most) {
    const double number = value.number();
    if (number > most) {
      Fail(Code::kOutOfRange, span,
           "`" + std::string(row.key) + "` is at most " + std::to_string(most));
    }
    return static_cast<int>(number);
  };
  using model::Attributes;
  switch (row.setting) {
    case SettingKey::kColour: {
      std::uint32_t code = 0;
      if (value.is_string()) {
        code = model::Colour::kRgb |
               static_cast<std::uint32_t>(std::stoul(value.string().substr(1), nullptr, 16));
      } else {
        code = static_cast<std::uint32_t>(value.number());
      }
      attributes(Attributes::kColour, [&](Attributes& a) { a.colour = {code}; });
      break;
    }
    case SettingKey::kLinestyle:
      attributes(Attributes::kLinestyle, [&](Attributes& a) { a.linestyle = count(7); });
      break;
    case SettingKey::kWeight:
      attributes(Attributes::kWeight, [&](Attributes& a) { a.weight = count(31); });
      break;
    case SettingKey::kLevel:
      attributes(Attributes::kLevel, [&](Attributes& a) { a.level = value.string(); });
      break;
    case SettingKey::kMaterial:
      attributes(Attributes::kMaterial, [&](Attributes& a) { a.material = value.string(); });
      break;
    case SettingKey::kEvidence: {
      const auto evidence = model::EvidenceOf(value.string());
      if (!evidence) {
        Fail(Code::kWrongType, span, "`" + Printable(value.string()) + "` is no kind of evidence",
             "expected one of " + Join(SplitWords(row.words)));
      }
      attributes(Attributes::kEvidence, [&](Attributes& a) { a.evidence = *evidence; });
      break;
    }
    case SettingKey::kSource:
      attributes(Attributes::kEvidence, [&](Attributes& a) { a.source = value.string(); });
      break;
    case SettingKey::kAngle:
      settings->angle_rad = value.number();
      break;
    case SettingKey::kScale: {
      std::size_t given = 0;
      settings->scale = Coordinates(value, &given);
      break;
    }
    case SettingKey::kDepth:
      settings->depth_m = value.number();
      break;
    case SettingKey::kChord:
      settings->tolerance.chord_m = positive(value.number());
      break;
    case SettingKey::kFacets:
      settings->tolerance.facets_per_turn = count(100'000);
      break;
    case SettingKey::kLocate:
      settings->locate_tolerance_m = positive(value.number());
      break;
    case SettingKey::kUnit:
      settings->unit = value.string();
      break;
    case SettingKey::kNoise:
      settings->noise_px = value.is_string() ? 0 : positive(value.number());
      break;
  }
  links_.budget->ChargeSteps(1, span);
  state_.drawing.settings = std::move(settings);
  if (links_.options)
    Tell(std::string(row.key) + "=" +
             (row.setting == SettingKey::kUnit ? value.string() : KeyInText(value)),
         span, nullptr, {});
}

void Stage::Reset(Span span) {
  links_.budget->ChargeSteps(1, span);
  End(span, true);
  if (links_.options) Tell("reset", span, nullptr, {});
}

void Stage::EndCommand(Span span) { End(span, false); }

void Stage::BlockBegin(bool restores) {
  blocks_.push_back({state_.drawing.settings, restores, history_base_});
  history_base_ = history_.size();
}

void Stage::BlockEnd(Span span) {
  if (active_.row && active_.depth == blocks_.size()) End(span, false);
  if (!active_.row) made_.clear();  // `as` beyond the brace would name the last of it alone
  const Block block = std::move(blocks_.back());
  blocks_.pop_back();
  history_base_ = block.history_base;
  if (block.restores && state_.drawing.settings != block.settings) {
    state_.drawing.settings = block.settings;
    if (links_.options) Tell("}", span, nullptr, {});
  }
}

void Stage::GroupBegin(std::uint32_t scope, Span span) {
  End(span, false);
  undone_.clear();  // redo does not reach into a group, nor out of it
  TakeIds();
  groups_.push_back(
      {scope, state_.drawing.names, history_.size(), state_.model.entries.size(), state_});
  state_.drawing.names = {};
  BlockBegin(true);
  if (links_.options) Tell("group {", span, nullptr, {});
}

void Stage::GroupEnd(Span span) {
  End(span, false);
  BlockEnd(span);
  OpenGroup open = std::move(groups_.back());
  groups_.pop_back();
  if (!groups_.empty() && open.touches_outside) groups_.back().touches_outside = true;
  undone_.clear();
  model::Group group;
  model::Edit edit;
  for (std::size_t id = open.first_id; id < state_.model.entries.size(); ++id) {
    const model::Entry& entry = state_.model.entries[id];
    if (entry.standing != model::Standing::kInModel) continue;
    group.members.push_back(entry.element);
    edit.grouped.push_back(static_cast<ElementId>(id));
  }
  group.names = NamesOf(open.scope);
  state_.drawing.names = open.names;
  if (open.touches_outside) state_.drawing.names.Rehash(state_.model.entries);
  // The group is one step: what was done in it is not undone by itself.
  const bool changed = history_.size() > open.history_size;
  history_.resize(open.history_size);
  marks_.erase(std::remove_if(marks_.begin(), marks_.end(),
                              [&](const auto& mark) { return mark.second > open.history_size; }),
               marks_.end());
  made_.clear();
  if (changed) history_.push_back(std::move(open.before));
  if (group.members.empty()) return;
  // A group hands none of its own settings on to its members.
  auto attributes = std::make_shared<model::Attributes>(*state_.drawing.settings->attributes);
  attributes->own = 0;
  edit.added.push_back(
      model::WithAttributes(*NewElement(state_, model::MakeGroup({})), std::move(attributes)));
  edit.added.back() = model::WithGeometry(*edit.added.back(), model::MakeGroup(std::move(group)));
  edit.selection = state_.drawing.selection;
  links_.budget->ChargeElements(1, span);
  if (links_.options) key_in_ = "} group";
  Commit(edit, span);
}

// What the names of the scope stand for, as a group or prototype keeps them.
std::vector<model::NamedElements> Stage::NamesOf(std::uint32_t scope) const {
  std::vector<model::NamedElements> out;
  const auto& names = links_.program->scopes[scope].names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const model::NameBinding& binding = state_.drawing.names[i];
    if (!binding.given) continue;
    model::NamedElements named{names[i], {}, binding.ids.size() != 1};
    binding.ids.ForEach([&](ElementId id) {
      if (ElementPtr element = state_.model.Current(id))
        named.elements.push_back(std::move(element));
    });
    out.push_back(std::move(named));
  }
  return out;
}

void Stage::Name(const std::string& name, std::uint32_t index, bool in_turn, std::size_t from,
                 Span span) {
  links_.budget->ChargeSteps(1, span);
  End(span, false);
  std::vector<ElementId> made;
  for (ElementId id : made_) {
    if (state_.model.Current(id)) made.push_back(id);
  }
  if (made.empty()) {
    Fail(Code::kNothingMade, span, "there is nothing to name `" + Printable(name) + "`", "",
         "`as` follows what makes an element: place line … as " + Printable(name) +
             "; in a loop it stands inside, and names a list after it");
  }
  const model::NameBinding& binding = state_.drawing.names[index];
  if (in_turn ? binding.ids.size() > from : binding.given) {
    Fail(Code::kBoundTwice, span, "`" + Printable(name) + "` names something already",
         "named again here", "choose another name; in a loop a name may be given once a turn");
  }
  model::Edit edit;
  for (ElementId id : made)
    edit.replaced.push_back(model::WithName(*state_.model.Current(id), name));
  const model::Selection last = state_.drawing.last;
  model::Applied applied = model::Apply(std::move(state_), edit);
  state_ = std::move(applied.state);
  state_.drawing.last = last;
  state_.drawing.last.Rehash(state_.model.entries);
  for (ElementId id : made) state_.drawing.names.Bind(index, id, state_.model.entries);
  made_.clear();
  if (links_.options) Tell("as " + name, span, &edit, made);
}

}  // namespace tranos::interp
