// SPDX-License-Identifier: GPL-3.0-or-later
// create: one element from several.
#include <fmt/format.h>

#include "interp/commands/families.h"
#include "interp/commands/firing.h"

namespace tranos::interp {

using model::ElementPtr;
using model::State;

namespace {

CommandError DoesNotMeet(const geom::Error& error, std::string_view what, const Answers& answers) {
  CommandError out = FromGeom(error, what);
  if (error.code == geom::ErrorCode::kDoNotMeet && error.part > 0 &&
      error.part < static_cast<int>(answers.chosen.size())) {
    const auto part = static_cast<std::size_t>(error.part);
    out.label =
        fmt::format("{} does not reach the one before it", NameForMessage(*answers.chosen[part]));
    out.help = "parts are joined in the order in which they were chosen";
  }
  return out;
}

CommandResult CreateChain(const State& state, const Answers& answers) {
  const auto curves = CurvesOf(answers, "a chain");
  if (!curves) return Fail(curves.error());
  auto chain = geom::JoinChain(*curves);
  if (!chain) return Fail(DoesNotMeet(chain.error(), "a chain", answers));
  return MakeFromChosen(state, answers, {CurveGeometry(std::move(*chain))});
}

// The corners, if every part of the closed chain is straight.
std::optional<geom::Polyline> CornersOf(const geom::Chain& chain) {
  geom::Polyline shape{{}, true};
  for (const geom::Segment& segment : chain.segments) {
    if (const auto* line = std::get_if<geom::Line>(&segment)) {
      shape.vertices.push_back(line->start);
    } else if (const auto* piece = std::get_if<geom::Polyline>(&segment); piece && !piece->closed) {
      shape.vertices.insert(shape.vertices.end(), piece->vertices.begin(),
                            piece->vertices.end() - 1);
    } else {
      return std::nullopt;
    }
  }
  return shape;
}

tl::expected<geom::Curve, CommandError> Outline(const Answers& answers,
                                                std::vector<geom::Curve> curves) {
  if (curves.size() == 1 && geom::IsClosed(curves[0])) return std::move(curves[0]);
  auto chain = geom::JoinChain(curves);
  if (!chain) return Fail(DoesNotMeet(chain.error(), "a shape", answers));
  if (!chain->closed) {
    return Fail({.code = Code::kNotClosed,
                 .message = "a shape is closed, and these parts leave a gap",
                 .label = "the last does not reach the first"});
  }
  if (auto corners = CornersOf(*chain)) return geom::Curve(std::move(*corners));
  return geom::Curve(std::move(*chain));
}

CommandResult CreateShape(const State& state, const Answers& answers) {
  auto curves = CurvesOf(answers, "a shape");
  if (!curves) return Fail(curves.error());
  auto outline = Outline(answers, std::move(*curves));
  if (!outline) return Fail(outline.error());
  const auto area = geom::EnclosedArea(*outline);
  if (!area) return Fail(FromGeom(area.error(), "a shape"));
  return MakeFromChosen(state, answers, {CurveGeometry(std::move(*outline))});
}

CommandResult CreateGroup(const State& state, const Answers& answers) {
  if (auto error = NothingChosen(answers)) return Fail(*error);
  const bool keep = answers.Flag("keep");
  model::Group group;
  model::Edit edit;
  for (std::size_t i = 0; i < answers.chosen.size(); ++i) {
    const ElementPtr& element = answers.chosen[i];
    if (!keep && !state.model.InModel(element->id)) {
      return Fail(
          {.code = Code::kWrongElement,
           .message = fmt::format("{} belongs to a group already", NameForMessage(*element)),
           .help = "`drop` the group first, or group copies with keep=true",
           .where = {Where::kChosen, static_cast<int>(i), {}}});
    }
    group.members.push_back(element);
    if (!keep) edit.grouped.push_back(element->id);
  }
  // The members keep their own settings; the group has none to give them.
  model::Attributes attributes = *state.drawing.settings->attributes;
  attributes.own = 0;
  edit.added.push_back(model::MakeElement(model::kNoElement, model::MakeGroup(std::move(group)),
                                          std::make_shared<const model::Attributes>(attributes),
                                          nullptr, state.drawing.settings->tolerance));
  return Fired{.edit = std::move(edit)};
}

constexpr Prompt kPartPrompts[] = {{"part, or a point off everything to accept"}};
constexpr Key kKeys[] = {kOf, kKeep};

constexpr Example kChainExamples[] = {
    {"place line xy=0,0,0 dl=3 dl=0,4 as parts; create chain of=parts keep=true; choose all\n"
     "move xy=0,0,0 dl=0",
     "len(last) == 3"},
    {"place line xy=0,0,0 dl=3 dl=0,4; create chain xy=1,0,0 xy=3,2,0 xy=50,50,0",
     "last.length == 7m"},
    {"place line xy=0,0,0 dl=3; place line xy=0,9,0 dl=3; choose all; create chain", "E0502"}};
constexpr Example kShapeExamples[] = {
    {"place line xy=0,0,0 dl=4 dl=0,3 dl=-4,-3 as sides; create shape of=sides keep=true\n"
     "choose all; move xy=0,0,0 dl=0",
     "len(last) == 4"},
    {"place line xy=0,0,0 dl=4 dl=0,3 dl=-4,-3 as sides; create shape of=sides",
     "last.area within 6m2 +- 0.000001m2"},
    {"place line xy=0,0,0 dl=4 dl=0,3 as sides; create shape of=sides", "E0503"}};
constexpr Example kGroupExamples[] = {
    {"place point xy=0,0,0 as post; create group of=post keep=true; choose all\n"
     "move xy=0,0,0 dl=0",
     "len(last) == 2"},
    {"place point xy=0,0,0 xy=5,0,0 as posts; create group of=posts; choose element xy=0,0,0\n"
     "move xy=0,0,0 dl=1",
     "last.bbox.max.x == 6m"},
    {"create group of=5", "E0203"}};

constexpr Command kCommands[] = {
    {.words = "create chain",
     .family = "create",
     .summary =
         "Joins lines, arcs and other open curves end to end into one chain, in the order in "
         "which they are chosen.",
     .manner = Manner::kPicks,
     .prompts = kPartPrompts,
     .least = 2,
     .keys = kKeys,
     .examples = kChainExamples,
     .execute = CreateChain},
    {.words = "create shape",
     .family = "create",
     .summary =
         "Joins curves into one closed planar outline, in the order in which they are chosen.",
     .manner = Manner::kPicks,
     .prompts = kPartPrompts,
     .keys = kKeys,
     .examples = kShapeExamples,
     .execute = CreateShape},
    {.words = "create group",
     .family = "create",
     .summary =
         "Binds elements into a group, which is picked, moved and drawn as one; they stay what "
         "they are inside.",
     .manner = Manner::kPicks,
     .prompts = kPartPrompts,
     .keys = kKeys,
     .examples = kGroupExamples,
     .execute = CreateGroup},
};

}  // namespace

std::span<const Command> CreateCommands() { return kCommands; }

}  // namespace tranos::interp
