// SPDX-License-Identifier: GPL-3.0-or-later
// render photo: a photograph of the model as a stated camera would have taken it, a century ago.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera/framed_camera.h"
#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/commands/photographs.h"
#include "model/photo_request.h"

namespace tranos::interp {

using model::PhotoRequest;
using model::State;
using model::Value;

namespace {

constexpr double kMostPixels = 50e6;
constexpr double kStrongestDistortion = 0.3;
// Where the sun stands unless that is said: behind the photographer's left shoulder.
constexpr double kSunToTheLeft = 55 * kDegree, kSunHeight = 42 * kDegree;

struct Effect {
  std::string_view key;
  double model::PrintEffects::*strength;
  std::string_view summary;
};
constexpr Effect kEffects[] = {
    {"grain", &model::PrintEffects::grain, "of the emulsion, from 0 to 1; likewise the next ones"},
    {"vignette", &model::PrintEffects::vignette, "how much darker it is towards the corners"},
    {"fade", &model::PrintEffects::fade, "of the print"},
    {"dust", &model::PrintEffects::dust, "specks and hairs"},
    {"scratches", &model::PrintEffects::scratches, "of the plate"},
    {"stains", &model::PrintEffects::stains, "of damp, and foxing"},
    {"paper", &model::PrintEffects::paper, "how much of its fibres is seen"},
    {"scan", &model::PrintEffects::scan, "noise of the scanner"},
};

tl::expected<model::PrintEffects, CommandError> EffectsOf(const Answers& answers) {
  model::PrintEffects effects;
  for (const Effect& effect : kEffects) {
    const double strength = answers.Number(effect.key);
    if (!(strength >= 0 && strength <= 1)) {
      return Fail(
          {.code = Code::kOutOfRange,
           .message = fmt::format("`{}` is from 0, none, to 1, as strong as on a badly kept "
                                  "print",
                                  effect.key),
           .help = fmt::format("{}=0.5", effect.key),
           .where = AtKey(effect.key)});
    }
    effects.*effect.strength = strength;
  }
  return effects;
}

// Whether every dot of the frame is of one direction: a lens that folds does so first at the place
// that is farthest from its centre, which is a corner. Samples reach a little over the border.
bool IsWithinLens(const camera::Distortion& distortion, const camera::Frame& frame) {
  constexpr double kOver_px = 4;
  const geom::Vec2 size = frame.size_px.cast<double>().array() + 2 * kOver_px;
  for (const geom::Vec2& corner :
       {geom::Vec2(0, 0), geom::Vec2(1, 0), geom::Vec2(0, 1), geom::Vec2(1, 1)}) {
    const geom::Vec2 dot_px = corner.cwiseProduct(size).array() - 0.5 - kOver_px;
    if (!camera::UndistortDot(distortion, frame, dot_px)) return false;
  }
  return true;
}

// k1, or k1 and k2, about the principal point in units of half the frame's diagonal.
tl::expected<camera::Distortion, CommandError> DistortionOf(const Answers& answers,
                                                            const PhotoRequest& request) {
  camera::Distortion distortion;
  distortion.centre_mm = request.camera.parameters.segment<2>(camera::kPrincipalX);
  distortion.unit_mm = geom::Vec2::Constant(request.frame.size_mm.norm() / 2);
  const Value* given = answers.Find("distortion");
  if (!given) return distortion;
  const std::size_t count = given->is_list() ? given->list().size() : 1;
  const auto number = [&](std::size_t i) {
    return given->is_list() ? given->list()[i].number() : given->number();
  };
  double* const terms[] = {&distortion.k1, &distortion.k2};
  for (std::size_t i = 0; i < std::min<std::size_t>(count, 2); ++i) *terms[i] = number(i);
  const double strongest = std::max(std::abs(distortion.k1), std::abs(distortion.k2));
  if (count >= 1 && count <= 2 && strongest <= kStrongestDistortion) {
    if (IsWithinLens(distortion, request.frame)) return distortion;
    return Fail({.code = Code::kOutOfRange,
                 .message = "this distortion would fold the picture over in a corner of the frame",
                 .label = "it moves nearer to the centre what is farther from it",
                 .help = "a weaker one, or a second term against the first: distortion=-0.3,0.1",
                 .where = AtKey("distortion")});
  }
  return Fail(
      {.code = Code::kOutOfRange,
       .message = fmt::format("the distortion is k1, or k1 and k2: the shares, up to {}, by "
                              "which it moves a corner of the frame",
                              kStrongestDistortion),
       .help = "distortion=-0.02",
       .where = AtKey("distortion")});
}

// Towards the sun: azimuth from X towards Y, and height.
geom::Vec3 Direction(double azimuth_rad, double height_rad) {
  return {std::cos(height_rad) * std::cos(azimuth_rad),
          std::cos(height_rad) * std::sin(azimuth_rad), std::sin(height_rad)};
}

tl::expected<geom::Vec3, CommandError> SunOf(const Answers& answers, const camera::Camera& camera) {
  const Value* given = answers.Find("sun");
  if (!given) {
    // The camera looks along Y, turned left by φ.
    const double behind = camera[camera::kPhi] - geom::kPi / 2;
    return Direction(behind - kSunToTheLeft, kSunHeight);
  }
  if (given->is_list() && given->list().size() == 2) {
    const double azimuth = given->list()[0].number(), height = given->list()[1].number();
    if (height > 0 && height <= geom::kPi / 2 && std::abs(azimuth) <= 4 * geom::kPi) {
      return Direction(azimuth, height);
    }
  }
  return Fail({.code = Code::kOutOfRange,
               .message = "the sun is its azimuth, from X towards Y, and its height above the "
                          "horizon",
               .help = "sun=-110deg,40deg",
               .where = AtKey("sun")});
}

std::optional<CommandError> SetSize(const Answers& answers, PhotoRequest& request) {
  if (const Value* size = answers.Find("size")) {
    const double width = size->list()[0].number(), height = size->list()[1].number();
    if (!(width >= 1 && height >= 1 && width * height <= kMostPixels)) {
      return CommandError{
          .code = Code::kOutOfRange,
          .message = fmt::format("a photograph has 1 to {:.0f} million pixels", kMostPixels / 1e6),
          .help = "size=6000,4000",
          .where = AtKey("size")};
    }
    request.frame.size_px = {static_cast<int>(width), static_cast<int>(height)};
    return std::nullopt;
  }
  if (request.frame.size_px.cast<double>().prod() <= kMostPixels) return std::nullopt;
  return CommandError{
      .code = Code::kOutOfRange,
      .message =
          fmt::format("the camera's frame has more than {:.0f} million pixels", kMostPixels / 1e6),
      .help = "a smaller `size=`"};
}

tl::expected<PhotoRequest, CommandError> RequestOf(const State& state, const Answers& answers) {
  const auto taken = CameraAt(state, answers, "camera");
  if (!taken) return Fail(taken.error());
  const model::Photograph& photograph = PhotographOf(**taken);
  PhotoRequest request{.model = model::Apart(state.model),
                       .taken = *taken,
                       .camera = photograph.estimate->camera,
                       .frame = photograph.frame,
                       .distortion = {},
                       .effects = {}};
  if (auto error = SetSize(answers, request)) return Fail(*error);
  const auto distortion = DistortionOf(answers, request);
  if (!distortion) return Fail(distortion.error());
  request.distortion = *distortion;
  const auto effects = EffectsOf(answers);
  if (!effects) return Fail(effects.error());
  request.effects = *effects;
  const auto towards_sun = SunOf(answers, request.camera);
  if (!towards_sun) return Fail(towards_sun.error());
  request.towards_sun = *towards_sun;
  if (answers.Text("tone", "sepia") == "grey") request.tone = model::PrintTone::kGrey;
  request.seed = static_cast<std::uint64_t>(answers.Number("seed", 1));
  return request;
}

// What taking it costs, in steps of a run: the ground and the light at least, and its pixels.
std::uint64_t StepsOf(const PhotoRequest& request) {
  constexpr std::uint64_t kLeast = 20'000, kPixelsAStep = 8;
  return kLeast +
         static_cast<std::uint64_t>(request.frame.size_px.cast<double>().prod()) / kPixelsAStep;
}

// The photograph, which is taken once its pixels are asked for, and once in a run: what stands
// before `calibrate` is run again and again.
PhotographFile Taken(const std::shared_ptr<const PhotoRequest>& request,
                     const Surroundings& surroundings) {
  const model::Hash128 hash = model::HashOf(*request);
  const auto [known, is_new] = surroundings.photographs.taken.try_emplace(hash);
  if (!is_new) return known->second;
  surroundings.charge(StepsOf(*request));
  known->second = {hash, request->frame.size_px};
  if (!surroundings.host.render_photo) return known->second;  // a replay
  const auto take = [request,
                     render = surroundings.host.render_photo]() -> geom::Result<camera::PhotoPtr> {
    auto pixels = render(*request);
    if (pixels) return *std::move(pixels);
    return tl::unexpected(geom::Error{geom::ErrorCode::kTooLarge, pixels.error()});
  };
  known->second.picture = std::make_shared<const camera::PhotoFile>(take);
  return known->second;
}

CommandResult RenderPhoto(const State& state, const Answers& answers,
                          const Surroundings& surroundings) {
  if (auto error = NotPng(answers, "a photograph")) return Fail(*std::move(error));
  const auto request = RequestOf(state, answers);
  if (!request) return Fail(request.error());
  const auto shared = std::make_shared<const PhotoRequest>(*request);
  const PhotographFile taken = Taken(shared, surroundings);
  model::Photograph photograph{.file = "", .content = taken.content, .picture = taken.picture};
  photograph.format_is_stated = false;
  photograph.frame = camera::FrameOfPixels(taken.size_px);
  Fired fired = *Make(state, std::make_shared<const model::Photograph>(std::move(photograph)));
  if (answers.Has("file") && taken.picture) {
    fired.edit.outputs.emplace_back(
        model::PhotoFileRequest{shared, taken.picture, answers.Text("file")});
  }
  return fired;
}

constexpr Key kOtherKeys[] = {
    {"camera", Type::kElement, "the camera; the one last set without"},
    {"size", Type::kSize, "width and height in pixels", {}, "the camera's"},
    {"seed", Type::kCount, "of all that is left to chance", {}, "1"},
    {"tone", Type::kWord, "of the print", "sepia|grey", "sepia"},
    {"sun",
     Type::kAngle,
     "its azimuth from X towards Y, and its height; from behind the camera's left "
     "without",
     {},
     {},
     -1,
     false,
     true},
    {"distortion",
     Type::kNumber,
     "of the lens: k1, or k1 and k2, for half the frame's diagonal",
     {},
     "0",
     -1,
     false,
     true},
    {"file", Type::kString, "a png to write it to; beside it, as json, what is true of it"}};
constexpr auto PhotoKeys() {
  std::array<Key, std::size(kOtherKeys) + std::size(kEffects)> keys{};
  std::copy(std::begin(kOtherKeys), std::end(kOtherKeys), keys.begin());
  for (std::size_t i = 0; i < std::size(kEffects); ++i) {
    keys[std::size(kOtherKeys) + i] = {
        kEffects[i].key, Type::kNumber, kEffects[i].summary, {}, "0"};
  }
  return keys;
}
constexpr auto kPhotoKeys = PhotoKeys();

#define TRANOS_SCENE                                                                  \
  "mt=\"brick\"; place slab length=8m width=6m height=5m xy=0,0,0\n"                  \
  "place camera f=35mm format=36mm,24mm size=360,240 phi=20deg omega=8deg xy=9,-14,2" \
  " as paper\n"
constexpr Example kPhotoExamples[] = {
    {TRANOS_SCENE
     "render photo camera=paper grain=0.4 vignette=0.5 fade=0.3 dust=0.3 scratches=0.3 "
     "stains=0.3 paper=0.5 scan=0.1 seed=7 as p",
     "p.width == 360px"},
    {TRANOS_SCENE "render photo camera=paper size=720,480 sun=-110deg,35deg distortion=-0.02 "
                  "tone=grey file=\"p.png\" as p",
     "p.height == 480px"},
    {TRANOS_SCENE "render photo camera=paper grain=3", "E0212"},
    {"render photo seed=1", "E0901"}};
#undef TRANOS_SCENE

constexpr Command kCommands[] = {
    {.words = "render photo",
     .family = "photograph",
     .summary =
         "Takes a photograph of the model through a stated camera, as an old print shows it: "
         "a photograph that can be attached.",
     .keys = kPhotoKeys,
     .string_key = "file",
     .examples = kPhotoExamples,
     .execute_with = RenderPhoto},
};

}  // namespace

std::span<const Command> RenderPhotoCommands() { return kCommands; }

}  // namespace tranos::interp
