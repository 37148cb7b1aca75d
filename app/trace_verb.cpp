// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "app/console.h"
#include "app/script_run.h"
#include "interp/arithmetic.h"

namespace tranos::app {

namespace {

using model::Trace;

// The photograph's name in the script: what it is called on the disk may be no name.
constexpr std::string_view kName = "picture";

interp::ScriptResult RunOn(const std::string& photo, const std::string& text) {
  const interp::Host host{[&photo](std::string_view) { return ReadNamedFile(photo); },
                          [](std::string_view) {}};
  return interp::RunScript(NameOf(photo), text, {}, {}, host);
}

std::string LineOf(const Trace& trace, std::string_view words, std::string_view name, int number) {
  std::string text = fmt::format("{} samples={:.0f}", words, trace.samples);
  for (const geom::Vec2& dot : trace.dots_px) text += fmt::format(" dot={},{}", dot.x(), dot.y());
  return text + fmt::format(" as {}{}\n", name, number);
}

// The traces that the run left, those of one direction together, longest first.
std::string TracesOf(const model::State& state) {
  struct Part {
    std::string_view heading, words, name;
    std::string text = {};
    int count = 0;
  };
  std::array<Part, 4> parts{
      Part{"along X, to the right and the more across the line of sight", "trace edge x", "x"},
      Part{"along Y, into the scene", "trace edge y", "y"},
      Part{"along Z, upright", "trace edge z", "z"},
      Part{"of no direction: left out by `calibrate`", "trace line", "line"}};
  state.model.ForEach([&](const model::ElementPtr& element) {
    const auto* trace = std::get_if<model::TracePtr>(&element->geometry);
    if (!trace) return;
    const int axis = (*trace)->axis;
    Part& part = parts[axis < 0 ? 3 : static_cast<std::size_t>(axis)];
    part.text += LineOf(**trace, part.words, part.name, ++part.count);
  });
  std::string text;
  for (const Part& part : parts) {
    if (part.count > 0) text += fmt::format("\n# {} {}\n{}", part.count, part.heading, part.text);
  }
  return text;
}

std::string BesidePhoto(const std::string& photo) {
  const std::string folder = FolderOf(photo);
  return (folder == "/" ? "" : folder) + "/" + StemOf(photo) + ".trn";
}

// The photograph as the script will name it: from the script's folder, however either was named on
// the command line, and without the links that a script may not follow. Empty where the script
// could not read it.
std::string NameFromScript(const TraceOptions& options) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const fs::path photo = fs::canonical(options.photo, failed);
  if (failed) return "";
  const fs::path folder = fs::canonical(FolderOf(options.output), failed);
  if (failed) return "";
  const fs::path name = photo.lexically_relative(folder);
  return name.empty() || *name.begin() == ".." ? "" : name.string();
}

// Why nothing is written, where something stands in the way.
std::string InTheWay(const TraceOptions& options, const std::string& photo) {
  if (NameOf(options.output).empty() || photo.empty()) {
    return "a script reads what is in its folder or below: `" + interp::Printable(options.output) +
           "` is to be in the photograph's folder or one above it, such as `-o " +
           interp::Printable(BesidePhoto(options.photo)) + "`";
  }
  const auto there = ReadNamedFile(options.output);
  if (there || there.error().kind != HostError::kMissing)
    return "`" + interp::Printable(options.output) + "` is there already, and may have been edited";
  return "";
}

}  // namespace

int TraceVerb(const TraceOptions& given) {
  TraceOptions options = given;
  if (options.output.empty()) {
    options.output = BesidePhoto(options.photo);
  }
  const auto bytes = ReadNamedFile(options.photo);
  if (!bytes) {
    PrintFailure("`" + interp::Printable(options.photo) +
                 "` cannot be read: " + bytes.error().detail);
    return kFileFailed;
  }
  const std::string name = NameFromScript(options);
  const std::string in_the_way = InTheWay(options, name);
  if (!in_the_way.empty()) {
    PrintFailure(in_the_way);
    return kFileFailed;
  }
  const std::string head = fmt::format("attach photo {} as {}\nprior default\nnoise=estimated\n",
                                       interp::KeyInText(model::Value::String(name)), kName);
  interp::ScriptResult result =
      RunOn(options.photo, head + "detect edges\ndetect vanishing points\n");
  const bool directed = !result.diagnostics.has_errors();
  if (!directed) result = RunOn(options.photo, head + "detect edges\n");
  if (result.diagnostics.has_errors()) {
    for (const interp::Diagnostic& diagnostic : result.diagnostics.list())
      PrintFailure(diagnostic.message);
    return kScriptIsWrong;
  }
  std::string text = "# The edges that `tranos trace` found. Keep, name, change or delete them.\n" +
                     head + TracesOf(result.outcome.state);
  if (directed) text += fmt::format("\ncalibrate robust=true\nreport camera {}\n", kName);
  if (auto written = ReplaceNamedFile(options.output, text); !written) {
    PrintFailure("`" + interp::Printable(options.output) +
                 "` cannot be written: " + written.error().detail);
    return kFileFailed;
  }
  if (!directed) {
    PrintError(
        "the edges show no two directions of a building: which are parallel to X, Y and Z is left "
        "to be said\n");
  }
  PrintOut("`" + interp::Printable(options.output) + "` holds the edges\n");
  return kFine;
}

}  // namespace tranos::app
