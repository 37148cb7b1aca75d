// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/outputs.h"

#include <filesystem>
#include <map>
#include <new>

#include "app/orthophoto_json.h"
#include "app/photo_truth.h"
#include "output/camera_files.h"
#include "output/orthophoto.h"
#include "output/png.h"
#include "output/write.h"

namespace tranos::app {

namespace {

using interp::Code;
using interp::Diagnostic;
using interp::Span;

// Of what is no fault of a statement.
constexpr Span kNoPlace{UINT32_MAX, 0, 0};

struct Request {
  model::OutputRequest what;
  std::string path;  // below the output folder; of several files the first's, or their folder
  Span span;
  std::string label = {};
};

// The model first, then what the script asked for in its order.
std::vector<Request> RequestsOf(const interp::ScriptResult& result, const std::string& stem) {
  const interp::Outcome& outcome = result.outcome;
  std::vector<Request> all;
  const auto add = [&](model::OutputRequest what, std::string path, Span span) {
    all.push_back({std::move(what), std::move(path), span});
  };
  const std::string model_path = stem + ".glb";
  const auto end = static_cast<std::uint32_t>(result.sources->files[0].text.size());
  const bool photographs = outcome.state.drawing.view->photo;
  add(model::ExportRequest{outcome.state.model, model_path, photographs}, model_path,
      {0, end, end});
  all.back().label = "at its end the model is written";
  int picture = 0;
  for (std::size_t i = 0; i < outcome.outputs.size(); ++i) {
    const model::OutputRequest& what = outcome.outputs[i];
    const auto* render = std::get_if<model::RenderRequest>(&what);
    std::string path = std::visit([](const auto& request) { return request.file; }, what);
    if (render && path.empty()) path = stem + "-" + std::to_string(++picture) + ".png";
    add(what, std::move(path), outcome.output_spans[i]);
  }
  return all;
}

using Files = std::vector<output::NamedFile>;

// "old/p.png" → "old/p.json"
std::string TruthPath(const std::string& picture) {
  return picture.substr(0, picture.rfind('.')) + ".json";
}

// One function for each kind of output: what it writes.
struct Maker {
  const std::string& path;
  int threads;

  output::Result<Files> operator()(const model::ExportRequest& request) const {
    return One(output::ExportOf(request, threads));
  }
  output::Result<Files> operator()(const model::RenderRequest& request) const {
    return One(output::PictureFileOf(request, threads));
  }
  output::Result<Files> operator()(const model::CameraRequest& request) const {
    return output::CameraFilesOf(request);
  }
  output::Result<Files> operator()(const model::PhotoFileRequest& request) const {
    const auto pixels = request.picture->Pixels();
    if (!pixels) return tl::unexpected(output::Error{pixels.error().detail});
    const camera::Photo& photo = **pixels;
    auto files = One(output::PngOf({photo.width_px, photo.height_px, photo.rgb}));
    if (files) {
      files->push_back({TruthPath(path), PhotoTruthJson(*request.taken_as, path)});
    }
    return files;
  }

  output::Result<Files> operator()(const model::OrthophotoRequest& request) const {
    const auto made = output::Rectify(*request.made, threads);
    if (!made) return tl::unexpected(made.error());
    auto files = One(output::PngOf(made->picture));
    if (files) files->push_back({TruthPath(path), OrthophotoJson(*request.made, made->seen, path)});
    return files;
  }

