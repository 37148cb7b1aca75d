// SPDX-License-Identifier: GPL-3.0-or-later
// create: one element from several.
#include <fmt/format.h>

#include "interp/commands/families.h"
#include "interp/commands/firing.h"

namespace tranos::interp {

using model::ElementPtr;
using model::State;

namespace {

std::string Ordinal(std::size_t number) {
  const std::size_t last = number % 100 / 10 == 1 ? 0 : number % 10;
  constexpr std::string_view kEndings[] = {"th", "st", "nd", "rd"};
  return fmt::format("{}{}", number, last < 4 ? kEndings[last] : "th");
}

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

// Whether a part must be an outline or may be a region, and where it stands in the key-ins.
tl::expected<geom::Region, CommandError> AsRegion(const model::Element& element, Where where) {
  if (const auto* region = std::get_if<model::RegionPtr>(&element.geometry)) return **region;
  const auto* curve = std::get_if<model::CurvePtr>(&element.geometry);
  if (!curve) {
    return Fail(
        {.code = Code::kWrongElement,
         .message = fmt::format("a region is made from closed curves and regions, and this is {}",
                                NameForMessage(element)),
         .where = where});
  }
  auto region = geom::RegionOf({**curve});
  if (region) return *std::move(region);
  region.error().part = -1;
  return Fail(FromGeom(region.error(), "a region from " + NameForMessage(element), where));
}

std::optional<geom::SetOperation> OperationOf(const Answers& answers) {
  if (answers.HasWord("union")) return geom::SetOperation::kUnion;
  if (answers.HasWord("difference")) return geom::SetOperation::kDifference;
  if (answers.HasWord("intersection")) return geom::SetOperation::kIntersection;
  return std::nullopt;
}

CommandResult CombineRegions(const State& state, const Answers& answers,
                             geom::SetOperation operation) {
  std::vector<geom::Region> of, by;
  for (std::size_t i = 0; i < answers.chosen.size(); ++i) {
    auto region = AsRegion(*answers.chosen[i], AtChosen(i));
    if (!region) return Fail(region.error());
    of.push_back(*std::move(region));
  }
  const auto cutters = ListedBy(state, answers, "by");
  if (!cutters) return Fail(cutters.error());
  for (const ElementPtr& cutter : *cutters) {
    auto region = AsRegion(*cutter, AtKey("by"));
    if (!region) return Fail(region.error());
    by.push_back(*std::move(region));
  }
  auto combined = geom::Combine(of, by, operation, state.drawing.settings->tolerance);
  if (!combined) {
    const bool in_by = combined.error().part >= static_cast<int>(of.size());
    return Fail(FromGeom(combined.error(), "a region", in_by ? AtKey("by") : Where{}));
  }
  if (combined->parts.empty()) {
    return Fail({.code = Code::kDegenerate, .message = "nothing is left of the regions"});
  }
  auto fired =
      MakeFromChosen(state, answers, {std::make_shared<const geom::Region>(*std::move(combined))});
  if (fired && !answers.Flag("keep")) {
    for (const ElementPtr& cutter : *cutters) fired->edit.consumed.push_back(cutter->id);
  }
  return fired;
}

CommandResult CreateRegion(const State& state, const Answers& answers) {
  if (answers.words.size() > 1) {
    return Fail({.code = Code::kWrongWords,
                 .message = "regions are united, subtracted or intersected: one at a time"});
  }
  const auto operation = OperationOf(answers);
  const bool takes_by = operation == geom::SetOperation::kDifference;
  if (takes_by != answers.Has("by")) {
    return Fail(
        {.code = takes_by ? Code::kMissingValue : Code::kWrongWords,
         .message = takes_by ? "what is to be taken away?" : "only a difference takes `by=`",
         .help = "create region difference of=floor by=shaft",
         .where = takes_by ? Where{} : AtKey("by")});
  }
  if (operation) return CombineRegions(state, answers, *operation);
  const auto outlines = CurvesOf(answers, "a region");
  if (!outlines) return Fail(outlines.error());
  auto region = geom::RegionOf(*outlines);
  if (!region) {
    CommandError error = FromGeom(region.error(), "a region");
    if (region.error().part >= 0) {
      const auto part = static_cast<std::size_t>(region.error().part);
      error.label = fmt::format("{}, the {} of {}", NameForMessage(*answers.chosen[part]),
                                Ordinal(part + 1), answers.chosen.size());
    }
    return Fail(error);
  }
  return MakeFromChosen(state, answers, {std::make_shared<const geom::Region>(*std::move(region))});
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
constexpr Key kRegionKeys[] = {
    kOf, {"by", Type::kElements, "of a difference: what is taken away"}, kKeep};
constexpr Example kRegionExamples[] = {
    {"place circle radius=5 xy=0,0,0 as rim; place circle radius=2 xy=0,0,0 as eye\n"
     "create region of=[rim, eye] as ring",
     "ring.area within 65.973446m2 +- 0.000001m2 and ring.holes == 1"},
    {"place block xy=0,0,0 xy=4,3,0 as floor; place block xy=1,1,0 xy=2,2,0 as shaft\n"
     "create region difference of=floor by=shaft keep=true",
     "last.area within 11m2 +- 0.000001m2"},
    {"place block xy=0,0,0 xy=4,3,0 as hall; place block xy=4,0,0 xy=6,3,0 as apse\n"
     "create region union of=[hall, apse]",
     "last.perimeter within 18m +- 0.000001m"},
    {"place block xy=0,0,0 xy=4,3,0; place block xy=3,0,0 xy=6,3,0; choose all; create region",
     "E0501"},
    {"place line xy=0,0,0 xy=4,3,0; create region of=last", "E0503"},
    {"place block xy=0,0,0 xy=4,3,0; create region difference of=last", "E0220"}};
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
    {.words = "create region",
     .family = "create",
     .summary =
         "A plane face from closed outlines, those inside others being its holes; or what regions "
         "and outlines make together, less others, or in common.",
     .manner = Manner::kPicks,
     .prompts = kPartPrompts,
     .keys = kRegionKeys,
     .options = "union|difference|intersection",
     .examples = kRegionExamples,
     .execute = CreateRegion},
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
