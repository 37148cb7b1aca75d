// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/commands/photographs.h"

#include <fmt/format.h>

#include "interp/commands/firing.h"

namespace tranos::interp {

using model::ElementPtr;

namespace {

bool IsPhotograph(const model::Element& element) {
  return std::holds_alternative<model::PhotographPtr>(element.geometry);
}

tl::expected<ElementPtr, CommandError> PhotographNamed(const model::State& state,
                                                       const std::string& name) {
  ElementPtr named;
  std::vector<std::string> known;
  state.model.ForEach([&](const ElementPtr& element) {
    if (!IsPhotograph(*element)) return;
    known.emplace_back(element->name_or_empty());
    if (element->name_or_empty() == name) named = element;
  });
  if (named) return named;
  const auto meant = DidYouMean(name, known);
  return Fail({.code = Code::kUnknownName,
               .message = fmt::format("no photograph or camera is named `{}`", Printable(name)),
               .help = meant ? "did you mean `" + *meant + "`?"
                             : "`attach photo … as NAME` and `place camera … as NAME` name one"});
}

}  // namespace

tl::expected<ElementPtr, CommandError> PhotographAt(const model::State& state,
                                                    const Answers& answers, std::string_view key) {
  if (const model::Value* given = answers.Find(key)) {
    const ElementPtr current = state.model.Current(given->element()->id);
    if (current && IsPhotograph(*current)) return current;
    return Fail({.code = Code::kWrongElement,
                 .message = fmt::format("`{}=` is a photograph or camera, and this is {}", key,
                                        NameForMessage(*given->element())),
                 .where = AtKey(key)});
  }
  if (ElementPtr active = state.model.Current(state.drawing.photograph)) return active;
  return Fail({.code = Code::kNoPhotograph,
               .message = "there is no photograph yet",
               .help = "attach photo \"fire_1917.png\" format=40.5mm,26.7mm as fire"});
}

tl::expected<ElementPtr, CommandError> PhotographMeant(const model::State& state,
                                                       const Answers& answers) {
  for (const std::string& word : answers.words) {
    if (word != "default" && !answers.Has("photo")) return PhotographNamed(state, word);
  }
  return PhotographAt(state, answers, "photo");
}

const model::Photograph& PhotographOf(const model::Element& element) {
  return *std::get<model::PhotographPtr>(element.geometry);
}

ElementPtr WithPhotograph(const model::Element& element, model::Photograph photograph) {
  return model::WithGeometry(element,
                             std::make_shared<const model::Photograph>(std::move(photograph)));
}

tl::expected<camera::PhotoPtr, CommandError> PixelsOf(const model::Element& photograph) {
  const model::Photograph& taken = PhotographOf(photograph);
  if (model::IsStatedCamera(taken)) {
    return Fail({.code = Code::kNoPhotograph,
                 .message = fmt::format("{} is a stated camera: there is no photograph of it",
                                        NameForMessage(photograph)),
                 .help = "attach photo \"fire_1917.png\" format=40.5mm,26.7mm as fire"});
  }
  if (!taken.picture) {
    return Fail({.code = Code::kCannotRead,
                 .message = fmt::format("the pixels of {} are not at hand: a journal keeps none",
                                        NameForMessage(photograph)),
                 .help = "run the script itself"});
  }
  const auto pixels = taken.picture->Pixels();
  if (pixels) return *pixels;
  return Fail({.code = Code::kNoPhotograph,
               .message = fmt::format("{} cannot be read to its end: {}",
                                      NameForMessage(photograph), pixels.error().detail),
               .help = "photographs are PNG, JPEG or TIFF"});
}

namespace {

// In pixels, how far outside a dot is to either side.
geom::Vec2 Beyond(const camera::Frame& frame, const geom::Vec2& dot_px) {
  return (-dot_px).cwiseMax(dot_px - frame.size_px.cast<double>()).cwiseMax(0);
}

std::string SizeOf(const camera::Frame& frame) {
  return fmt::format("the photograph is {} by {} pixels", frame.size_px.x(), frame.size_px.y());
}

}  // namespace

std::optional<CommandError> OutsidePhotograph(const camera::Frame& frame, const geom::Vec2& dot_px,
                                              Code code) {
  constexpr double kBeyondBorder = 0.25;
  const geom::Vec2 most = kBeyondBorder * frame.size_px.cast<double>();
  if ((Beyond(frame, dot_px).array() <= most.array()).all()) return std::nullopt;
  return CommandError{
      .code = code,
      .message = fmt::format("the dot {:g},{:g} is outside the photograph", dot_px.x(), dot_px.y()),
      .label = SizeOf(frame)};
}

std::optional<CommandError> JustOutsidePhotograph(const camera::Frame& frame,
                                                  const geom::Vec2& dot_px) {
  if (Beyond(frame, dot_px).isZero()) return std::nullopt;
  return CommandError{.code = Code::kDotOutside,
                      .message = fmt::format("the dot {:g},{:g} is outside the photograph, where "
                                             "nothing of it is seen",
                                             dot_px.x(), dot_px.y()),
                      .label = SizeOf(frame)};
}

CommandError NoCameraYet(const model::Element& photograph) {
  return {.code = Code::kNotDetermined,
          .message = fmt::format("{} has no camera, or one that is not determined",
                                 NameForMessage(photograph)),
          .help = "trace edges whose place is known, then `calibrate`"};
}

}  // namespace tranos::interp
