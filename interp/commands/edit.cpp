// SPDX-License-Identifier: GPL-3.0-or-later
// delete, drop, modify: changes of elements that are there.
#include <fmt/format.h>

#include "interp/commands/families.h"
#include "interp/commands/firing.h"

namespace tranos::interp {

using model::Attributes;
using model::AttributesPtr;
using model::Element;
using model::ElementPtr;
using model::State;

namespace {

CommandResult Delete(const State&, const Answers& answers) {
  if (auto error = NothingChosen(answers)) return Fail(*error);
  Fired fired;
  for (const ElementPtr& element : answers.chosen) fired.edit.deleted.push_back(element->id);
  return fired;
}

ElementPtr Part(const Element& whole, model::Geometry geometry) {
  return model::MakeElement(model::kNoElement, std::move(geometry), whole.attributes, nullptr,
                            whole.tolerance);
}

void DropGroup(const model::Group& group, model::Edit* edit) {
  for (const ElementPtr& member : group.members) {
    (member->id == model::kNoElement ? edit->added : edit->released).push_back(member);
  }
}

// The parts stand for themselves where they stood, with what the placement gave them.
void DropInstance(const Element& whole, const model::Instance& instance, model::Edit* edit) {
  for (const ElementPtr& part : instance.prototype->parts) {
    auto resolved =
        std::make_shared<Attributes>(model::Inherit(*part->attributes, *whole.attributes));
    resolved->own = part->attributes->own | whole.attributes->own;
    const ElementPtr placed = model::Transformed(*part, instance.world_from_prototype);
    edit->added.push_back(model::MakeElement(model::kNoElement, placed->geometry,
                                             std::move(resolved), nullptr, part->tolerance));
  }
}

struct CurveDropper {
  const Element& whole;
  model::Edit* edit;

  bool operator()(const geom::Chain& chain) const {
    for (const geom::Segment& segment : chain.segments) {
      std::visit([&](const auto& part) { Add(geom::Curve(part)); }, segment);
    }
    return true;
  }
  bool operator()(const geom::Polyline& polyline) const {
    const auto& vertices = polyline.vertices;
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      Add(geom::Line{vertices[i - 1], vertices[i]});
    }
    if (polyline.closed) Add(geom::Line{vertices.back(), vertices.front()});
    return true;
  }
  template <class T>
  bool operator()(const T&) const {
    return false;
  }

