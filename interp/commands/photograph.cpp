// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs and cameras: attach, stated cameras, and what is known of one.
#include <fmt/format.h>

#include <cmath>
#include <span>

#include "camera/camera_file.h"
#include "camera/fspy.h"
#include "camera/photo.h"
#include "interp/camera_report.h"
#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/commands/photographs.h"
#include "interp/traced.h"

namespace tranos::interp {

using geom::kPi;
using model::State;
using model::Value;

namespace {

// Two numbers above zero; nothing if they are something else.
std::optional<geom::Vec2> PairOf(const Value& value, double unit) {
  if (!value.is_list() || value.list().size() != 2) return std::nullopt;
  const geom::Vec2 pair(value.list()[0].number() / unit, value.list()[1].number() / unit);
  return pair;
}

tl::expected<geom::Vec2, CommandError> FormatOf(const Value& given) {
  const auto size_mm = PairOf(given, 1e-3);
  if (size_mm && size_mm->minCoeff() > 0 && size_mm->maxCoeff() < 1e7) return *size_mm;
  return Fail({.code = Code::kOutOfRange,
               .message = "the format is the width and the height of the negative or sensor",
               .help = "format=40.5mm,26.7mm",
               .where = AtKey("format")});
}

tl::expected<std::string, CommandError> Read(const std::string& file, std::string_view key,
                                             const Surroundings& surroundings) {
  if (!surroundings.host.read) {
    return Fail({.code = Code::kCannotRead, .message = "there are no files to be read here"});
  }
  auto bytes = surroundings.host.read(file);
  if (!bytes) {
    const bool outside = bytes.error().kind == HostError::kOutside;
    return Fail({.code = outside ? Code::kOutsideSandbox : Code::kCannotRead,
                 .message = fmt::format("`{}`: {}", Printable(file), bytes.error().detail),
                 .where = AtKey(key)});
  }
  return *std::move(bytes);
}

std::span<const std::byte> BytesOf(std::string_view text) { return std::as_bytes(std::span(text)); }

tl::unexpected<CommandError> NoPhotographIn(const std::string& file, const geom::Error& error) {
  return Fail({.code = Code::kNoPhotograph,
               .message = fmt::format("`{}` is no photograph that can be read: {}", Printable(file),
                                      error.detail),
               .help = "photographs are PNG, JPEG or TIFF, or in a project of fSpy",
               .where = AtKey("file")});
}

tl::unexpected<CommandError> NoCameraIn(const std::string& file, std::string_view why,
                                        std::string_view key) {
  return Fail(
      {.code = Code::kBadCamera,
       .message = fmt::format("`{}` holds no camera that can be read: {}", Printable(file), why),
       .label = "cameras are read from fSpy's projects, from the JSON that it exports, and "
                "from what `export exact` wrote",
       .where = AtKey(key)});
}

// As a journal keeps its numbers, so that a replay, which has nothing else, finds the same camera.
camera::FramedCamera AsJournalsKeepIt(camera::FramedCamera framed) {
  const auto on_grid = [](double number) { return std::round(number * 0x1p40) / 0x1p40; };
  framed.frame.size_mm = framed.frame.size_mm.unaryExpr(on_grid);
  framed.camera.parameters = framed.camera.parameters.unaryExpr(on_grid);
  return framed;
}

// The photograph in it, and the camera if it is a project that holds one; a file is read once in a
// run.
tl::expected<PhotographFile, CommandError> ReadPhotograph(const std::string& file,
                                                          const Surroundings& surroundings) {
  PhotographFile& known = surroundings.photographs.by_path[file];
  if (known.size_px.x() > 0) return known;
  auto bytes = Read(file, "file", surroundings);
  if (!bytes) return Fail(bytes.error());
  PhotographFile read{.content = model::Hasher().Text(*bytes).Finish()};
  if (camera::IsFspyProject(BytesOf(*bytes))) {
    const auto project = camera::FspyProjectIn(BytesOf(*bytes));
    if (!project) return NoPhotographIn(file, project.error());
    const auto camera = camera::CameraInFspy(project->settings);
    if (!camera) return NoCameraIn(file, camera.error().detail, "file");
    if (*camera) read.camera = AsJournalsKeepIt(**camera);
    *bytes = std::string(reinterpret_cast<const char*>(project->picture.data()),
                         project->picture.size());
  }
  const auto size = camera::PhotoSizeOf(BytesOf(*bytes));
  if (!size) return NoPhotographIn(file, size.error());
  read.size_px = {size->width_px, size->height_px};
  read.picture = std::make_shared<const camera::PhotoFile>(*std::move(bytes));
  return known = std::move(read);
}

// The camera in a file that `camera=` names.
tl::expected<camera::FramedCamera, CommandError> ReadCamera(const std::string& file,
                                                            const Surroundings& surroundings) {
  PhotographFile& known = surroundings.photographs.by_path[file];
  if (known.camera) return *known.camera;
  const auto bytes = Read(file, "camera", surroundings);
  if (!bytes) return Fail(bytes.error());
  const auto read = camera::CameraInFile(BytesOf(*bytes));
  if (!read) return NoCameraIn(file, read.error().detail, "camera");
  if (!*read) return NoCameraIn(file, "the project was saved without a solution", "camera");
  return *(known.camera = AsJournalsKeepIt(**read));
}

// What no camera can be.
std::optional<CommandError> NoCamera(const camera::Camera& c) {
  const auto refuse = [](std::string message, std::string_view key) {
    return CommandError{
        .code = Code::kOutOfRange, .message = std::move(message), .where = AtKey(key)};
  };
  if (!(c[camera::kFocal] > 0 && c[camera::kFocal] < 1e7)) {
    return refuse("a focal length is above zero, and below 10 km", "f");
  }
  if (!(c[camera::kAspect] > 1e-3 && c[camera::kAspect] < 1e3)) {
    return refuse("an aspect ratio is near 1", "aspect");
  }
  if (!(c[camera::kSkew] > kDegree && c[camera::kSkew] < kPi - kDegree)) {
    return refuse("the angle between a dot's axes is near 90 degrees", "skew");
  }
  for (const camera::Parameter angle : {camera::kOmega, camera::kPhi, camera::kKappa}) {
    if (!(std::abs(c[angle]) <= 1e3 * kPi)) return refuse("the angle is too large", "omega");
  }
  if (!(c.position_m().norm() < kFarthest_m) ||
      !(c.parameters.segment<2>(camera::kPrincipalX).norm() < 1e7)) {
    return refuse("the camera would be out of reach", "x");
  }
  return std::nullopt;
}

// Gives the photograph the camera in the file, on the frame that was stated or else on the
// camera's.
std::optional<CommandError> TakeCamera(const camera::FramedCamera& given, const std::string& file,
                                       std::string_view key, model::Photograph* photograph) {
  camera::Frame& frame = photograph->frame;
  if (given.frame.size_px != frame.size_px) {
    return CommandError{
        .code = Code::kBadCamera,
        .message = fmt::format("the camera in `{}` is of a photograph of {} × {} pixels, and this "
                               "one has {} × {}",
                               Printable(file), given.frame.size_px.x(), given.frame.size_px.y(),
                               frame.size_px.x(), frame.size_px.y()),
        .help = "attach the photograph that the camera was found for",
        .where = AtKey(key)};
  }
  if (!photograph->format_is_stated) frame.size_mm = given.frame.size_mm;
  const auto framed = camera::FramedCameraOf(frame, camera::DotFromCamera(given),
                                             camera::CameraFromWorld(given.camera.parameters),
                                             given.camera.position_m());
  if (!framed) return NoCameraIn(file, framed.error().detail, key).value();
  camera::Estimate estimate;
  estimate.camera = AsJournalsKeepIt(*framed).camera;
  if (const auto error = NoCamera(estimate.camera))
    return NoCameraIn(file, error->message, key).value();
  photograph->estimate = std::make_shared<const camera::Estimate>(std::move(estimate));
  photograph->camera_file = file;
  return std::nullopt;
}

// The picture that is attached: in a file, or one made by `render photo`.
tl::expected<PhotographFile, CommandError> PictureMeant(const State& state, const Answers& answers,
                                                        const Surroundings& surroundings) {
  const std::string file = answers.Text("file");
  if (!file.empty() && answers.words.empty()) return ReadPhotograph(file, surroundings);
  if (file.empty() == answers.words.empty()) {
    return Fail({.code = Code::kMissingValue,
                 .message = "which photograph: a file, or one made by `render photo`?",
                 .help = "attach photo \"fire_1917.png\" as fire"});
  }
  const auto made = PhotographMeant(state, answers);
  if (!made) return Fail(made.error());
  const model::Photograph& photograph = PhotographOf(**made);
  if (!model::IsStatedCamera(photograph)) {
    return PhotographFile{photograph.content, photograph.frame.size_px, photograph.picture};
  }
  return Fail({.code = Code::kNoPhotograph,
               .message = fmt::format("{} is a stated camera: there is no photograph of it",
                                      NameForMessage(**made)),
               .help = "`render photo camera=… as p` takes one"});
}

// Where one side is the longer of the picture and the other that of the format, and turned they
// would agree better.
std::optional<CommandError> FormatAcross(const camera::Frame& frame) {
  const double picture = std::log(static_cast<double>(frame.size_px.x()) / frame.size_px.y());
  const double format = std::log(frame.size_mm.x() / frame.size_mm.y());
  if (picture * format >= 0 || std::abs(picture - format) < std::log(1.2)) return std::nullopt;
  return CommandError{
      .code = Code::kFormatAcross,
      .message = fmt::format("the photograph is {} by {} pixels, and its format lies across that",
                             frame.size_px.x(), frame.size_px.y()),
      .help = fmt::format("the width comes first: format={:g}mm,{:g}mm", frame.size_mm.y(),
                          frame.size_mm.x()),
      .where = {Where::kKey, 0, "format"}};
}

CommandResult AttachPhoto(const State& state, const Answers& answers,
                          const Surroundings& surroundings) {
  const std::string file = answers.Text("file");
  const auto read = PictureMeant(state, answers, surroundings);
  if (!read) return Fail(read.error());
  model::Photograph photograph{
      .file = file, .content = read->content, .picture = read->picture, .attached = true};
  photograph.frame.size_px = read->size_px;
  if (const Value* format = answers.Find("format")) {
    const auto size_mm = FormatOf(*format);
    if (!size_mm) return Fail(size_mm.error());
    photograph.frame.size_mm = *size_mm;
  } else {
    photograph.format_is_stated = false;
    photograph.frame = camera::FrameOfPixels(photograph.frame.size_px);
  }
  if (answers.Has("camera")) {
    const auto given = ReadCamera(answers.Text("camera"), surroundings);
    if (!given) return Fail(given.error());
    if (auto error = TakeCamera(*given, answers.Text("camera"), "camera", &photograph)) {
      return Fail(*error);
    }
  } else if (read->camera) {
    if (auto error = TakeCamera(*read->camera, file, "file", &photograph)) return Fail(*error);
  }
  const auto across = FormatAcross(photograph.frame);
  Fired fired = *Make(state, std::make_shared<const model::Photograph>(std::move(photograph)));
  fired.edit.photograph = model::kAddedBase;
  if (across) fired.warnings.push_back(*across);
  return fired;
}

CommandResult PlaceCamera(const State& state, const Answers& answers) {
  model::Photograph photograph;
  const auto size_mm = FormatOf(*answers.Find("format"));
  if (!size_mm) return Fail(size_mm.error());
  const Value& size = *answers.Find("size");
  photograph.frame = {
      *size_mm,
      {static_cast<int>(size.list()[0].number()), static_cast<int>(size.list()[1].number())}};
  camera::Estimate stated;
  camera::Camera& c = stated.camera;
  c[camera::kFocal] = answers.Number("f") * 1e3;
  c[camera::kAspect] = answers.Number("aspect", 1);
  c[camera::kSkew] = answers.Number("skew", kPi / 2);
  c[camera::kOmega] = answers.Number("omega");
  c[camera::kPhi] = answers.Number("phi");
  c[camera::kKappa] = answers.Number("kappa");
  if (auto error = NoCamera(c)) return Fail(*error);
  if (const Value* principal = answers.Find("principal")) {
    const auto mm = PairOf(*principal, 1e-3);
    if (!mm) {
      return Fail({.code = Code::kWrongCount,
                   .message = "the principal point is two lengths, from the frame's centre",
                   .help = "principal=0mm,0mm",
                   .where = AtKey("principal")});
    }
    c.parameters.segment<2>(camera::kPrincipalX) = *mm;
  }
  if (auto error = TooFar(answers)) return Fail(*error);
  c.parameters.tail<3>() = answers.points[0];
  photograph.estimate = std::make_shared<const camera::Estimate>(std::move(stated));
  return Make(state, std::make_shared<const model::Photograph>(std::move(photograph)));
}

CommandResult SetCamera(const State& state, const Answers& answers) {
  const auto found = PhotographMeant(state, answers);
  if (!found) return Fail(found.error());
  const model::Photograph& photograph = PhotographOf(**found);
  if (photograph.estimate && !photograph.estimate->complete()) {
    return Fail(
        {.code = Code::kNotDetermined,
         .message = fmt::format("the camera of {} is not determined", NameForMessage(**found)),
         .label = photograph.estimate->undetermined.empty()
                      ? ""
                      : photograph.estimate->undetermined.front()});
  }
  Fired fired;
  fired.edit.photograph = (*found)->id;
  return fired;
}

CommandResult ReportCamera(const State& state, const Answers& answers, const Surroundings&) {
  const auto found = PhotographMeant(state, answers);
  if (!found) return Fail(found.error());
  const model::Photograph& photograph = PhotographOf(**found);
  if (!photograph.estimate) return Fail(NoCameraYet(**found));
  Fired fired;
  fired.messages = CameraReport(**found, photograph);
  return fired;
}

// What moves, in the unit of its parameter, for one unit of the language.
struct Movable {
  std::string_view key;
  Type type;
  camera::Parameter parameter;
  double factor;
};
constexpr Movable kMovable[] = {{"f", Type::kLength, camera::kFocal, 1e3},
                                {"aspect", Type::kNumber, camera::kAspect, 1},
                                {"u", Type::kLength, camera::kPrincipalX, 1e3},
                                {"v", Type::kLength, camera::kPrincipalY, 1e3},
                                {"skew", Type::kAngle, camera::kSkew, 1},
                                {"omega", Type::kAngle, camera::kOmega, 1},
                                {"phi", Type::kAngle, camera::kPhi, 1},
                                {"kappa", Type::kAngle, camera::kKappa, 1},
                                {"x", Type::kLength, camera::kX0, 1},
                                {"y", Type::kLength, camera::kY0, 1},
                                {"z", Type::kLength, camera::kZ0, 1}};

CommandResult StepCamera(const State& state, const Answers& answers) {
  const auto found = PhotographMeant(state, answers);
  if (!found) return Fail(found.error());
  model::Photograph changed = PhotographOf(**found);
  if (!model::HasCamera(changed)) return Fail(NoCameraYet(**found));
  auto estimate = std::make_shared<camera::Estimate>();
  const camera::Camera before = changed.estimate->camera;
  estimate->camera = before;
  bool moved = false;
  for (const Movable& row : kMovable) {
    if (!answers.Has(row.key)) continue;
    estimate->camera[row.parameter] += answers.Number(row.key) * row.factor;
    moved = true;
  }
  if (!moved) {
    return Fail({.code = Code::kMissingValue,
                 .message = "which parameter is to be moved, and how far?",
                 .help = "step camera paper omega=0.1deg"});
  }
  if (auto error = NoCamera(estimate->camera)) return Fail(*error);
  Fired fired;
  const auto penalty = PenaltyOf(state, **found, before);
  const auto after = PenaltyOf(state, **found, estimate->camera);
  fired.messages.push_back(
      penalty && after ? fmt::format("penalty {:.4f}, was {:.4f}", *after, *penalty)
                       : "no penalty: no edge with a place in space is traced before this camera");
  changed.estimate = std::move(estimate);
  fired.edit.replaced.push_back(WithPhotograph(**found, std::move(changed)));
  return fired;
}

constexpr Key kPhotoKey = {"photo", Type::kElement,
                           "the photograph; the one last attached or set without"};
constexpr Key kAttachKeys[] = {
    {"file", Type::kString,
     "the photograph: PNG, JPEG or TIFF, or a project of fSpy; or the name of one that was made"},
    {"camera", Type::kString,
     "a file with its camera: the JSON that fSpy exports, a project, or what `export exact` wrote; "
     "that of the project without"},
    {"format",
     Type::kLength,
     "width and height of the negative or sensor; 36 mm along the longer "
     "side without",
     {},
     "",
     -1,
     false,
     true}};
constexpr Prompt kCameraPrompts[] = {{"position"}};
constexpr Key kCameraKeys[] = {
    {"f", Type::kLength, "focal length", {}, {}, -1, true},
    {"format", Type::kLength, "width and height of the frame", {}, {}, -1, true, true},
    {"size", Type::kSize, "width and height in pixels", {}, {}, -1, true},
    {"aspect", Type::kNumber, "f in y by f in x", {}, "1"},
    {"skew", Type::kAngle, "the angle between the dot's axes", {}, "90deg"},
    {"principal",
     Type::kLength,
     "the principal point from the frame's centre, y down",
     {},
     "0mm,0mm",
     -1,
     false,
     true},
    {"omega", Type::kAngle, "tilt, up", {}, "0deg"},
    {"phi", Type::kAngle, "pan, to the left", {}, "0deg"},
    {"kappa", Type::kAngle, "swing", {}, "0deg"}};
constexpr Key kPhotoKeys[] = {kPhotoKey};
constexpr auto StepKeys() {
  std::array<Key, std::size(kMovable) + 1> keys{};
  keys[0] = kPhotoKey;
  for (std::size_t i = 0; i < std::size(kMovable); ++i) {
    keys[i + 1] = {kMovable[i].key, kMovable[i].type, "how far it moves"};
  }
  return keys;
}
constexpr auto kStepKeys = StepKeys();

#define TRANOS_CAMERA                                                          \
  "place camera f=35mm format=36mm,24mm size=1600,1067 aspect=1.01 skew=89deg" \
  " principal=0mm,1mm phi=30deg omega=20deg kappa=1deg xy=10,-30,2 as paper\n"
#define TRANOS_PHOTO "attach photo \"facade.png\" as hall\n"

constexpr Example kAttachExamples[] = {
    {"attach photo \"facade.png\" format=36mm,24mm as hall", "hall.width == 1600px"},
    {"attach photo \"facade.png\" camera=\"facade.camera.json\" as hall",
     "hall.skew within 89deg +- 1e-9deg"},
    {"attach photo \"facade.png\" camera=\"facade.png\"", "E0911"},
    {"attach photo \"facade.txt\"", "E0701"},
    {"place block xy=0,0,0 dl=8,6\n" TRANOS_CAMERA
     "render photo camera=paper seed=1 as p; attach photo p format=36mm,24mm as fire",
     "fire.width == 1600px"},
    {TRANOS_CAMERA "attach photo paper", "E0901"}};
constexpr Example kPlaceCameraExamples[] = {
    {TRANOS_CAMERA, "paper.focal == 35mm"},
    {"place camera f=0mm format=36mm,24mm size=1600,1067 xy=0,0,0", "E0212"}};
constexpr Example kSetCameraExamples[] = {{TRANOS_CAMERA "set camera paper", "true"},
                                          {TRANOS_CAMERA "set camera photo=paper", "true"},
                                          {"set camera hall", "E0201"}};
constexpr Example kReportExamples[] = {{TRANOS_CAMERA "report camera paper", "true"},
                                       {TRANOS_CAMERA "report camera photo=paper", "true"},
                                       {TRANOS_PHOTO "report camera hall", "E0902"}};
constexpr Example kStepExamples[] = {
    {TRANOS_CAMERA "step camera paper omega=0.5deg phi=0deg kappa=0deg", "paper.omega == 20.5deg"},
    {TRANOS_CAMERA "step camera photo=paper f=1mm aspect=0.01 u=0mm v=0mm skew=1deg x=1 y=1 z=1",
     "paper.focal within 36mm +- 1e-9mm"},
    {TRANOS_CAMERA "step camera paper", "E0220"}};

#undef TRANOS_PHOTO
#undef TRANOS_CAMERA

constexpr Command kCommands[] = {
    {.words = "attach photo",
     .family = "photograph",
     .summary = "Brings in a photograph, from a file or made by `render photo`, with the format of "
                "its negative or sensor, and the camera that another program found.",
     .keys = kAttachKeys,
     .asks = "photograph",
     .string_key = "file",
     .examples = kAttachExamples,
     .execute_with = AttachPhoto},
    {.words = "place camera",
     .family = "photograph",
     .summary = "A camera whose parameters are stated.",
     .manner = Manner::kPlaces,
     .prompts = kCameraPrompts,
     .keys = kCameraKeys,
     .examples = kPlaceCameraExamples,
     .execute = PlaceCamera},
    {.words = "set camera",
     .family = "set",
     .summary = "Makes a photograph or camera the one that traces and dots belong to.",
     .keys = kPhotoKeys,
     .asks = "camera",
     .examples = kSetCameraExamples,
     .execute = SetCamera},
    {.words = "report camera",
     .family = "photograph",
     .summary = "Prints a camera's parameters, pose, residuals, deviations and warnings.",
     .keys = kPhotoKeys,
     .asks = "camera",
     .examples = kReportExamples,
     .execute_with = ReportCamera},
    {.words = "step camera",
     .family = "photograph",
     .summary =
         "Moves parameters of a camera by a step and reports the penalty: the sum of squares "
         "of what lies between projected edges and traced lines, in deviations.",
     .keys = kStepKeys,
     .asks = "camera",
     .examples = kStepExamples,
     .execute = StepCamera},
};

}  // namespace

std::span<const Command> PhotographCommands() { return kCommands; }

}  // namespace tranos::interp
