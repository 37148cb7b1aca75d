// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/commands/construction.h"

#include <cmath>

namespace tranos::interp {

using geom::Vec3;
using model::State;

namespace {

// from= and to=, or direction= with its own length or that of height=, or height= alone.
tl::expected<Vec3, CommandError> GivenVector(const State& state, const Answers& answers) {
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

}  // namespace

tl::expected<Vec3, CommandError> ProjectionVector(const State& state, const Answers& answers) {
  const auto vector = GivenVector(state, answers);
  if (vector && vector->norm() <= geom::kCoincident_m) {
    return Fail({.code = Code::kDegenerate, .message = "a projection of no length"});
  }
  return vector;
}

tl::expected<Turn, CommandError> TurnOf(const Answers& answers) {
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
  return Turn{*from, axis, std::min(std::abs(angle_rad), 2 * geom::kPi)};
}

}  // namespace tranos::interp
