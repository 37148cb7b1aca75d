// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/difference.h"

#include <algorithm>
#include <cmath>

#include "interp/command.h"
#include "interp/functions.h"
#include "session/correspondence.h"
#include "session/element_match.h"
#include "session/photograph_difference.h"

namespace tranos::session {

namespace {

using model::Element;
using model::Value;

// Whether a value is small enough to be written out: items in all, lists in lists.
bool IsShort(const Value& value, int depth, int* items) {
  if (++*items > 1000 || depth > 20) return false;
  if (value.is_string()) return value.string().size() <= 1000;
  if (!value.is_list()) return true;
  return std::all_of(value.list().begin(), value.list().end(),
                     [&](const Value& item) { return IsShort(item, depth + 1, items); });
}

std::string ValueText(const Value& value) {
  int items = 0;
  if (!IsShort(value, 0, &items)) return interp::Describe(value);
  if (!value.is_element()) return interp::KeyInText(value);
  const Element& element = *value.element();
  return element.name ? *element.name : model::TypeOf(element);
}

Measures MeasuresOf(const Element& element) {
  return {model::Length(element), model::Area(element), model::Volume(element)};
}

bool Close(const geom::Vec3& p, const geom::Vec3& q) {
  return (p - q).cwiseAbs().maxCoeff() < 1e-9;
}

// A point answered, in metres, without what rounding left in the last digits.
std::string PointText(const Value& value) {
  std::string out;
  for (const Value& item : value.list()) {
    const double rounded = std::round(item.number() * 1e9) / 1e9 + 0.0;
    out += (out.empty() ? "" : ",") + interp::KeyInText(Value::Number(rounded, item.dimension()));
  }
  return out;
}
bool IsPoint(const Value& value) {
  if (!value.is_list() || value.list().size() != 3) return false;
  return std::all_of(value.list().begin(), value.list().end(), [](const Value& item) {
    return item.is_number() && item.dimension() == model::kLength;
  });
}
geom::Vec3 PointOf(const Value& value) {
  return {value.list()[0].number(), value.list()[1].number(), value.list()[2].number()};
}
bool SameAnswer(const Value& a, const Value& b) {
  if (IsPoint(a) && IsPoint(b)) return Close(PointOf(a), PointOf(b));
  return model::Same(a, b);
}
std::string AnswerText(const Value& value) {
  return IsPoint(value) ? PointText(value) : ValueText(value);
}

using Answers = std::vector<std::pair<std::string, Value>>;

// Names that occur several times are numbered.
Answers Numbered(const Answers& answers) {
  Answers out;
  for (const auto& [name, value] : answers) {
    const auto same = [&, prefix = name](const auto& other) { return other.first == prefix; };
    const auto count = std::count_if(answers.begin(), answers.end(), same);
    const auto before = std::count_if(
        answers.begin(), answers.begin() + static_cast<std::ptrdiff_t>(out.size()), same);
    out.emplace_back(count > 1 ? name + " " + std::to_string(before + 1) : name, value);
  }
  return out;
}

// The data points of a trace are dots of its photograph: x and y in pixels.
Answers AsKeyedIn(const Firing& firing) {
  const interp::Command* row = interp::FindCommand(firing.command);
  Answers out = firing.answers;
  if (!row || !row->dots) return out;
  for (auto& [name, value] : out) {
    if (name != "point" || !IsPoint(value)) continue;
    const geom::Vec3 dot = PointOf(value);
    name = "dot";
    value =
        Value::List({Value::Number(dot.x(), model::kPixel), Value::Number(dot.y(), model::kPixel)});
  }
  return out;
}

class Differ {
 public:
  Differ(const RunRecord& a, const RunRecord& b) : a_(a), b_(b), match_(MatchElements(a, b)) {}

  Difference Run() {
    for (std::size_t j = 0; j < match_.b.size(); ++j) NoteLater(j);
    for (std::size_t i = 0; i < match_.a.size(); ++i) NoteRemoved(i);
    std::stable_sort(
        out_.changes.begin(), out_.changes.end(),
        [](const ElementChange& x, const ElementChange& y) { return x.kind < y.kind; });
    return std::move(out_);
  }

