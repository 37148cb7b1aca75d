// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/outputs.h"

#include <algorithm>
#include <new>

#include "app/photo_truth.h"
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
  std::string path;  // below the output folder
  Span span;
  std::string label = {};
};

// "elements/church.trn" → "church"
std::string StemOf(const std::string& path) {
  std::string name = path.substr(path.rfind('/') + 1);
  const std::size_t dot = name.rfind('.');
  if (dot != std::string::npos && dot > 0) name.resize(dot);
  return name;
}

// The model first, then what the script asked for in its order; of two with one path the later
// stays.
std::vector<Request> RequestsOf(const interp::ScriptResult& result, const std::string& stem) {
  const interp::Outcome& outcome = result.outcome;
  std::vector<Request> all;
  const auto add = [&](model::OutputRequest what, std::string path, Span span) {
    std::erase_if(all, [&](const Request& earlier) { return earlier.path == path; });
    all.push_back({std::move(what), std::move(path), span});
  };
  const std::string model_path = stem + ".glb";
  const auto end = static_cast<std::uint32_t>(result.sources->files[0].text.size());
  add(model::ExportRequest{outcome.state.model, model_path}, model_path, {0, end, end});
  all.back().label = "at its end the model is written";
  int picture = 0;
  for (std::size_t i = 0; i < outcome.outputs.size(); ++i) {
    const model::OutputRequest& what = outcome.outputs[i];
    std::string path = std::visit([](const auto& request) { return request.file; }, what);
    if (std::holds_alternative<model::RenderRequest>(what) && path.empty()) {
      path = stem + "-" + std::to_string(++picture) + ".png";
    }
    add(what, std::move(path), outcome.output_spans[i]);
  }
  return all;
}

// One function for each kind of output: its bytes.
struct Maker {
  int threads;

  output::Result<std::string> operator()(const model::ExportRequest& request) const {
    return output::ExportOf(request.model, request.file);
  }
  output::Result<std::string> operator()(const model::RenderRequest& request) const {
    return output::PictureFileOf(request, threads);
  }
  output::Result<std::string> operator()(const model::PhotoFileRequest& request) const {
    if (request.file.ends_with(".json")) {
      const std::string stem = request.file.substr(0, request.file.size() - 5);
      return PhotoTruthJson(*request.taken_as, stem + ".png");
    }
    return output::PngOf(
        {request.pixels->width_px, request.pixels->height_px, request.pixels->rgb});
  }
};

tl::expected<std::string, Diagnostic> BytesOf(const Request& request, int threads) {
  const auto refused = [&](Code code, std::string why, std::string help) {
    return tl::unexpected(Diagnostic{code, request.span,
                                     "`" + request.path + "` cannot be made: " + std::move(why),
                                     request.label, std::move(help)});
  };
  try {
    auto bytes = std::visit(Maker{threads}, request.what);
    if (bytes) return std::move(*bytes);
    return refused(Code::kTooManyFacets, bytes.error().message,
                   "a larger `tol` or a smaller `fn` gives fewer facets");
  } catch (const std::bad_alloc&) {
    return refused(Code::kMemoryLimit, "it takes more memory than the limit",
                   "--limit memory=N raises it");
  }
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
  for (const Request& request : requests) {
    if (const auto free = writer->Check(request.path); !free) {
      return Failed(FromHost(free.error(), request.path, request.span, request.label));
    }
  }
  Written written;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const Request& request = requests[i];
    progress->Tell("writing " + interp::Printable(request.path) + ", " + std::to_string(i + 1) +
                   " of " + std::to_string(requests.size()));
    const auto bytes = BytesOf(request, threads);
    if (!bytes) return Failed(bytes.error());
    if (const auto put = writer->Write(request.path, *bytes); !put) {
      return Failed(FromHost(put.error(), request.path, request.span, request.label));
    }
    written.files.push_back({options.output + "/" + request.path, bytes->size()});
  }
  if (const auto placed = writer->PutInPlace(); !placed) {
    return Failed(FromHost(placed.error(), options.output, kNoPlace));
  }
  return written;
}

}  // namespace tranos::app
