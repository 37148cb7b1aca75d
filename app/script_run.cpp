// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/script_run.h"

#include <algorithm>
#include <thread>

#include "app/memory_limit.h"
#include "output/photograph.h"

namespace tranos::app {

namespace {

// The script's text, its sandbox made and memory limited from here on; with kFileFailed after
// telling why, if there is none.
std::string Open(const ScriptOptions& options, ScriptRun* run) {
  std::vector<std::string> folders{FolderOf(options.script)};
  folders.insert(folders.end(), options.allow.begin(), options.allow.end());
  run->sandbox = std::make_unique<Sandbox>(std::move(folders));
  run->sandbox->NoteRead(options.script);
  auto text = ReadNamedFile(options.script);
  if (!text) {
    PrintFailure("`" + interp::Printable(options.script) +
                 "` cannot be read: " + text.error().detail);
    run->status = kFileFailed;
    return "";
  }
  LimitMemory(options.limits.memory);
  return std::move(*text);
}

tl::expected<camera::PhotoPtr, std::string> TakenBy(const model::PhotoRequest& request,
                                                    int threads) {
  auto photo = output::TakePhotograph(request, threads);
  if (!photo) return tl::make_unexpected(photo.error().message);
  return std::make_shared<const camera::Photo>(std::move(*photo));
}

interp::Host HostFor(Sandbox* sandbox, bool print_to_error, int threads, Progress* progress) {
  return {[sandbox](std::string_view path) { return sandbox->Read(path); },
          [print_to_error, progress](std::string_view line) {
            if (progress) progress->Hide();
            const std::string text = std::string(line) + "\n";
            print_to_error ? PrintError(text) : PrintOut(text);
          },
          [threads](const model::PhotoRequest& request) { return TakenBy(request, threads); }};
}

int StatusOf(const interp::ScriptResult& result) {
  if (result.diagnostics.has_errors()) {
    for (const interp::Diagnostic& diagnostic : result.diagnostics.list()) {
      if (diagnostic.code == interp::Code::kCannotRead) return kFileFailed;
    }
    return kScriptIsWrong;
  }
  if (!result.undeclared.empty()) return kCommandLineIsWrong;
  for (const interp::AssertResult& assertion : result.outcome.asserts) {
    if (!assertion.passed) return kAssertionFailed;
  }
  return kFine;
}

interp::BindOptions BindOptionsOf(const ScriptOptions& options) {
  return {options.hypothesis, options.parameters, options.limits.depth};
}

// As a diagnostic is laid out: what failed, where, and under the carets what it is and what was
// expected.
void PrintFailedAssertion(const interp::AssertResult& assertion, const interp::Sources& sources) {
  const bool colour = ErrorsAreOnTerminal();
  const std::string& what = assertion.message.empty() ? assertion.text : assertion.message;
  const std::string head = "assertion failed";
  PrintError((colour ? "\x1b[1;31m" + head + "\x1b[0m" : head) + ": " + interp::Printable(what) +
             "\n" +
             interp::RenderPlace(assertion.span,
                                 "it is " + assertion.value + ", expected " + assertion.expected,
                                 sources, colour));
}

}  // namespace

int ThreadsOf(int asked) {
  return asked > 0 ? asked : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

std::string FolderOf(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

std::string NameOf(const std::string& path) { return path.substr(path.rfind('/') + 1); }

std::string StemOf(const std::string& path) {
  std::string name = NameOf(path);
  const std::size_t dot = name.rfind('.');
  if (dot != std::string::npos && dot > 0) name.resize(dot);
  return name;
}

ScriptRun RunScriptFile(const ScriptOptions& options, bool print_to_error,
                        std::function<void(const interp::Step&)> on_step, Progress* progress) {
  ScriptRun run;
  std::string text = Open(options, &run);
  if (run.status != kFine) return run;
  interp::RunOptions run_options{options.limits, std::move(on_step)};
  if (progress) {
    run_options.on_progress = [progress](std::uint64_t steps) {
      progress->Tell(std::to_string(steps / 1000) + " thousand steps");
    };
  }
  run.result = interp::RunScript(
      NameOf(options.script), std::move(text), BindOptionsOf(options), run_options,
      HostFor(run.sandbox.get(), print_to_error, ThreadsOf(options.threads), progress));
  run.status = StatusOf(run.result);
  return run;
}

ScriptRun CheckScriptFile(const ScriptOptions& options) {
  ScriptRun run;
  std::string text = Open(options, &run);
  if (run.status != kFine) return run;
  run.result = interp::CheckScript(NameOf(options.script), std::move(text), BindOptionsOf(options),
                                   HostFor(run.sandbox.get(), true, 1, nullptr));
  run.status = StatusOf(run.result);
  return run;
}

void NamePathsFromHere(const ScriptOptions& options, ScriptRun* run) {
  if (!run->result.sources || options.script.find('/') == std::string::npos) return;
  const std::string folder = options.script.substr(0, options.script.rfind('/') + 1);
  for (interp::SourceText& source : run->result.sources->files) {
    if (!source.path.starts_with('/') && !source.of_library) source.path = folder + source.path;
  }
}

void PrintProblems(const ScriptRun& run) {
  if (!run.result.sources) return;
  PrintDiagnostics(run.result.diagnostics, *run.result.sources);
  for (const std::string& name : run.result.undeclared) {
    PrintFailure("the script declares no parameter `" + interp::Printable(name) +
                 "`: -D sets those declared by `parameter`");
  }
  for (const interp::AssertResult& assertion : run.result.outcome.asserts) {
    if (!assertion.passed) PrintFailedAssertion(assertion, *run.result.sources);
  }
}

}  // namespace tranos::app
