// SPDX-License-Identifier: GPL-3.0-or-later
// construct surface: from edges, by projection, by revolution, ruled.
#include <fmt/format.h>

#include <cmath>

#include "interp/commands/families.h"
#include "interp/commands/firing.h"

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

// from= and to=, or direction= with its own length or that of height=, or height= alone.
tl::expected<Vec3, CommandError> ProjectionVector(const State& state, const Answers& answers) {
  const auto from = answers.Point("from"), to = answers.Point("to"),
             direction = answers.Point("direction");
  const bool by_points = from || to, by_direction = direction || answers.Has("height");
  if (by_points && by_direction) {
    return Fail({.code = Code::kWrongWords,
                 .message = "a projection goes either from a point to a point, or in a direction",
                 .where = {Where::kKey, 0, direction ? "direction" : "height"}});
  }
  if (by_points ? !(from && to) : !by_direction) {
    return Fail({.code = Code::kMissingValue,
                 .message = "how far does the projection go?",
                 .help = "give `height=`, `direction=`, or `from=` and `to=`"});
  }
  if (by_points) return *to - *from;
  if (!direction) return answers.Number("height") * state.drawing.settings->plane.z();
  if (!answers.Has("height") || direction->norm() <= geom::kCoincident_m) return *direction;
  return answers.Number("height") * direction->normalized();
}

CommandResult Projection(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto vector = ProjectionVector(state, answers);
  if (!vector) return Fail(vector.error());
  if (vector->norm() <= geom::kCoincident_m) {
    return Fail({.code = Code::kDegenerate, .message = "a projection of no length"});
  }
  return FromEach(state, answers, "a projection",
                  [&](const geom::Curve& curve) { return geom::Extrusion(curve, *vector); });
}

CommandResult Revolution(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto from = answers.Point("from"), to = answers.Point("to");
  if (!from || !to) {
    return Fail({.code = Code::kMissingValue,
                 .message = "a revolution needs its axis",
                 .help = "give two points of it: `from=` and `to=`"});
  }
  if ((*to - *from).norm() <= geom::kCoincident_m) {
    return Fail({.code = Code::kDegenerate,
                 .message = "an axis of no length",
                 .where = {Where::kKey, 0, "to"}});
  }
  const double angle_rad = answers.Number("angle", 2 * geom::kPi);
  if (std::abs(angle_rad) > 2 * geom::kPi + 1e-12 || std::abs(angle_rad) <= 1e-12) {
    return Fail({.code = Code::kOutOfRange,
                 .message = "a revolution turns more than 0 and at most 360 degrees",
                 .where = {Where::kKey, 0, "angle"}});
  }
  // Turning backwards about an axis is turning forwards about the axis reversed.
  const Vec3 axis = (angle_rad < 0 ? *from - *to : *to - *from).normalized();
  const double turn_rad = std::min(std::abs(angle_rad), 2 * geom::kPi);
  return FromEach(state, answers, "a revolution", [&](const geom::Curve& curve) {
    return geom::Revolution(curve, *from, axis, turn_rad);
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

constexpr Prompt kEdgePrompts[] = {{"edge, or a point off everything to accept"}};
constexpr Prompt kProfilePrompts[] = {{"profile, or a point off everything to accept"}};
constexpr Prompt kRailPrompts[] = {{"curve, or a point off everything to accept"}};

constexpr Key kEdgeKeys[] = {kOf, kKeep};
constexpr Key kProjectionKeys[] = {
    kOf,
    kKeep,
    {"from", Type::kPoint, "start of the projection"},
    {"to", Type::kPoint, "its end"},
    {"direction", Type::kPoint, "its direction, and its length unless `height=` gives that"},
    {"height", Type::kLength,
     "its length, along the active plane's normal unless `direction=` says "
     "otherwise"}};
constexpr Key kRevolutionKeys[] = {
    kOf,
    kKeep,
    {"from", Type::kPoint, "a point of the axis", {}, {}, -1, true},
    {"to", Type::kPoint, "another point of the axis", {}, {}, -1, true},
    {"angle", Type::kAngle, "how far to turn, anticlockwise seen from `to`", {}, "360deg"}};

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
};

}  // namespace

std::span<const Command> ConstructCommands() { return kCommands; }

}  // namespace tranos::interp