 private:
  // Whether an element stands for itself: at the top, or in a group that has a counterpart.
  static bool StandsAlone(const std::vector<Subject>& list, const std::vector<int>& match,
                          const Subject& subject) {
    return subject.parent < 0 ||
           (match[static_cast<std::size_t>(subject.parent)] >= 0 &&
            StandsAlone(list, match, list[static_cast<std::size_t>(subject.parent)]));
  }
  void NoteLater(std::size_t j) {
    const Subject& later = match_.b[j];
    const int i = match_.a_of_b[j];
    if (i == ElementMatch::kWithin) return;
    if (i == ElementMatch::kFree) {
      if (StandsAlone(match_.b, match_.a_of_b, later)) Note(ElementChange::kAdded, nullptr, &later);
      return;
    }
    const Subject& earlier = match_.a[static_cast<std::size_t>(i)];
    if (earlier.element->hash == later.element->hash) {
      if (later.parent < 0) ++out_.equal;
      return;
    }
    NotePair(earlier, later);
  }
  void NoteRemoved(std::size_t i) {
    if (match_.b_of_a[i] != ElementMatch::kFree ||
        !StandsAlone(match_.a, match_.b_of_a, match_.a[i]))
      return;
    Note(ElementChange::kRemoved, &match_.a[i], nullptr);
  }

  ElementChange& Note(ElementChange::Kind kind, const Subject* earlier, const Subject* later) {
    ElementChange change;
    change.kind = kind;
    const Subject& told = later ? *later : *earlier;
    change.name = told.name;
    change.type = model::TypeOf(*told.element);
    change.in_group = told.parent >= 0;
    if (earlier)
      change.place_before = PlaceOf(a_, *earlier), change.before = MeasuresOf(*earlier->element);
    if (later) change.place_after = PlaceOf(b_, *later), change.after = MeasuresOf(*later->element);
    out_.changes.push_back(std::move(change));
    return out_.changes.back();
  }
  static std::optional<SourcePlace> PlaceOf(const RunRecord& record, const Subject& subject) {
    if (subject.firing == kNoFiring) return std::nullopt;
    const interp::Span& span = record.firings[subject.firing].at;
    const interp::SourceText& file = record.result.sources->files[span.file];
    SourcePlace place{file.path, file.PlaceOf(span.begin).line};
    for (const Value& turn : record.firings[subject.firing].turns) {
      place.turns.push_back(ValueText(turn));
    }
    return place;
  }

  void NotePair(const Subject& earlier, const Subject& later) {
    const Element &x = *earlier.element, &y = *later.element;
    const auto displaced = RigidDisplacement(x, y);
    ElementChange& change = Note(ElementChange::kChanged, &earlier, &later);
    std::vector<ParameterChange> kept = KeptChanges(x, y);
    if (displaced && kept.empty()) {
      change.kind = ElementChange::kMoved;
    }
    change.largest_m = displaced ? displaced->largest_m : LargestDistance(x, y);
    if (displaced && displaced->largest_m > 0) change.by_m = displaced->by_m;
    change.parameters = std::move(kept);
    AddParameters(x, y, &change.parameters);
    for (ParameterChange& found : PhotographChanges(x, y)) {
      change.parameters.push_back(std::move(found));
    }
    AddFirings(earlier, later, &change.parameters);
    const auto repeats = [&](std::size_t at) {
      return std::any_of(
          change.parameters.begin(), change.parameters.begin() + static_cast<std::ptrdiff_t>(at),
          [&](const ParameterChange& other) { return other.name == change.parameters[at].name; });
    };
    for (std::size_t at = change.parameters.size(); at-- > 0;) {
      if (repeats(at))
        change.parameters.erase(change.parameters.begin() + static_cast<std::ptrdiff_t>(at));
    }
  }

