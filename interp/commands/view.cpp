// SPDX-License-Identifier: GPL-3.0-or-later
// set view, view, level: how the next picture looks, and what is on it.
#include <fmt/format.h>

#include <algorithm>

#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/commands/photographs.h"

namespace tranos::interp {

using model::RenderMode;
using model::State;

namespace {

constexpr std::string_view kModes = "wireframe|hidden|phong|textured";
constexpr std::string_view kLaterStyles = "evidence|sky";

CommandError WrongWords(std::string message, std::string help) {
  return {.code = Code::kWrongWords, .message = std::move(message), .help = std::move(help)};
}

// The style is what the words say: what is not named is off.
CommandResult SetView(const State& state, const Answers& answers) {
  model::View view = *state.drawing.view;
  view.antialias = answers.HasWord("antialias");
  view.shadows = answers.HasWord("shadows");
  view.textured = answers.HasWord("textured");
  view.photo = answers.HasWord("photo");
  int modes = 0;
  for (const std::string& word : answers.words) {
    if (HasWord(kLaterStyles, word)) {
      return Fail({.code = Code::kNotYet,
                   .message = fmt::format("`set view {}` is not there yet", word),
                   .help = "wireframe, hidden, phong, textured, antialias, shadows, photo"});
    }
    modes += HasWord(kModes, word) ? 1 : 0;
  }
  // What is textured is shaded: `phong textured` says it twice.
  if (view.textured && answers.HasWord("phong")) --modes;
  if (modes > 1) {
    return Fail(WrongWords("a view has one mode", "wireframe, hidden, phong or textured"));
  }
  if (answers.words.empty()) {
    return Fail(WrongWords("how is the view to look?", "set view phong antialias"));
  }
  if (answers.HasWord("wireframe")) view.mode = RenderMode::kWireframe;
  if (answers.HasWord("hidden")) view.mode = RenderMode::kHidden;
  if (answers.HasWord("phong") || answers.HasWord("textured")) view.mode = RenderMode::kPhong;
  Fired fired;
  fired.edit.view = view;
  return fired;
}

constexpr std::string_view kDirections = "front|right|left|back|top|iso";

CommandResult TurnView(const State& state, const Answers& answers) {
  if (answers.words.size() != 1) {
    return Fail(WrongWords("a view is from one side", "front, right, left, back, top or iso"));
  }
  model::View view = *state.drawing.view;
  view.camera = model::kNoElement;
  for (const std::string& direction : SplitWords(kDirections)) {
    if (answers.HasWord(direction)) view.direction = direction;
  }
  Fired fired;
  fired.edit.view = view;
  return fired;
}

CommandResult ViewThroughCamera(const State& state, const Answers& answers) {
  const auto photograph = PhotographMeant(state, answers);
  if (!photograph) return Fail(photograph.error());
  if (!model::HasCamera(PhotographOf(**photograph))) return Fail(NoCameraYet(**photograph));
  model::View view = *state.drawing.view;
  view.camera = (*photograph)->id;
  Fired fired;
  fired.edit.view = view;
  return fired;
}

template <bool kOn>
CommandResult SwitchLevel(const State& state, const Answers& answers) {
  std::vector<std::string> levels = answers.words;
  const std::string given = answers.Text("level");
  if (!given.empty()) levels.push_back(given);
  if (levels.empty()) {
    return Fail({.code = Code::kMissingValue, .message = "which level?", .help = "level off roof"});
  }
  std::vector<std::string> hidden;
  if (state.model.hidden_levels) hidden = *state.model.hidden_levels;
  for (const std::string& level : levels) {
    const auto place = std::lower_bound(hidden.begin(), hidden.end(), level);
    const bool is_hidden = place != hidden.end() && *place == level;
    if (kOn && is_hidden) hidden.erase(place);
    if (!kOn && !is_hidden) hidden.insert(place, level);
  }
  Fired fired;
  fired.edit.hidden_levels = std::move(hidden);
  return fired;
}

constexpr Key kLevelKeys[] = {{"level", Type::kLabel, "the level's name"}};

constexpr Example kSetViewExamples[] = {{"set view phong antialias", "true"},
                                        {"set view wireframe phong", "E0412"}};
constexpr Example kViewExamples[] = {{"view top", "true"}, {"view top front", "E0412"}};
constexpr Example kViewCameraExamples[] = {
    {"place slab length=8m width=6m height=5m xy=0,0,0\n"
     "place camera f=35mm format=36mm,24mm size=360,240 phi=20deg omega=8deg xy=9,-14,2 as paper\n"
     "view camera paper; set view hidden; render",
     "true"},
    {"view camera", "E0901"}};
constexpr Example kLevelOffExamples[] = {
    {"place point xy=0,0,0; lv=\"roof\"; place point xy=5,0,0; level off roof; choose all\n"
     "move xy=0,0,0 dl=1",
     "last.bbox.max.x == 1m"},
    {"level off", "E0220"}};
constexpr Example kLevelOnExamples[] = {
    {"lv=\"roof\"; place point xy=0,0,0; level off roof; level on roof; choose all\n"
     "move xy=0,0,0 dl=1",
     "last.bbox.max.x == 1m"},
    {"level on", "E0220"}};

constexpr Command kCommands[] = {
    {.words = "set view",
     .family = "view",
     .summary = "How pictures look: as edges, with hidden lines removed, or shaded; shaded with "
                "orthophotos on the faces; smoothed, with shadows; with photographs behind the "
                "model, where it is seen through their camera, or else as planes at their frames. "
                "What is not named is off; without a mode the one before stays.",
     .options = "wireframe|hidden|phong|textured|evidence|antialias|shadows|sky|photo",
     .examples = kSetViewExamples,
     .execute = SetView},
    {.words = "view",
     .family = "view",
     .summary = "The side from which pictures are taken.",
     .options = kDirections,
     .examples = kViewExamples,
     .execute = TurnView},
    {.words = "view camera",
     .family = "view",
     .summary = "Pictures are taken through a camera, skew included, in its frame and, unless a "
                "size is given, in its pixels. The next `view` ends it.",
     .asks = "camera",
     .examples = kViewCameraExamples,
     .execute = ViewThroughCamera},
    {.words = "level off",
     .family = "view",
     .summary = "Switches levels off: what is on them is neither drawn nor picked.",
     .keys = kLevelKeys,
     .asks = "level",
     .string_key = "level",
     .examples = kLevelOffExamples,
     .execute = SwitchLevel<false>},
    {.words = "level on",
     .family = "view",
     .summary = "Switches levels on again.",
     .keys = kLevelKeys,
     .asks = "level",
     .string_key = "level",
     .examples = kLevelOnExamples,
     .execute = SwitchLevel<true>},
};

}  // namespace

std::span<const Command> ViewCommands() { return kCommands; }

}  // namespace tranos::interp