 private:
  void Add(geom::Curve curve) const {
    edit->added.push_back(Part(whole, CurveGeometry(std::move(curve))));
  }
};

// Whether the element has parts to fall into.
bool DropInto(const Element& element, model::Edit* edit) {
  if (const auto* group = std::get_if<model::GroupPtr>(&element.geometry)) {
    DropGroup(**group, edit);
    return true;
  }
  if (const auto* instance = std::get_if<model::InstancePtr>(&element.geometry)) {
    DropInstance(element, **instance, edit);
    return true;
  }
  if (const auto* curve = std::get_if<model::CurvePtr>(&element.geometry)) {
    return std::visit(CurveDropper{element, edit}, **curve);
  }
  return false;
}

CommandResult Drop(const State&, const Answers& answers) {
  if (auto error = NothingChosen(answers)) return Fail(*error);
  Fired fired;
  for (std::size_t i = 0; i < answers.chosen.size(); ++i) {
    const Element& element = *answers.chosen[i];
    if (!DropInto(element, &fired.edit)) {
      return Fail({.code = Code::kWrongElement,
                   .message = fmt::format("{} has no parts to drop into", NameForMessage(element)),
                   .help = "groups, placed elements, chains, line strings and shapes have",
                   .where = {Where::kChosen, static_cast<int>(i), {}}});
    }
    fired.edit.consumed.push_back(element.id);
  }
  return fired;
}

// The attributes with those of `active` that the words name; all of them, if there are none.
Attributes Changed(Attributes attributes, const Attributes& active, const Answers& answers) {
  const bool all = answers.words.empty();
  const auto names = [&](std::string_view word) { return all || answers.HasWord(word); };
  if (names("color")) attributes.colour = active.colour, attributes.own |= Attributes::kColour;
  if (names("linestyle")) {
    attributes.linestyle = active.linestyle, attributes.own |= Attributes::kLinestyle;
  }
  if (names("weight")) attributes.weight = active.weight, attributes.own |= Attributes::kWeight;
  if (names("level")) attributes.level = active.level, attributes.own |= Attributes::kLevel;
  if (names("material")) {
    attributes.material = active.material, attributes.own |= Attributes::kMaterial;
  }
  if (names("evidence")) {
    attributes.evidence = active.evidence, attributes.own |= Attributes::kEvidence;
    attributes.source = active.source;
  }
  return attributes;
}

ElementPtr Modified(const Element& element, const Attributes& active, const Answers& answers) {
  Element changed = element;
  if (const auto* group = std::get_if<model::GroupPtr>(&element.geometry)) {
    changed.geometry = model::MapMembers(
        **group, [&](const ElementPtr& member) { return Modified(*member, active, answers); });
  }
  auto attributes =
      std::make_shared<const Attributes>(Changed(*element.attributes, active, answers));
  return model::MakeElement(element.id, std::move(changed.geometry), std::move(attributes),
                            element.name, element.tolerance);
}

CommandResult Modify(const State& state, const Answers& answers) {
  if (auto error = NothingChosen(answers)) return Fail(*error);
  Fired fired;
  for (const ElementPtr& element : answers.chosen) {
    fired.edit.replaced.push_back(Modified(*element, *state.drawing.settings->attributes, answers));
  }
  return fired;
}

constexpr Prompt kPrompts[] = {{"element, or a point off everything to accept"}};
constexpr Key kKeys[] = {kOf};

constexpr Example kDeleteExamples[] = {
    {"place point xy=0,0,0; place point xy=1,0,0 as peg; delete of=peg; choose all\n"
     "move xy=0,0,0 dl=0",
     "last.x == 0m"},
    {"place point xy=0,0,0 xy=1,0,0; delete xy=1,0,0 xy=9,9,9; choose all; move xy=0,0,0 dl=2",
     "last.bbox.max.x == 2m"},
    {"delete of=5", "E0203"}};
constexpr Example kDropExamples[] = {
    {"place block xy=0,0,0 xy=4,3,0; drop of=last", "len(last) == 4"},
    {"place line xy=0,0,0 dl=4; drop of=last", "E0410"}};
constexpr Example kModifyExamples[] = {
    {"place point xy=0,0,0; lv=\"roof\"; modify of=last; choose level roof; move xy=0,0,0 dl=1",
     "last.bbox.max.x == 1m"},
    {"place point xy=0,0,0; lv=\"roof\"; co=3; modify color of=last; choose level roof", "E0404"}};

constexpr Command kCommands[] = {
    {.words = "delete",
     .family = "manipulate",
     .summary = "Takes elements out of the model, their names too.",
     .manner = Manner::kEdits,
     .prompts = kPrompts,
     .keys = kKeys,
     .examples = kDeleteExamples,
     .execute = Delete},
    {.words = "drop",
     .family = "manipulate",
     .summary = "Breaks elements into their parts: a group into its members, a placed element into "
                "what it is made of, a chain into its segments, a shape into lines.",
     .manner = Manner::kEdits,
     .prompts = kPrompts,
     .keys = kKeys,
     .examples = kDropExamples,
     .execute = Drop},
    {.words = "modify",
     .family = "manipulate",
     .summary =
         "Gives elements the active colour, linestyle, weight, level, material and evidence, or "
         "only those named.",
     .manner = Manner::kEdits,
     .prompts = kPrompts,
     .keys = kKeys,
     .options = "color|linestyle|weight|level|material|evidence",
     .examples = kModifyExamples,
     .execute = Modify},
};

}  // namespace

std::span<const Command> EditCommands() { return kCommands; }

}  // namespace tranos::interp
