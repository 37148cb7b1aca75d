// SPDX-License-Identifier: GPL-3.0-or-later
// render, export, print: what leaves the program.
#include <fmt/format.h>

#include <algorithm>

#include "interp/commands/families.h"
#include "interp/commands/firing.h"

namespace tranos::interp {

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
  if (!request.file.empty() && Extension(request.file) != "png") {
    return Fail(UnknownFormat(request.file, "png"));
  }
  if (const model::Value* given = answers.Find("size")) {
    const auto size_px = SizeOf(*given);
    if (!size_px) {
      return Fail(
          {.code = Code::kOutOfRange,
           .message = fmt::format("a picture is 1 to {} pixels wide and high", kWidestPicture_px),
           .where = {Where::kKey, 0, "size"}});
    }
    std::tie(request.width_px, request.height_px) = *size_px;
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
  if (extension != "glb" && extension != "stl") return Fail(UnknownFormat(file, "glb, stl"));
  Fired fired;
  fired.edit.outputs.emplace_back(model::ExportRequest{state.model, file});
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
constexpr Key kExportKeys[] = {{"file", Type::kString, "the file's name", {}, {}, -1, true}};
constexpr Key kPrintKeys[] = {{"text", Type::kString, "what to print", {}, {}, -1, true}};

constexpr Example kRenderExamples[] = {
    {"place block xy=0,0,0 xy=4,3,0; render file=\"plan.png\" size=640,480", "true"},
    {"render file=\"plan.bmp\"", "E0705"}};
constexpr Example kRenderAllExamples[] = {{"place line xy=0,0,0 dl=3; render all", "true"},
                                          {"render all size=640,480", "true"},
                                          {"render all size=0,480", "E0212"}};
constexpr Example kExportExamples[] = {
    {"place block xy=0,0,0 xy=4,3,0; export \"hall.glb\"", "true"},
    {"place slab length=4m width=3m height=2m xy=0,0,0; export \"hall.stl\"", "true"},
    {"export \"hall.doc\"", "E0705"}};
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
         "stl for the faces alone.",
     .keys = kExportKeys,
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
