// SPDX-License-Identifier: GPL-3.0-or-later
// prior: what is assumed of a camera before the data speak.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera/default_priors.h"
#include "interp/arithmetic.h"
#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/commands/photographs.h"

namespace tranos::interp {

using geom::kPi;
using model::State;
using model::Value;

namespace {

// The way a prior on this is stated.
std::string PriorHelp(std::string_view key, std::string_view deviation) {
  const std::string_view value = key == "aspect"      ? "1"
                                 : key == "skew"      ? "90deg"
                                 : key == "principal" ? "centre"
                                                      : "40mm";
  return fmt::format("prior {} = {} +- {}", key, value, deviation);
}

// A prior without a deviation says too little, and one with none at all too much.
std::optional<CommandError> NoDeviation(std::string_view key, const Value& number, double sigma) {
  if (sigma > 0) return std::nullopt;
  if (!number.derivatives()) {
    return CommandError{.code = Code::kOutOfRange,
                        .message = fmt::format("a prior on the {} states how sure it is", key),
                        .help = PriorHelp(key, key == "skew" ? "1deg" : "5%"),
                        .where = AtKey(key)};
  }
  return CommandError{
      .code = Code::kOutOfRange,
      .message = fmt::format("a deviation of zero would leave the {} nothing to be found", key),
      .label = "expected one above zero",
      .help = PriorHelp(key, key == "skew" ? "0.001deg" : "0.01%") + " holds it as good as fixed",
      .where = AtKey(key)};
}

// The principal point: `centre +-` a share of the width and height, or a point with a deviation.
std::optional<CommandError> SetPrincipal(const Value& value, const Surroundings& surroundings,
                                         model::Photograph* photograph) {
  const camera::Frame& frame = photograph->frame;
  camera::Prior* const priors = photograph->priors + camera::kPrincipalX;
  // `centre` is the number 1.
  if (value.is_number() && value.dimension().plain() &&
      std::abs(Stated(value, surroundings.sources) - 1) < 1e-12) {
    const double share = Sigma(value, surroundings.sources);
    if (auto error = NoDeviation("principal", value, share)) return error;
    for (int i = 0; i < 2; ++i) priors[i] = {0, share * frame.size_mm[i]};
    return std::nullopt;
  }
  const auto of = [&](model::Dimension dimension) {
    return value.is_list() && value.list().size() == 2 &&
           std::all_of(value.list().begin(), value.list().end(), [&](const Value& item) {
             return item.is_number() && item.dimension() == dimension;
           });
  };
  if (!of(model::kLength) && !of(model::kPixel)) {
    return CommandError{
        .code = Code::kWrongType,
        .message = "the principal point is `centre`, or a point in mm or px, with a deviation",
        .label = "of the frame: mm from its centre, y down; or a dot",
        .help =
            "prior principal = centre +- 5%; prior principal = [0.4mm, -1mm] +- 0.5mm; "
            "prior principal = [812px, 540px] +- 20px",
        .where = AtKey("principal")};
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const Value& item = value.list()[i];
    const double sigma = Sigma(item, surroundings.sources);
    if (auto error = NoDeviation("principal", item, sigma)) return error;
    priors[i] =
        item.dimension() == model::kPixel
            ? camera::Prior{(item.number() - frame.centre_px()[axis]) * frame.pitch_mm()[axis],
                            sigma * frame.pitch_mm()[axis]}
            : camera::Prior{item.number() * 1e3, sigma * 1e3};
  }
  return std::nullopt;
}

// Sets a prior on the parameter that the key names.
std::optional<CommandError> SetPrior(std::string_view key, const Value& value,
                                     const Surroundings& surroundings,
                                     model::Photograph* photograph) {
  if (key == "principal") return SetPrincipal(value, surroundings, photograph);
  const double sigma = Sigma(value, surroundings.sources);
  if (auto error = NoDeviation(key, value, sigma)) return error;
  const camera::Parameter parameter = key == "aspect" ? camera::kAspect
                                      : key == "skew" ? camera::kSkew
                                                      : camera::kFocal;
  const double unit = parameter == camera::kFocal ? 1e3 : 1;
  const double number = value.number();
  const bool is_possible = parameter == camera::kSkew ? number > kDegree && number < kPi - kDegree
                                                      : number > 0 && std::isfinite(number);
  if (!is_possible) {
    return CommandError{
        .code = Code::kOutOfRange,
        .message = fmt::format("no camera has such a {}", key == "focal" ? "focal length" : key),
        .label = parameter == camera::kSkew ? "the angle between a dot's axes, near 90 degrees"
                                            : "expected a number above zero",
        .where = AtKey(key)};
  }
  photograph->priors[parameter] = {value.number() * unit, sigma * unit};
  return std::nullopt;
}

CommandResult StatePrior(const State& state, const Answers& answers,
                         const Surroundings& surroundings) {
  const auto found = TracedPhotograph(state, answers);
  if (!found) return Fail(found.error());
  model::Photograph changed = PhotographOf(**found);
  if (!changed.attached) {
    return Fail({.code = Code::kWrongElement,
                 .message = fmt::format("{} is stated and not to be found, so that nothing is "
                                        "assumed of it",
                                        NameForMessage(**found)),
                 .help = "`prior photo=NAME …` names a photograph"});
  }
  if (answers.HasWord("default")) {
    const auto standard = camera::DefaultPriors(changed.frame);
    std::copy(standard.begin() + camera::kAspect, standard.end(), changed.priors + camera::kAspect);
  }
  bool says = answers.HasWord("default");
  for (const auto& [key, value] : answers.keys) {
    if (key == "photo") continue;
    if (auto error = SetPrior(key, value, surroundings, &changed)) return Fail(*error);
    says = true;
  }
  if (!says) {
    return Fail({.code = Code::kMissingValue,
                 .message = "what is assumed of the camera?",
                 .help = "prior default; prior aspect = 1 +- 3%"});
  }
  Fired fired;
  fired.edit.replaced.push_back(WithPhotograph(**found, std::move(changed)));
  return fired;
}

constexpr Key kPhotoKey = {"photo", Type::kElement,
                           "the photograph; the one last attached or set without"};
constexpr Key kPriorKeys[] = {
    kPhotoKey,
    {"aspect", Type::kNumber, "f in y by f in x, with its deviation"},
    {"principal", Type::kAny,
     "the principal point: `centre +-` a share of the width and height, or a point of the frame "
     "in mm from its centre, or a dot in px: `[812px, 540px] +- 20px`",
     "centre"},
    {"skew", Type::kAngle, "the angle between the dot's axes, with its deviation"},
    {"focal", Type::kLength, "the focal length, with its deviation"}};

#define TRANOS_PHOTO "attach photo \"facade.png\" as hall\n"
constexpr Example kPriorExamples[] = {
    {TRANOS_PHOTO "prior photo=hall aspect=1 +- 3% principal=centre +- 5%"
                  " skew=90deg +- 1deg focal=40mm +- 10%",
     "true"},
    {TRANOS_PHOTO "prior default", "true"},
    {TRANOS_PHOTO "prior principal=[812px, 540px] +- 20px", "true"},
    {TRANOS_PHOTO "prior skew=90deg +- 0deg", "E0212"},
    {TRANOS_PHOTO "prior aspect=1", "E0212"}};
#undef TRANOS_PHOTO

constexpr Command kCommands[] = {
    {.words = "prior",
     .family = "photograph",
     .summary = "States what is assumed of a camera before the data speak; `prior default` is "
                "aspect = 1 +- 3%, principal = centre +- 5%, skew = 90deg +- 1deg.",
     .keys = kPriorKeys,
     .options = "default",
     .examples = kPriorExamples,
     .execute_with = StatePrior,
     .informs = true},
};

}  // namespace

std::span<const Command> PriorCommands() { return kCommands; }

}  // namespace tranos::interp
