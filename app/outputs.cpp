// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/outputs.h"

#include <thread>

#include "app/console.h"
#include "output/write.h"

namespace tranos::app {

namespace {

// "elements/church.trn" → "church"
std::string StemOf(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
  const std::size_t dot = name.rfind('.');
  if (dot != std::string::npos && dot > 0) name.resize(dot);
  return name;
}

struct FileBytes {
  std::string path;
  std::string bytes;
};

output::Result<FileBytes> BytesOf(const model::OutputRequest& request, const std::string& stem, int* picture,
                                  int threads) {
  if (const auto* exported = std::get_if<model::ExportRequest>(&request)) {
    auto bytes = output::ExportOf(exported->model, exported->file);
    if (!bytes) return tl::unexpected(bytes.error());
    return FileBytes{exported->file, std::move(*bytes)};
  }
  model::RenderRequest render = std::get<model::RenderRequest>(request);
  if (render.file.empty()) render.file = stem + "-" + std::to_string(++*picture) + ".png";
  auto bytes = output::PictureFileOf(render, threads);
  if (!bytes) return tl::unexpected(bytes.error());
  return FileBytes{render.file, std::move(*bytes)};
}

int StatusOf(const interp::HostError& error) {
  const bool refused = error.kind == interp::HostError::kOutside || error.kind == interp::HostError::kProtected;
  return refused ? kScriptIsWrong : kFileFailed;
}

}  // namespace

Written WriteOutputs(const ScriptRun& run, const RunVerbOptions& options) {
  const std::string stem = StemOf(options.script.script);
  const int threads = options.threads > 0 ? options.threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::vector<model::OutputRequest> requests{
      model::ExportRequest{run.result.outcome.state.model, stem + ".glb"}};
  for (const model::OutputRequest& request : run.result.outcome.outputs) requests.push_back(request);

  auto writer = Writer::Into(options.output, run.sandbox.get());
  if (!writer) {
    PrintFailure("the folder `" + interp::Printable(options.output) + "` cannot be written: " + writer.error().detail);
    return {kFileFailed, {}};
  }
  Written written;
  Progress progress;
  int picture = 0;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    if (requests.size() > 1) {
      progress.Tell("writing " + std::to_string(i + 1) + " of " + std::to_string(requests.size()));
    }
    const auto file = BytesOf(requests[i], stem, &picture, threads);
    if (!file) {
      PrintFailure(file.error().message);
      return {kScriptIsWrong, {}};
    }
    if (const auto put = writer->Write(file->path, file->bytes); !put) {
      PrintFailure("`" + interp::Printable(file->path) + "` cannot be written: " + put.error().detail);
      return {StatusOf(put.error()), {}};
    }
    written.files.push_back({options.output + "/" + file->path, file->bytes.size()});
  }
  if (const auto placed = writer->PutInPlace(); !placed) {
    PrintFailure("the output cannot be written: " + placed.error().detail);
    return {kFileFailed, {}};
  }
  return written;
}

}  // namespace tranos::app