  // Type, name and settings.
  static std::vector<ParameterChange> KeptChanges(const Element& x, const Element& y) {
    std::vector<ParameterChange> out;
    const auto note = [&](std::string_view name, std::string before, std::string after) {
      if (before != after) out.push_back({std::string(name), std::move(before), std::move(after)});
    };
    const model::Attributes &p = *x.attributes, &q = *y.attributes;
    note("type", model::TypeOf(x), model::TypeOf(y));
    note("name", std::string(x.name_or_empty()), std::string(y.name_or_empty()));
    note("co", model::Describe(p.colour), model::Describe(q.colour));
    note("lc", std::to_string(p.linestyle), std::to_string(q.linestyle));
    note("wt", std::to_string(p.weight), std::to_string(q.weight));
    note("lv", p.level, q.level);
    note("mt", p.material, q.material);
    note("ev", std::string(model::WordOf(p.evidence)), std::string(model::WordOf(q.evidence)));
    note("source", p.source, q.source);
    const auto *text_x = std::get_if<model::TextPtr>(&x.geometry),
               *text_y = std::get_if<model::TextPtr>(&y.geometry);
    if (text_x && text_y) note("text", (*text_x)->content, (*text_y)->content);
    const auto *group_x = std::get_if<model::GroupPtr>(&x.geometry),
               *group_y = std::get_if<model::GroupPtr>(&y.geometry);
    if (group_x && group_y)
      note("members", std::to_string((*group_x)->members.size()),
           std::to_string((*group_y)->members.size()));
    return out;
  }

  // Of placed elements, defaults included.
  static void AddParameters(const Element& x, const Element& y, std::vector<ParameterChange>* out) {
    const auto *p = std::get_if<model::InstancePtr>(&x.geometry),
               *q = std::get_if<model::InstancePtr>(&y.geometry);
    if (!p || !q) return;
    CompareAnswers((*p)->prototype->parameters, (*q)->prototype->parameters, "", out);
  }
  void AddFirings(const Subject& earlier, const Subject& later,
                  std::vector<ParameterChange>* out) const {
    if (earlier.firing == kNoFiring || later.firing == kNoFiring) return;
    Compare(a_.firings[earlier.firing], b_.firings[later.firing], "", out);
    const auto changes = [](const RunRecord& record, const Subject& subject) {
      const model::ElementId id = subject.element->id;
      return id < record.origins.size() ? record.origins[id].changes : std::vector<std::uint32_t>{};
    };
    const auto p = changes(a_, earlier), q = changes(b_, later);
    if (p.size() != q.size()) return;
    for (std::size_t n = 0; n < p.size(); ++n) {
      const Firing &before = a_.firings[p[n]], &after = b_.firings[q[n]];
      Compare(before, after, after.command + " ", out);
    }
  }
  static void Compare(const Firing& x, const Firing& y, const std::string& prefix,
                      std::vector<ParameterChange>* out) {
    if (x.command != y.command) return;
    CompareAnswers(Numbered(AsKeyedIn(x)), Numbered(AsKeyedIn(y)), prefix, out);
  }
  static void CompareAnswers(const Answers& x, const Answers& y, const std::string& prefix,
                             std::vector<ParameterChange>* out) {
    const auto find = [](const Answers& answers, const std::string& name) -> const Value* {
      const auto found = std::find_if(answers.begin(), answers.end(),
                                      [&](const auto& answer) { return answer.first == name; });
      return found == answers.end() ? nullptr : &found->second;
    };
    const auto note = [&](const std::string& name, const Value* before, const Value* after) {
      if (before && after && SameAnswer(*before, *after)) return;
      const std::string old_text = before ? AnswerText(*before) : "",
                        new_text = after ? AnswerText(*after) : "";
      if (old_text != new_text) out->push_back({prefix + name, old_text, new_text});
    };
    for (const auto& [name, value] : x) note(name, &value, find(y, name));
    for (const auto& [name, value] : y) {
      if (!find(x, name)) note(name, nullptr, &value);
    }
  }

  const RunRecord& a_;
  const RunRecord& b_;
  ElementMatch match_;
  Difference out_;
};

}  // namespace

Difference Diff(const RunRecord& a, const RunRecord& b) {
  const model::Model &x = a.result.outcome.state.model, &y = b.result.outcome.state.model;
  if (x.hash == y.hash && x.live == y.live) return {{}, y.live};
  return Differ(a, b).Run();
}

}  // namespace tranos::session
