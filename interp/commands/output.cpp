// SPDX-License-Identifier: GPL-3.0-or-later
// render, export, print: what leaves the program.
#include <fmt/format.h>

#include <algorithm>

#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/commands/photographs.h"

namespace tranos::interp {

using model::ElementPtr;
using model::State;

namespace {

constexpr int kWidestPicture_px = 16384;

std::string Extension(std::string_view file) {
  const std::size_t dot = file.rfind('.'), slash = file.rfind('/');
  if (dot == std::string_view::npos || (slash != std::string_view::npos && slash > dot)) return "";
  std::string extension(file.substr(dot + 1));
  std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return extension;
}

CommandError UnknownFormat(std::string_view file, std::string_view known) {
  return {.code = Code::kUnknownFormat,
          .message = fmt::format("`{}` names no known format", Printable(file)),
          .label = fmt::format("the extension chooses the format: {}", known),
          .where = {Where::kKey, 0, "file"}};
}

// Width and height as given; nothing if they are no size of a picture.
std::optional<std::pair<int, int>> SizeOf(const model::Value& value) {
  if (!value.is_list() || value.list().size() != 2) return std::nullopt;
  int size_px[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const model::Value& item = value.list()[i];
    if (!item.is_number() || !(item.number() >= 1 && item.number() <= kWidestPicture_px)) {
      return std::nullopt;
    }
    size_px[i] = static_cast<int>(item.number());
  }
  return std::pair(size_px[0], size_px[1]);
}

CommandResult Render(const State& state, const Answers& answers) {
  model::RenderRequest request{state.model, *state.drawing.view, answers.Text("file")};
  if (request.view.camera != model::kNoElement && !model::CameraOf(request.view, request.model)) {
    const ElementPtr gone = state.model.Current(request.view.camera);
    if (gone) return Fail(NoCameraYet(*gone));
    return Fail({.code = Code::kNoLongerThere,
                 .message = "the camera that the view is through was deleted",
                 .help = "`view camera` with another, or `view iso`"});
  }
  if (!request.file.empty() && Extension(request.file) != "png") {
    return Fail(UnknownFormat(request.file, "png"));
  }
  if (const model::Value* given = answers.Find("size")) {
    const auto size_px = SizeOf(*given);
    if (!size_px) {
      return Fail(
          {.code = Code::kOutOfRange,
           .message = fmt::format("a picture is 1 to {} pixels wide and high", kWidestPicture_px),
           .help = "render size=1280,960",
           .where = {Where::kKey, 0, "size"}});
    }
    std::tie(request.width_px, request.height_px) = *size_px;
  } else if (const auto through = model::CameraOf(request.view, request.model)) {
    const Eigen::Vector2i size_px = PhotographOf(*through).frame.size_px;
    if (size_px.maxCoeff() > kWidestPicture_px) {
      return Fail(
          {.code = Code::kOutOfRange,
           .message = fmt::format("a picture is 1 to {} pixels wide and high, and the camera's "
                                  "frame is larger",
                                  kWidestPicture_px),
           .help = "render size=1280,960"});
    }
    request.width_px = size_px.x(), request.height_px = size_px.y();
  }
  Fired fired;
  fired.edit.outputs.emplace_back(std::move(request));
  return fired;
}

// How a camera is kept by a file's ending; of one ending the first unless a word says another.
struct CameraFile {
  std::string_view extension, word;
  model::CameraFormat format;
};
constexpr CameraFile kCameraFiles[] = {{"fspy", "fspy", model::CameraFormat::kFspyProject},
                                       {"json", "fspy", model::CameraFormat::kFspyJson},
                                       {"json", "exact", model::CameraFormat::kExact},
                                       {"yaml", "opencv", model::CameraFormat::kOpenCv},
                                       {"yml", "opencv", model::CameraFormat::kOpenCv},
                                       {"py", "blender", model::CameraFormat::kBlender}};

std::optional<model::CameraFormat> CameraFormatOf(const std::string& extension,
                                                  const Answers& answers) {
  if (answers.HasWord("colmap")) return model::CameraFormat::kColmap;
  for (const CameraFile& row : kCameraFiles) {
    if (row.extension != extension) continue;
    if (answers.words.empty() || answers.HasWord(row.word)) return row.format;
  }
  return std::nullopt;
}

CommandResult ExportCamera(const State& state, const Answers& answers, model::CameraFormat format) {
  const auto found = CameraAt(state, answers, "camera");
  if (!found) return Fail(found.error());
  const model::Photograph& photograph = PhotographOf(**found);
  model::CameraRequest request{*found, nullptr, format, answers.Text("file")};
  const bool is_stated = model::IsStatedCamera(photograph);
  if (is_stated && format == model::CameraFormat::kFspyProject) {
    return Fail({.code = Code::kNoPhotograph,
                 .message = fmt::format("an fSpy project holds a photograph, and {} was stated "
                                        "without one",
                                        NameForMessage(**found)),
                 .help = "export \"camera.json\" gives fSpy's camera alone",
                 .where = AtKey("file")});
  }
  if (!is_stated && format != model::CameraFormat::kExact) {
    const auto pixels = PixelsOf(**found);
    // A replay, which has no pixels, makes no pictures either.
    if (!pixels && pixels.error().code != Code::kCannotRead) return Fail(pixels.error());
    if (pixels) request.picture = *pixels;
  }
  Fired fired;
  fired.edit.outputs.emplace_back(std::move(request));
  return fired;
}

CommandResult Export(const State& state, const Answers& answers) {
  const std::string file = answers.Text("file");
  if (file.empty()) {
    return Fail({.code = Code::kMissingValue,
                 .message = "the file's name is missing",
                 .help = "export \"church.glb\""});
  }
  const std::string extension = Extension(file);
  if (const auto format = CameraFormatOf(extension, answers)) {
    return ExportCamera(state, answers, *format);
  }
  if (!answers.words.empty() || (extension != "glb" && extension != "stl")) {
    return Fail(UnknownFormat(file,
                              "glb, stl; of a camera fspy, json (`fspy` or `exact`), yaml, "
                              "py, or a folder with `colmap`"));
  }
  if (answers.Has("camera")) {
    return Fail({.code = Code::kUnknownFormat,
                 .message = fmt::format("`{}` holds the model, and `camera=` asks for a camera",
                                        Printable(file)),
                 .help = "export \"fire.fspy\" camera=fire",
                 .where = AtKey("camera")});
  }
  Fired fired;
  fired.edit.outputs.emplace_back(
      model::ExportRequest{state.model, file, state.drawing.view->photo});
  return fired;
}

CommandResult Print(const State&, const Answers& answers) {
  if (!answers.Has("text")) {
    return Fail({.code = Code::kMissingValue,
                 .message = "what is to be printed?",
                 .help = "print \"the nave is {nave.length} long\""});
  }
  Fired fired;
  fired.messages.push_back(answers.Text("text"));
  return fired;
}

constexpr Key kRenderKeys[] = {
    {"file", Type::kString, "the picture's name; numbered pictures without"},
    {"size", Type::kSize, "width and height in pixels", {}, "1280,960"}};
constexpr Key kExportKeys[] = {
    {"file", Type::kString, "the file's name", {}, {}, -1, true},
    {"camera", Type::kElement, "the photograph or camera; the one last attached or set without"}};
constexpr Key kPrintKeys[] = {{"text", Type::kString, "what to print", {}, {}, -1, true}};

constexpr Example kRenderExamples[] = {
    {"place block xy=0,0,0 xy=4,3,0; render file=\"plan.png\" size=640,480", "true"},
    {"render file=\"plan.bmp\"", "E0705"}};
constexpr Example kRenderAllExamples[] = {{"place line xy=0,0,0 dl=3; render all", "true"},
                                          {"render all size=640,480", "true"},
                                          {"render all size=0,480", "E0212"}};
#define TRANOS_CAMERA                                                        \
  "place camera f=35mm format=36mm,24mm size=1600,1067 skew=89deg phi=30deg" \
  " xy=10,-30,2 as hall\n"
constexpr Example kExportExamples[] = {
    {"place block xy=0,0,0 xy=4,3,0; export \"hall.glb\"", "true"},
    {"place slab length=4m width=3m height=2m xy=0,0,0; export \"hall.stl\"", "true"},
    {TRANOS_CAMERA "export \"hall.json\" camera=hall", "true"},
    {TRANOS_CAMERA "export exact \"hall.json\" camera=hall", "true"},
    {TRANOS_CAMERA "export fspy \"hall.json\" camera=hall", "true"},
    {TRANOS_CAMERA "export opencv \"hall.yaml\" camera=hall", "true"},
    {TRANOS_CAMERA "export blender \"hall.py\" camera=hall", "true"},
    {TRANOS_CAMERA "export colmap \"hall\" camera=hall", "true"},
    {TRANOS_CAMERA "export \"hall.fspy\" camera=hall", "E0901"},
    {TRANOS_CAMERA "export \"hall.glb\" camera=hall", "E0705"},
    {"attach photo \"facade.png\" as hall; export \"hall.fspy\"", "E0902"},
    {"export \"hall.yaml\"", "E0901"},
    {"export \"hall.doc\"", "E0705"}};
#undef TRANOS_CAMERA
constexpr Example kPrintExamples[] = {
    {"place line xy=0,0,0 dl=3; print \"it is {last.length} long\"", "last.length == 3m"},
    {"print", "E0220"}};

constexpr Command kCommands[] = {
    {.words = "render",
     .family = "output",
     .summary =
         "Draws everything on levels that are on into one picture, seen as `view` and `set view` "
         "say; iso unless set.",
     .keys = kRenderKeys,
     .string_key = "file",
     .examples = kRenderExamples,
     .execute = Render},
    {.words = "render all",
     .family = "output",
     .summary = "Draws everything on levels that are on into one picture, as `render`.",
     .keys = kRenderKeys,
     .string_key = "file",
     .examples = kRenderAllExamples,
     .execute = Render},
    {.words = "export",
     .family = "output",
     .summary =
         "Writes the model as it stands into a file, whose extension chooses the format: glb, or "
         "stl for the faces alone; or a camera for other programs: fspy and json for fSpy, yaml "
         "for "
         "OpenCV, py for Blender, a folder for COLMAP, json with `exact` for the camera as it is.",
     .keys = kExportKeys,
     .options = "fspy|opencv|colmap|blender|exact",
     .string_key = "file",
     .examples = kExportExamples,
     .execute = Export},
    {.words = "print",
     .family = "output",
     .summary = "Says something while the script runs.",
     .keys = kPrintKeys,
     .string_key = "text",
     .examples = kPrintExamples,
     .execute = Print},
};

}  // namespace

std::span<const Command> OutputCommands() { return kCommands; }

}  // namespace tranos::interp
