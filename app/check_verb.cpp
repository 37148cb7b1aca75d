// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/console.h"
#include "app/script_run.h"

namespace tranos::app {

// Parses and binds, and runs nothing: all that can be said of a script without drawing.
int CheckVerb(const ScriptOptions& options, bool json) {
  auto text = ReadNamedFile(options.script);
  if (!text) {
    PrintFailure("`" + interp::Printable(options.script) + "` cannot be read: " + text.error().detail);
    return kFileFailed;
  }
  std::vector<std::string> folders{FolderOf(options.script)};
  folders.insert(folders.end(), options.allow.begin(), options.allow.end());
  Sandbox sandbox(std::move(folders));
  const interp::ScriptResult result =
      interp::CheckScript(options.script, std::move(*text),
                          {options.hypothesis, options.parameters, options.limits.depth}, HostFor(&sandbox, true));
  if (json) {
    std::string list;
    for (const interp::Diagnostic& diagnostic : result.diagnostics.list()) {
      list += (list.empty() ? "\n  " : ",\n  ") + interp::RenderJson(diagnostic, *result.sources);
    }
    PrintOut("[" + list + "\n]\n");
  } else {
    PrintDiagnostics(result.diagnostics, *result.sources);
  }
  return result.diagnostics.has_errors() ? kScriptIsWrong : kFine;
}

}  // namespace tranos::app
