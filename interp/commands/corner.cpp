// SPDX-License-Identifier: GPL-3.0-or-later
// fillet, chamfer: corners of curves, and edges of solids, rounded or cut off.
#include "geom/corner.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/commands/range.h"
#include "interp/commands/solid_edges.h"

namespace tranos::interp {

using geom::Curve;
using geom::Vec3;
using model::State;

namespace {

// What is done to corners, at a size that is a factor of the one asked for.
struct Tool {
  std::string_view key;   // of the size, for messages
  std::string_view what;  // "a fillet"
  double size_m;
  std::function<geom::Result<Curve>(const Curve&, double factor, std::optional<geom::Corner>)> one;
  std::function<geom::Result<geom::Joint>(const Curve&, const Curve&, double factor)> two;
  EdgeTool edges;  // what is done to edges of solids
};

bool IsOnePiece(const Curve& curve) {
  return std::holds_alternative<geom::Line>(curve) || std::holds_alternative<geom::Arc>(curve);
}

std::optional<geom::Corner> NearestCorner(const Curve& curve, const Answers& answers) {
  const std::optional<Vec3> at = answers.Point("at");
  if (!at) return std::nullopt;
  std::optional<geom::Corner> nearest;
  for (const geom::Corner& corner : geom::CornersOf(curve)) {
    const auto distance = [&](const geom::Corner& c) { return (c.point - *at).norm(); };
    if (!nearest || distance(corner) < distance(*nearest)) nearest = corner;
  }
  return nearest;
}

// An error that names how large the tool may be, where a smaller one would do.
template <class Works>
CommandError Explained(const State& state, const geom::Error& error, const Tool& tool,
                       std::size_t chosen, const Works& works) {
  if (error.code != geom::ErrorCode::kOutOfRange) {
    geom::Error plain = error;
    plain.part = -1;
    return FromGeom(plain, tool.what, AtChosen(chosen));
  }
  const double largest = LargestThatWorks(1, works);
  CommandError explained = FromGeom(error, tool.what, AtKey(tool.key));
  if (largest > 0) {
    explained.label = RangeInWords(largest * tool.size_m, *state.drawing.settings);
  } else {
    explained.where = AtChosen(chosen);
  }
  return explained;
}

CommandResult AtEachCorner(const State& state, const Answers& answers,
                           const std::vector<Curve>& curves, const Tool& tool) {
  Fired fired;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const auto only = NearestCorner(curves[i], answers);
    auto changed = tool.one(curves[i], 1, only);
    if (!changed) {
      return Fail(Explained(state, changed.error(), tool, i, [&](double factor) {
        return tool.one(curves[i], factor, only).has_value();
      }));
    }
    fired.edit.replaced.push_back(
        model::WithGeometry(*answers.chosen[i], CurveGeometry(*std::move(changed))));
  }
  return fired;
}

CommandResult BetweenTwo(const State& state, const Answers& answers,
                         const std::vector<Curve>& curves, const Tool& tool) {
  auto joint = tool.two(curves[0], curves[1], 1);
  if (!joint) {
    return Fail(Explained(state, joint.error(), tool, 1, [&](double factor) {
      return tool.two(curves[0], curves[1], factor).has_value();
    }));
  }
  Fired fired;
  fired.edit.replaced = {
      model::WithGeometry(*answers.chosen[0], CurveGeometry(std::move(joint->a))),
      model::WithGeometry(*answers.chosen[1], CurveGeometry(std::move(joint->b)))};
  fired.edit.added = {NewElement(state, CurveGeometry(std::move(joint->between)))};
  return fired;
}

CommandResult ApplyTool(const State& state, const Answers& answers, const Tool& tool) {
  if (auto error = NothingChosen(answers)) return Fail(*error);
  if (auto error = TooFar(answers)) return Fail(*error);
  for (const std::string_view key : {tool.key, std::string_view("second")}) {
    if (answers.Has(key) && answers.Number(key) <= geom::kCoincident_m) {
      return Fail({.code = Code::kOutOfRange,
                   .message = fmt::format("`{}` is {}, and must be above zero", key,
                                          InWords(answers.Number(key), *state.drawing.settings)),
                   .label = "above 0",
                   .where = AtKey(key)});
    }
  }
  const bool are_solids =
      std::any_of(answers.chosen.begin(), answers.chosen.end(), [](const auto& element) {
        return std::holds_alternative<model::SolidPtr>(element->geometry);
      });
  if (are_solids) return WorkEdges(state, answers, tool.what, tool.edges);
  const auto curves = CurvesOf(answers, tool.what);
  if (!curves) return Fail(curves.error());
  // Lines and arcs have no corners of their own.
  if (curves->size() == 2 && IsOnePiece((*curves)[0]) && IsOnePiece((*curves)[1])) {
    return BetweenTwo(state, answers, *curves, tool);
  }
  return AtEachCorner(state, answers, *curves, tool);
}

CommandResult Fillet(const State& state, const Answers& answers) {
  const double radius_m = answers.Number("radius");
  return ApplyTool(state, answers,
                   {"radius", "a fillet", radius_m,
                    [=](const Curve& curve, double factor, std::optional<geom::Corner> only) {
                      return geom::Rounded(curve, factor * radius_m, only);
                    },
                    [=](const Curve& a, const Curve& b, double factor) {
                      return geom::RoundedBetween(a, b, factor * radius_m);
                    },
                    FilletOfEdges(state, radius_m)});
}

CommandResult Chamfer(const State& state, const Answers& answers) {
  const double first_m = answers.Number("distance"), second_m = answers.Number("second", first_m);
  return ApplyTool(
      state, answers,
      {"distance", "a chamfer", first_m,
       [=](const Curve& curve, double factor, std::optional<geom::Corner> only) {
         return geom::CutOff(curve, factor * first_m, factor * second_m, only);
       },
       [=](const Curve& a, const Curve& b, double factor) {
         return geom::CutOffBetween(a, b, factor * first_m, factor * second_m);
       },
       ChamferOfEdges(first_m, answers.Has("second") ? std::optional(second_m) : std::nullopt)});
}

constexpr Prompt kPrompts[] = {{"curve or solid, or a point off everything to accept"}};
constexpr Key kAt = {"at", Type::kPoint, "only the corner or edge nearest to this point"};
constexpr Key kFilletKeys[] = {
    kOf, {"radius", Type::kLength, "of the arcs or cylinders", {}, {}, -1, true}, kAt};
constexpr Key kChamferKeys[] = {
    kOf,
    {"distance",
     Type::kLength,
     "along the side that ends in the corner; on a solid, across the face that looks further up "
     "(of upright ones further along y, then x)",
     {},
     {},
     -1,
     true},
    {"second",
     Type::kLength,
     "along the side that begins there, across the other face",
     {},
     "distance"},
    kAt};

constexpr Example kFilletExamples[] = {
    {"place block xy=0,0,0 xy=4,3,0 as slab; fillet of=slab radius=1",
     "slab.area within 11.14159265m2 +- 0.00000001m2"},
    {"place block xy=0,0,0 xy=4,3,0 as slab; fillet of=slab radius=1 at=[4, 3, 0]",
     "slab.area within 11.785398163m2 +- 0.00000001m2"},
    {"place line xy=0,0,0 xy=4,0,0 as a; place line xy=5,1,0 xy=5,4,0 as b\n"
     "fillet of=[a, b] radius=2 as bend",
     "bend.length within 3.14159265m +- 0.00000001m and a.end.x within 3m +- 0.000001m"},
    {"place slab length=4m width=3m height=2m xy=0,0,0 as s; fn=64\n"
     "fillet of=s radius=1m at=[2, 0, 2]",
     "s.volume within 23.14m3 +- 0.01m3"},
    {"place block xy=0,0,0 xy=4,3,0 as slab; fillet of=slab radius=2", "E0212"},
    {"place line xy=0,0,0 dl=4 as a; place line xy=0,1,0 dl=4 as b; fillet of=[a, b] radius=1",
     "E0502"}};
constexpr Example kChamferExamples[] = {
    {"place block xy=0,0,0 xy=4,3,0 as slab; chamfer of=slab distance=1",
     "slab.area within 10m2 +- 0.000001m2"},
    {"place block xy=0,0,0 xy=4,3,0 as slab\n"
     "chamfer of=slab distance=1 second=2 at=[4, 3, 0]",
     "slab.area within 11m2 +- 0.000001m2"},
    {"place slab length=4m width=3m height=2m xy=0,0,0 as s\n"
     "chamfer of=s distance=1m second=0.5m at=[2, 0, 2]",
     "s.volume within 23m3 +- 0.00001m3"},
    {"place block xy=0,0,0 xy=4,3,0 as slab; chamfer of=slab distance=1.6", "E0212"},
    {"place slab length=4m width=3m height=2m xy=0,0,0 as s; chamfer of=s distance=1.1m", "E0212"},
    {"place circle xy=0,0,0 radius=2 as rim; chamfer of=rim distance=1", "E0501"}};

constexpr Command kCommands[] = {
    {.words = "fillet",
     .family = "manipulate",
     .summary =
         "Rounds the corners of curves by arcs that touch both sides; of two lines or arcs, the "
         "corner between them, made longer or shorter to it; of solids, straight edges between "
         "flat faces.",
     .manner = Manner::kEdits,
     .prompts = kPrompts,
     .keys = kFilletKeys,
     .examples = kFilletExamples,
     .execute = Fillet},
    {.words = "chamfer",
     .family = "manipulate",
     .summary =
         "Cuts the corners of curves off by lines; of two lines or arcs, the corner between them, "
         "made longer or shorter to it; of solids, straight edges between flat faces.",
     .manner = Manner::kEdits,
     .prompts = kPrompts,
     .keys = kChamferKeys,
     .examples = kChamferExamples,
     .execute = Chamfer},
};

}  // namespace

std::span<const Command> CornerCommands() { return kCommands; }

}  // namespace tranos::interp
