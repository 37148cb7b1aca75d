// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/script_run.h"

#include "app/console.h"
#include "app/memory_limit.h"

namespace tranos::app {

std::string FolderOf(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

interp::Host HostFor(Sandbox* sandbox, bool print_to_error) {
  return {[sandbox](std::string_view path) { return sandbox->Read(path); },
          [print_to_error](std::string_view line) {
            const std::string text = std::string(line) + "\n";
            print_to_error ? PrintError(text) : PrintOut(text);
          }};
}

ScriptRun RunScriptFile(const ScriptOptions& options, bool print_to_error,
                        std::function<void(const interp::Step&)> on_step) {
  ScriptRun run;
  auto text = ReadNamedFile(options.script);
  if (!text) {
    PrintFailure("`" + interp::Printable(options.script) + "` cannot be read: " + text.error().detail);
    run.status = kFileFailed;
    return run;
  }
  std::vector<std::string> folders{FolderOf(options.script)};
  folders.insert(folders.end(), options.allow.begin(), options.allow.end());
  run.sandbox = std::make_unique<Sandbox>(std::move(folders));
  run.sandbox->NoteRead(options.script);
  LimitMemory(options.limits.memory);
  const std::size_t slash = options.script.rfind('/');
  run.result = interp::RunScript(slash == std::string::npos ? options.script : options.script.substr(slash + 1),
                                 std::move(*text), {options.hypothesis, options.parameters, options.limits.depth},
                                 {options.limits, std::move(on_step)}, HostFor(run.sandbox.get(), print_to_error));
  if (run.result.diagnostics.has_errors()) {
    run.status = kScriptIsWrong;
    for (const interp::Diagnostic& diagnostic : run.result.diagnostics.list()) {
      if (diagnostic.code == interp::Code::kCannotRead) run.status = kFileFailed;
    }
  } else if (!run.result.undeclared.empty()) {
    run.status = kCommandLineIsWrong;
  } else {
    for (const interp::AssertResult& assertion : run.result.outcome.asserts) {
      if (!assertion.passed) run.status = kAssertionFailed;
    }
  }
  return run;
}

void PrintProblems(const ScriptRun& run) {
  if (!run.result.sources) return;
  PrintDiagnostics(run.result.diagnostics, *run.result.sources);
  for (const std::string& name : run.result.undeclared) {
    PrintFailure("the script declares no parameter `" + interp::Printable(name) + "`: -D sets those declared by `parameter`");
  }
  for (const interp::AssertResult& assertion : run.result.outcome.asserts) {
    if (assertion.passed) continue;
    const auto& source = run.result.sources->files[assertion.span.file];
    const auto place = source.PlaceOf(assertion.span.begin);
    std::string line = "assertion failed: " + interp::Printable(assertion.text);
    if (!assertion.message.empty()) line += " (" + interp::Printable(assertion.message) + ")";
    line += "\n  --> " + interp::Printable(source.path) + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
    line += "\n   = it is " + interp::Printable(assertion.value) + ", expected " + interp::Printable(assertion.expected) + "\n";
    PrintError(line);
  }
}

}  // namespace tranos::app
