// SPDX-License-Identifier: GPL-3.0-or-later
// construct solid: union, difference, intersection. What they give is evaluated when it is measured
// or written.
#include <fmt/format.h>

#include "interp/commands/families.h"
#include "interp/commands/solids.h"

namespace tranos::interp {

using model::State;

namespace {

// The solids of an element, each in the world.
std::vector<geom::Solid> PartsOf(const model::Element& element) {
  std::vector<geom::Solid> parts;
  model::ForEachLeaf(element, [&](const model::Element& leaf, const geom::Affine& world_from_leaf,
                                  const model::Attributes&) {
    const auto* solid = std::get_if<model::SolidPtr>(&leaf.geometry);
    if (!solid) return;
    const bool in_place = world_from_leaf.matrix() == geom::Affine::Identity().matrix();
    parts.push_back(in_place ? **solid : (*solid)->Transformed(world_from_leaf));
  });
  return parts;
}

// Each element as one solid: a group or a placed element as all its parts together.
tl::expected<std::vector<geom::Solid>, CommandError> OperandsOf(
    const std::vector<model::ElementPtr>& elements, std::string_view what, std::string_view key) {
  std::vector<geom::Solid> operands;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    std::vector<geom::Solid> parts = PartsOf(*elements[i]);
    if (parts.empty()) {
      return Fail({.code = Code::kWrongElement,
                   .message = fmt::format("{} is made from solids, and {} has none", what,
                                          NameForMessage(*elements[i])),
                   .where = key.empty() ? AtChosen(i) : AtKey(key)});
    }
    operands.push_back(geom::Solid::Union(std::move(parts)));
  }
  return operands;
}

CommandResult MakeBoolean(const State& state, const Answers& answers, geom::Solid solid) {
  return MakeFromChosen(state, answers, {std::make_shared<const geom::Solid>(std::move(solid))});
}

CommandResult Union(const State& state, const Answers& answers) {
  auto operands = OperandsOf(answers.chosen, "a union", "");
  if (!operands) return Fail(operands.error());
  return MakeBoolean(state, answers, geom::Solid::Union(*std::move(operands)));
}

CommandResult Intersection(const State& state, const Answers& answers) {
  auto operands = OperandsOf(answers.chosen, "an intersection", "");
  if (!operands) return Fail(operands.error());
  return MakeBoolean(state, answers, geom::Solid::Intersection(*std::move(operands)));
}

CommandResult Difference(const State& state, const Answers& answers) {
  auto operands = OperandsOf(answers.chosen, "a difference", "");
  if (!operands) return Fail(operands.error());
  const auto cutters = ElementsOf(state, answers, "by");
  if (!cutters) return Fail(cutters.error());
  if (cutters->empty()) {
    return Fail({.code = Code::kNothingChosen,
                 .message = "nothing is given to cut by",
                 .where = AtKey("by")});
  }
  auto by = OperandsOf(*cutters, "a difference", "by");
  if (!by) return Fail(by.error());
  CommandResult made = MakeBoolean(
      state, answers,
      geom::Solid::Difference(geom::Solid::Union(*std::move(operands)), *std::move(by)));
  if (made && !answers.Flag("keep")) {
    for (const model::ElementPtr& cutter : *cutters) made->edit.consumed.push_back(cutter->id);
  }
  return made;
}

constexpr Prompt kSolidPrompts[] = {{"solid, or a point off everything to accept"}};

constexpr Key kBooleanKeys[] = {kOf, kKeep};
constexpr Key kDifferenceKeys[] = {
    kOf, kKeep, {"by", Type::kElements, "the solids that are cut away", {}, {}, -1, true}};

constexpr Example kUnionExamples[] = {
    {"place slab length=2m width=2m height=2m xy=0,0,0 as a\n"
     "place slab length=2m width=2m height=2m xy=1,0,0 as b\n"
     "construct solid union of=[a, b]",
     "last.volume within 12m3 +- 0.000001m3"},
    {"place slab length=2m width=2m height=2m xy=0,0,0 xy=9,0,0 as a\n"
     "construct solid union of=a keep=true",
     "last.shells == 2"},
    {"place line xy=0,0,0 dl=4 as a; construct solid union of=a", "E0410"}};
constexpr Example kDifferenceExamples[] = {
    {"place slab length=4m width=4m height=1m xy=0,0,0 as a\n"
     "place slab length=1m width=1m height=3m xy=1,1,-1 as b\n"
     "construct solid difference of=a by=b keep=true",
     "last.genus == 1"},
    {"place slab length=4m width=4m height=1m xy=0,0,0 as a\n"
     "place slab length=1m width=1m height=3m xy=1,1,-1 xy=2.5,1,-1 as b\n"
     "construct solid difference of=a by=b",
     "last.volume within 14m3 +- 0.000001m3"},
    {"place slab length=4m width=4m height=1m xy=0,0,0 as a\n"
     "place slab length=9m width=9m height=9m xy=-1,-1,-1 as b\n"
     "construct solid difference of=a by=b",
     "E0507"}};
constexpr Example kIntersectionExamples[] = {
    {"place slab length=2m width=2m height=2m xy=0,0,0 as a\n"
     "place slab length=2m width=2m height=2m xy=1,0,0 as b\n"
     "construct solid intersection of=[a, b] keep=true",
     "last.volume within 4m3 +- 0.000001m3"},
    {"place slab length=2m width=2m height=2m xy=0,0,0 as a\n"
     "place slab length=2m width=2m height=2m xy=5,0,0 as b\n"
     "construct solid intersection of=[a, b]",
     "E0507"}};

constexpr Command kCommands[] = {
    {.words = "construct solid union",
     .family = "construct",
     .summary = "One solid from several, or from all solids of a group or a placed element.",
     .manner = Manner::kPicks,
     .prompts = kSolidPrompts,
     .keys = kBooleanKeys,
     .examples = kUnionExamples,
     .execute = Union},
    {.words = "construct solid difference",
     .family = "construct",
     .summary = "What is left of solids where others are cut away.",
     .manner = Manner::kPicks,
     .prompts = kSolidPrompts,
     .keys = kDifferenceKeys,
     .examples = kDifferenceExamples,
     .execute = Difference},
    {.words = "construct solid intersection",
     .family = "construct",
     .summary = "What solids have in common.",
     .manner = Manner::kPicks,
     .prompts = kSolidPrompts,
     .least = 2,
     .keys = kBooleanKeys,
     .examples = kIntersectionExamples,
     .execute = Intersection},
};

}  // namespace

std::span<const Command> SolidBooleanCommands() { return kCommands; }

}  // namespace tranos::interp