  output::Result<Files> One(output::Result<std::string> bytes) const {
    if (!bytes) return tl::unexpected(bytes.error());
    return Files{{path, std::move(*bytes)}};
  }
};

Diagnostic Refused(const Request& request, Code code, const std::string& why, std::string help) {
  return {code, request.span, "`" + request.path + "` cannot be made: " + why, request.label,
          std::move(help)};
}

tl::expected<Files, Diagnostic> MadeBy(const Request& request, int threads) {
  try {
    auto files = std::visit(Maker{request.path, threads}, request.what);
    if (files) return std::move(*files);
    const bool is_camera = std::holds_alternative<model::CameraRequest>(request.what);
    return tl::unexpected(Refused(
        request, is_camera ? Code::kOutOfRange : Code::kTooManyFacets, files.error().message,
        is_camera ? "export exact \"camera.json\" keeps it as it is"
                  : "a larger `tol` or a smaller `fn` gives fewer facets"));
  } catch (const std::bad_alloc&) {
    return tl::unexpected(Refused(request, Code::kMemoryLimit,
                                  "it takes more memory than the limit",
                                  "--limit memory=N raises it"));
  }
}

// All that it writes, before any of it is made.
tl::expected<std::vector<std::string>, Diagnostic> PathsOf(const Request& request) {
  if (std::holds_alternative<model::PhotoFileRequest>(request.what) ||
      std::holds_alternative<model::OrthophotoRequest>(request.what)) {
    return std::vector{request.path, TruthPath(request.path)};
  }
  const auto* camera = std::get_if<model::CameraRequest>(&request.what);
  if (!camera) return std::vector{request.path};
  auto paths = output::CameraPathsOf(*camera);
  if (paths) return std::move(*paths);
  return tl::unexpected(Refused(request, Code::kOutOfRange, paths.error().message,
                                "export exact \"camera.json\" keeps it as it is"));
}

// "a/../x.json" and "x.json" are one file.
std::string Plainly(const std::string& path) {
  return std::filesystem::path(path).lexically_normal().string();
}

// Of two outputs of one name the earlier would be lost.
Diagnostic Taken(const Request& request, const Request& earlier) {
  Diagnostic taken{Code::kProtectedFile,
                   request.span,
                   "`" + request.path + "` is already the name of another output of this run",
                   "the name is taken",
                   "give one of the two another name",
                   {{earlier.span, "taken by this one"}}};
  if (!earlier.label.empty()) {
    taken.message = "`" + request.path + "` is the name of the model, which every run writes";
    taken.help = "give it another name";
    taken.notes.clear();
  } else if (earlier.span == request.span) {
    taken.label = "the name is taken by what this statement wrote before";
    taken.help = "in a loop the name is to change: `\"plan{i}.png\"`";
    taken.notes.clear();
  }
  return taken;
}

Diagnostic FromHost(const interp::HostError& error, const std::string& path, Span span,
                    const std::string& label = {}) {
  using Kind = interp::HostError::Kind;
  const Code code = error.kind == Kind::kOutside     ? Code::kOutsideSandbox
                    : error.kind == Kind::kProtected ? Code::kProtectedFile
                                                     : Code::kCannotWrite;
  return {code, span, "`" + path + "` cannot be written: " + error.detail, label, ""};
}

Written Failed(Diagnostic diagnostic) {
  Written written;
  written.status = diagnostic.code == Code::kCannotWrite ? kFileFailed : kScriptIsWrong;
  written.diagnostics.Add(std::move(diagnostic));
  return written;
}

}  // namespace

Written WriteOutputs(const ScriptRun& run, const RunVerbOptions& options, Progress* progress) {
  const int threads = ThreadsOf(options.script.threads);
  const std::vector<Request> requests = RequestsOf(run.result, StemOf(options.script.script));
  auto writer = Writer::Into(options.output, run.sandbox.get());
  if (!writer) return Failed(FromHost(writer.error(), options.output, kNoPlace));
  // Refusals come before long work.
  std::map<std::string, const Request*> names;
  for (const Request& request : requests) {
    const auto paths = PathsOf(request);
    if (!paths) return Failed(paths.error());
    for (const std::string& path : *paths) {
      if (const auto free = writer->Check(path); !free) {
        return Failed(FromHost(free.error(), path, request.span, request.label));
      }
    }
    // What stands beside the first file may be shared, as two exports of a camera share a picture.
    const auto [taken, is_new] = names.emplace(Plainly(paths->front()), &request);
    if (!is_new) return Failed(Taken(request, *taken->second));
  }
  Written written;
  struct Content {
    model::Hash128 hash;
    const Request* request;
  };
  std::map<std::string, Content> contents;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const Request& request = requests[i];
    progress->Tell("writing " + interp::Printable(request.path) + ", " + std::to_string(i + 1) +
                   " of " + std::to_string(requests.size()));
    const auto files = MadeBy(request, threads);
    if (!files) return Failed(files.error());
    for (const auto& [path, bytes] : *files) {
      const model::Hash128 content = model::Hasher().Text(bytes).Finish();
      const auto [known, is_new] = contents.emplace(Plainly(path), Content{content, &request});
      if (!is_new && known->second.hash == content) continue;
      if (!is_new) {
        return Failed({Code::kProtectedFile,
                       request.span,
                       "`" + path + "` would be written twice, and differently",
                       request.label,
                       "give one of the two another name",
                       {{known->second.request->span, "it is written by this one, too"}}});
      }
      if (const auto put = writer->Write(path, bytes); !put) {
        return Failed(FromHost(put.error(), path, request.span, request.label));
      }
      written.files.push_back({options.output + "/" + path, bytes.size()});
    }
  }
  if (const auto placed = writer->PutInPlace(); !placed) {
    return Failed(FromHost(placed.error(), options.output, kNoPlace));
  }
  return written;
}

}  // namespace tranos::app
