// SPDX-License-Identifier: GPL-3.0-or-later
// What surfaces and solids are constructed by: a vector, a turn about an axis.
#pragma once

#include "interp/commands/firing.h"

namespace tranos::interp {

inline constexpr Key kProjectionKeys[] = {
    kOf,
    kKeep,
    {"from", Type::kPoint, "start of the projection"},
    {"to", Type::kPoint, "its end"},
    {"direction", Type::kPoint, "its direction, and its length unless `height=` gives that"},
    {"height", Type::kLength,
     "its length, along the active plane's normal unless `direction=` says "
     "otherwise"}};
inline constexpr Key kRevolutionKeys[] = {
    kOf,
    kKeep,
    {"from", Type::kPoint, "a point of the axis", {}, {}, -1, true},
    {"to", Type::kPoint, "another point of the axis", {}, {}, -1, true},
    {"angle", Type::kAngle, "how far to turn, anticlockwise seen from `to`", {}, "360deg"}};

// What kProjectionKeys say: a vector of some length.
tl::expected<geom::Vec3, CommandError> ProjectionVector(const model::State& state,
                                                        const Answers& answers);

// What kRevolutionKeys say: an angle in (0, 2π] about a unit axis.
struct Turn {
  geom::Vec3 point, axis;
  double angle_rad;
};
tl::expected<Turn, CommandError> TurnOf(const Answers& answers);

}  // namespace tranos::interp
