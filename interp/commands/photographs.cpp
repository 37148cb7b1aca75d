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
  if (key == "camera") {
    return Fail({.code = Code::kNoPhotograph,
                 .message = "which camera? None was set, and no photograph is attached",
                 .help =
                     "place camera f=35mm format=36mm,24mm size=1200,800 xy=9,-14,1.6 as paper, "
                     "then camera=paper"});
  }
  return Fail({.code = Code::kNoPhotograph,
               .message = "there is no photograph yet",
               .help = "attach photo \"fire_1917.png\" format=40.5mm,26.7mm as fire"});
}

tl::expected<ElementPtr, CommandError> TracedPhotograph(const model::State& state,
                                                        const Answers& answers) {
  auto meant = PhotographMeant(state, answers);
  if (!meant || PhotographOf(**meant).attached || model::IsStatedCamera(PhotographOf(**meant))) {
    return meant;
  }
  const std::string name = NameForMessage(**meant);
  return Fail({.code = Code::kNoPhotograph,
               .message = fmt::format("{} is taken, and not attached yet: nothing would go by what "
                                      "is said of it",
                                      name),
               .help = fmt::format("attach photo {} as NAME",
                                   (*meant)->name ? Printable(*(*meant)->name) : "p"),
               .where = answers.Has("photo") ? AtKey("photo") : Where{}});
}

tl::expected<ElementPtr, CommandError> CameraAt(const model::State& state, const Answers& answers,
                                                std::string_view key) {
  auto found = PhotographAt(state, answers, key);
  if (!found || model::HasCamera(PhotographOf(**found))) return found;
  CommandError error = NoCameraYet(**found);
  if (answers.Has(key)) error.where = AtKey(key);
  return Fail(std::move(error));
}

std::optional<CommandError> NotPng(const Answers& answers, std::string_view what) {
  const std::string file = answers.Text("file");
  if (!answers.Has("file") || (file.size() > 4 && file.ends_with(".png"))) return std::nullopt;
  return CommandError{.code = Code::kUnknownFormat,
                      .message = fmt::format("`{}` names no known format", Printable(file)),
                      .label = fmt::format("{} is written as png", what),
                      .where = AtKey("file")};
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
  if (taken.file.empty()) {
    return Fail({.code = Code::kNoPhotograph,
                 .message = fmt::format("{} cannot be taken: {}", NameForMessage(photograph),
                                        pixels.error().detail)});
  }
  return Fail({.code = Code::kNoPhotograph,
               .message = fmt::format("{} cannot be read to its end: {}",
                                      NameForMessage(photograph), pixels.error().detail),
               .help = "photographs are PNG, JPEG or TIFF"});
}

namespace {

// In pixels, how far outside a dot is to either side. Pixels have their middles at whole numbers.
geom::Vec2 Beyond(const camera::Frame& frame, const geom::Vec2& dot_px) {
  const geom::Vec2 from_corner = dot_px.array() + 0.5;
  return (-from_corner).cwiseMax(from_corner - frame.size_px.cast<double>()).cwiseMax(0);
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
