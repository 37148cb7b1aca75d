// SPDX-License-Identifier: GPL-3.0-or-later
// What the commands on photographs share.
#pragma once

#include "interp/command.h"

namespace tranos::interp {

// Where traces lie that name no facade.
inline constexpr std::string_view kMainFacade = "main";
inline constexpr double kDegree = geom::kPi / 180;

// The photograph or camera that a statement means: by its name in a bare word, by photo= (or the
// key with this name), or the one last attached or set.
tl::expected<model::ElementPtr, CommandError> PhotographMeant(const model::State& state,
                                                              const Answers& answers);
// The photograph or camera that a key gives, or else the one last attached or set.
tl::expected<model::ElementPtr, CommandError> PhotographAt(const model::State& state,
                                                           const Answers& answers,
                                                           std::string_view key);
// As PhotographAt, with a camera whose every number is known.
tl::expected<model::ElementPtr, CommandError> CameraAt(const model::State& state,
                                                       const Answers& answers,
                                                       std::string_view key);
// As PhotographMeant, of one that `calibrate` finds the camera of, or whose camera is stated: what
// is said of a rendered one before it is attached would have no part in anything.
tl::expected<model::ElementPtr, CommandError> TracedPhotograph(const model::State& state,
                                                               const Answers& answers);
const model::Photograph& PhotographOf(const model::Element& element);
model::ElementPtr WithPhotograph(const model::Element& element, model::Photograph photograph);
CommandError NoCameraYet(const model::Element& photograph);
// What is said of a dot that lies more than a quarter of the photograph's size beyond its border,
// further than an edge that leaves the picture is followed.
std::optional<CommandError> OutsidePhotograph(const camera::Frame& frame, const geom::Vec2& dot_px,
                                              Code code);
// The warning of a dot outside the photograph by less than that.
std::optional<CommandError> JustOutsidePhotograph(const camera::Frame& frame,
                                                  const geom::Vec2& dot_px);
// An error where file= is given and names no png; `what` is written as one: "an orthophoto".
std::optional<CommandError> NotPng(const Answers& answers, std::string_view what);
// What is seen on a photograph: upright, 8 bits a channel, the same object however often it is
// asked for in a run. Errors: kNoPhotograph (a stated camera, a damaged file), kCannotRead (a
// replay, which has no pixels).
tl::expected<camera::PhotoPtr, CommandError> PixelsOf(const model::Element& photograph);

}  // namespace tranos::interp
