// SPDX-License-Identifier: GPL-3.0-or-later
// What the families' functions share: checks of answers, and edits made from them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "interp/command.h"

namespace tranos::interp {

// Coordinates and lengths beyond this are refused: sums and squares of them stay finite, and
// a hash still tells points apart.
inline constexpr double kFarthest_m = 1e9;

inline constexpr Key kOf = {"of", Type::kElements, "what to work on, in place of what is chosen"};
inline constexpr Key kKeep = {
    "keep", Type::kBoolean, "leave what it is made from in the model", {}, "false"};

// How far a point may lie off a plane and still count as in it.
inline constexpr double kOffPlane_m = 1e-6;

inline Where AtPoint(int index) { return {Where::kPoint, index, {}}; }
inline Where AtKey(std::string_view key) { return {Where::kKey, 0, key}; }
inline Where AtChosen(std::size_t index) { return {Where::kChosen, static_cast<int>(index), {}}; }

inline tl::unexpected<CommandError> Fail(CommandError error) {
  return tl::unexpected<CommandError>(std::move(error));
}

// The first data point, length or point among the answers that lies beyond kFarthest_m.
std::optional<CommandError> TooFar(const Answers& answers);
// An error if nothing is chosen.
std::optional<CommandError> NothingChosen(const Answers& answers);

// As NothingChosen; photographs and traces, which have no place in space, are refused, too.
std::optional<CommandError> NothingToMove(const Answers& answers);
// The elements that a key lists, as they now are; E0407 at the key if one was deleted.
tl::expected<std::vector<model::ElementPtr>, CommandError> ListedBy(const model::State& state,
                                                                    const Answers& answers,
                                                                    std::string_view key);

// The active plane, moved to this origin.
geom::Frame PlaneAt(const model::State& state, const geom::Vec3& origin);
// The error of a data point that lies this far off it.
CommandError OffPlane(const model::State& state, double height_m, int point);

// An edit that adds one element with the settings now in force.
CommandResult Make(const model::State& state, model::Geometry geometry);
// As Make; takes what it was made from out of the model, unless keep=true.
CommandResult MakeFromChosen(const model::State& state, const Answers& answers,
                             std::vector<model::Geometry> geometries);
void Consume(const Answers& answers, model::Edit* edit);

// The curves among the chosen; E0410 at the first that is none. `what` needs them: "a chain".
tl::expected<std::vector<geom::Curve>, CommandError> CurvesOf(const Answers& answers,
                                                              std::string_view what);
// How an element is named in a message: "the line `sill`", "a line".
std::string NameForMessage(const model::Element& element);
// A length in words, in the working unit: "2.31 m".
std::string InWords(double length_m, const model::Settings& settings);

}  // namespace tranos::interp
