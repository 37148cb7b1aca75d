// SPDX-License-Identifier: GPL-3.0-or-later
// construct surface: from edges, by projection, by revolution, ruled, lofted, round a path.
#include <fmt/format.h>

#include <cmath>

#include "interp/commands/construction.h"
#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/commands/range.h"

namespace tranos::interp {

using geom::Vec3;
using model::State;

namespace {

CommandResult EdgeSurface(const State& state, const Answers& answers) {
  const auto curves = CurvesOf(answers, "an edge surface");
  if (!curves) return Fail(curves.error());
  if (curves->size() < 3 || curves->size() > 4) {
    return Fail({.code = Code::kWrongCount,
                 .message = fmt::format("an edge surface is made from 3 or 4 edges, not {}",
                                        curves->size()),
                 .help = "`create chain` joins several curves to one edge"});
  }
  auto surface = geom::EdgeSurface(*curves);
  if (!surface) return Fail(FromGeom(surface.error(), "an edge surface"));
  return MakeFromChosen(state, answers, {SurfaceGeometry(std::move(*surface))});
}

// One surface from each of the chosen curves.
template <class F>
CommandResult FromEach(const State& state, const Answers& answers, std::string_view what,
                       F&& make) {
  const auto curves = CurvesOf(answers, what);
  if (!curves) return Fail(curves.error());
  std::vector<model::Geometry> surfaces;
  for (std::size_t i = 0; i < curves->size(); ++i) {
    geom::Result<geom::Surface> surface = make((*curves)[i]);
    if (!surface) {
      return Fail(FromGeom(surface.error(), what, {Where::kChosen, static_cast<int>(i), {}}));
    }
    surfaces.push_back(SurfaceGeometry(std::move(*surface)));
  }
  return MakeFromChosen(state, answers, std::move(surfaces));
}

CommandResult Projection(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto vector = ProjectionVector(state, answers);
  if (!vector) return Fail(vector.error());
  return FromEach(state, answers, "a projection",
                  [&](const geom::Curve& curve) { return geom::Extrusion(curve, *vector); });
}

CommandResult Revolution(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto turn = TurnOf(answers);
  if (!turn) return Fail(turn.error());
  return FromEach(state, answers, "a revolution", [&](const geom::Curve& curve) {
    return geom::Revolution(curve, turn->point, turn->axis, turn->angle_rad);
  });
}

CommandResult Ruled(const State& state, const Answers& answers) {
  const auto curves = CurvesOf(answers, "a ruled surface");
  if (!curves) return Fail(curves.error());
  if (curves->size() != 2) {
    return Fail({.code = Code::kWrongCount,
                 .message = fmt::format("a ruled surface is made from two curves, not {}",
                                        curves->size())});
  }
  auto surface = geom::Ruled((*curves)[0], (*curves)[1]);
  if (!surface) return Fail(FromGeom(surface.error(), "a ruled surface"));
  return MakeFromChosen(state, answers, {SurfaceGeometry(std::move(*surface))});
}

CommandResult Loft(const State& state, const Answers& answers) {
  const auto curves = CurvesOf(answers, "a loft");
  if (!curves) return Fail(curves.error());
  auto surface = geom::LoftSurface(*curves);
  if (!surface) return Fail(FromGeom(surface.error(), "a loft"));
  return MakeFromChosen(state, answers, {SurfaceGeometry(std::move(*surface))});
}

CommandResult Tube(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const model::Settings& settings = *state.drawing.settings;
  const double radius_m = answers.Number("radius");
  if (!(radius_m > geom::kCoincident_m)) {
    return Fail({.code = Code::kOutOfRange,
                 .message = fmt::format("`radius` is {}, and must be above zero",
                                        InWords(radius_m, settings)),
                 .label = "above 0 and at most 1e9 m",
                 .where = AtKey("radius")});
  }
  const auto curves = CurvesOf(answers, "a tube");
  if (!curves) return Fail(curves.error());
  std::vector<model::Geometry> surfaces;
  for (std::size_t i = 0; i < curves->size(); ++i) {
    const auto of_radius = [&](double r) {
      return geom::Tube((*curves)[i], r, settings.plane.z(), settings.tolerance);
    };
    auto surface = of_radius(radius_m);
    if (!surface && surface.error().code == geom::ErrorCode::kOutOfRange) {
      CommandError error = FromGeom(surface.error(), "a tube", AtKey("radius"));
      error.label = RangeInWords(
          LargestThatWorks(radius_m, [&](double r) { return of_radius(r).has_value(); }), settings);
      return Fail(error);
    }
    if (!surface) return Fail(FromGeom(surface.error(), "a tube", AtChosen(i)));
    surfaces.push_back(SurfaceGeometry(std::move(*surface)));
  }
  return MakeFromChosen(state, answers, std::move(surfaces));
}

constexpr Prompt kEdgePrompts[] = {{"edge, or a point off everything to accept"}};
constexpr Prompt kProfilePrompts[] = {{"profile, or a point off everything to accept"}};
constexpr Prompt kPathPrompts[] = {{"path, or a point off everything to accept"}};
constexpr Prompt kRailPrompts[] = {{"curve, or a point off everything to accept"}};

constexpr Key kEdgeKeys[] = {kOf, kKeep};
constexpr Example kEdgeExamples[] = {
    {"place line xy=0,0,0 dl=4 dl=0,4 dl=-4,-4 as sides\n"
     "construct surface edge of=sides keep=true; choose all; move xy=0,0,0 dl=0",
     "len(last) == 4"},
    {"place line xy=0,0,0 dl=4 dl=0,4 dl=-4 dl=0,-4 as sides; construct surface edge of=sides",
     "last.area within 16m2 +- 0.000001m2"},
    {"place line xy=0,0,0 dl=4 dl=0,4 dl=-4 dl=5,9 as sides; construct surface edge of=sides",
     "E0502"}};
constexpr Example kProjectionExamples[] = {
    {"place line xy=0,0,0 dl=4 as base; construct surface projection of=base height=3",
     "last.area within 12m2 +- 0.000001m2"},
    {"place line xy=0,0,0 dl=4 as base\n"
     "construct surface projection of=base from=[0,0,0] to=[0,0,2] keep=true",
     "last.area within 8m2 +- 0.000001m2"},
    {"place line xy=0,0,0 dl=4 as base; construct surface projection of=base direction=[0,1,1] "
     "height=2",
     "last.area within 8m2 +- 0.000001m2"},
    {"place line xy=0,0,0 dl=4 as base; construct surface projection of=base", "E0220"}};
constexpr Example kRevolutionExamples[] = {
    {"place line xy=1,0,0 dl=0,0,2 as side\n"
     "construct surface revolution of=side from=[0,0,0] to=[0,0,1] keep=true\n"
     "choose all; move xy=0,0,0 dl=0",
     "len(last) == 2"},
    {"place line xy=1,0,0 dl=0,0,2 as side\n"
     "construct surface revolution of=side from=[0,0,0] to=[0,0,1]",
     "last.area within 12.566371m2 +- 0.000001m2"},
    {"place line xy=1,0,0 dl=0,0,2 as side\n"
     "construct surface revolution of=side from=[0,0,0] to=[0,0,1] angle=90",
     "last.area within 3.141593m2 +- 0.000001m2"},
    {"place line xy=1,0,0 dl=0,0,2 as side\n"
     "construct surface revolution of=side from=[0,0,1] to=[0,0,1]",
     "E0501"}};
constexpr Example kRuledExamples[] = {
    {"place line xy=0,0,0 dl=4 as a; place line xy=0,3,0 dl=4 as b\n"
     "construct surface ruled of=[a, b] keep=true; choose all; move xy=0,0,0 dl=0",
     "len(last) == 3"},
    {"place line xy=0,0,0 dl=4 as a; place line xy=0,3,0 dl=4 as b; construct surface ruled "
     "of=[a, b]",
     "last.area within 12m2 +- 0.000001m2"},
    {"place point xy=0,0,0 as a; place line xy=0,3,0 dl=4 as b; construct surface ruled of=[a, b]",
     "E0410"}};

constexpr Key kTubeKeys[] = {
    kOf, kKeep, {"radius", Type::kLength, "of the tube", {}, {}, -1, true}};
constexpr Example kLoftExamples[] = {
    {"place line xy=0,0,0 dl=4 as a; place line xy=0,2,0 dl=4 as b\n"
     "place line xy=4,5,0 dl=-4 as c; construct surface loft of=[a, b, c] keep=true",
     "last.area within 20m2 +- 0.000001m2"},
    {"place circle xy=0,0,0 radius=2 as a; place circle xy=0,0,3 radius=2 as b\n"
     "construct surface loft of=[a, b]",
     "last.area within 37.699112m2 +- 0.000001m2"},
    {"place point xy=0,0,0 as a; place line xy=0,3,0 dl=4 as b; construct surface loft of=[a, b]",
     "E0410"}};
constexpr Example kTubeExamples[] = {
    {"place line xy=0,0,0 dl=4 as rail; construct surface tube of=rail radius=0.5 keep=true",
     "last.area within 12.566371m2 +- 0.000001m2"},
    {"place circle xy=0,0,0 radius=2 as ring; construct surface tube of=ring radius=0.5",
     "last.area within 39.478418m2 +- 0.000001m2"},
    {"place circle xy=0,0,0 radius=2 as ring; construct surface tube of=ring radius=2", "E0212"}};

constexpr Command kCommands[] = {
    {.words = "construct surface edge",
     .family = "construct",
     .summary =
         "Spans a Coons patch between three or four curves that meet at their ends, chosen in "
         "any order and direction.",
     .manner = Manner::kPicks,
     .prompts = kEdgePrompts,
     .least = 3,
     .most = 4,
     .keys = kEdgeKeys,
     .examples = kEdgeExamples,
     .execute = EdgeSurface},
    {.words = "construct surface projection",
     .family = "construct",
     .summary =
         "Projects a profile along a straight line into a surface: a line into a wall's face, an "
         "arc into a barrel vault.",
     .manner = Manner::kPicks,
     .prompts = kProfilePrompts,
     .keys = kProjectionKeys,
     .examples = kProjectionExamples,
     .execute = Projection},
    {.words = "construct surface revolution",
     .family = "construct",
     .summary = "Turns a profile about an axis into a surface: a dome, a drum, a baluster.",
     .manner = Manner::kPicks,
     .prompts = kProfilePrompts,
     .keys = kRevolutionKeys,
     .examples = kRevolutionExamples,
     .execute = Revolution},
    {.words = "construct surface ruled",
     .family = "construct",
     .summary = "Joins two curves by straight lines into a surface.",
     .manner = Manner::kPicks,
     .prompts = kRailPrompts,
     .least = 2,
     .most = 2,
     .keys = kEdgeKeys,
     .examples = kRuledExamples,
     .execute = Ruled},
    {.words = "construct surface loft",
     .family = "construct",
     .summary = "Runs smoothly through a row of profiles, in the order in which they are chosen: a "
                "vault that widens, a ship's hull.",
     .manner = Manner::kPicks,
     .prompts = kProfilePrompts,
     .least = 2,
     .keys = kEdgeKeys,
     .examples = kLoftExamples,
     .execute = Loft},
    {.words = "construct surface tube",
     .family = "construct",
     .summary = "Carries a circle along a path, mitred at corners: a rail, a pipe, a rib.",
     .manner = Manner::kPicks,
     .prompts = kPathPrompts,
     .keys = kTubeKeys,
     .examples = kTubeExamples,
     .execute = Tube},
};

}  // namespace

std::span<const Command> ConstructCommands() { return kCommands; }

}  // namespace tranos::interp
