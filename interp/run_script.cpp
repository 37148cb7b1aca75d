// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/run.h"

namespace tranos::interp {

namespace {

// The bound program of a text, its diagnostics added to the result; null after an error.
std::shared_ptr<const Program> BindSource(const BindOptions& options, const Host& host,
                                          ScriptResult* result) {
  const std::size_t bad = FirstInvalidUtf8(result->sources->files[0].text);
  if (bad != std::string::npos) {
    const auto at = static_cast<std::uint32_t>(bad);
    result->diagnostics.Add(
        {Code::kNotUtf8,
         {0, at, at + 1},
         "the file is not UTF-8: its byte " + std::to_string(bad) + " begins no character",
         "",
         "save the file as UTF-8"});
    return nullptr;
  }
  const SyntaxTree tree = Parse(*result->sources, 0, {options.depth}, &result->diagnostics);
  if (result->diagnostics.has_errors()) return nullptr;
  Bound bound = Bind(result->sources, tree, options, host);
  result->undeclared = std::move(bound.undeclared);
  result->diagnostics.Append(bound.diagnostics);
  result->diagnostics.SortByPlace();
  return result->diagnostics.has_errors() ? nullptr : bound.program;
}

std::shared_ptr<const Program> BindText(std::string path, std::string text,
                                        const BindOptions& options, const Host& host,
                                        ScriptResult* result) {
  result->sources = std::make_shared<Sources>();
  try {
    result->sources->files.push_back(MakeSource(std::move(path), std::move(text)));
    return BindSource(options, host, result);
  } catch (const std::bad_alloc&) {
    result->diagnostics.Add({Code::kMemoryLimit,
                             {},
                             "the script's text needs more memory than the limit of the run",
                             "",
                             "--limit memory=N raises it"});
    return nullptr;
  }
}

}  // namespace

ScriptResult CheckScript(std::string path, std::string text, const BindOptions& bind_options,
                         const Host& host) {
  ScriptResult result;
  BindText(std::move(path), std::move(text), bind_options, host, &result);
  return result;
}

ScriptResult RunScript(std::string path, std::string text, const BindOptions& bind_options,
                       const RunOptions& run_options, const Host& host) {
  ScriptResult result;
  const auto program = BindText(std::move(path), std::move(text), bind_options, host, &result);
  if (!program || !result.undeclared.empty()) return result;
  result.outcome = Run(*program, run_options, host);
  result.diagnostics.Append(result.outcome.diagnostics);
  result.ran = true;
  return result;
}

}  // namespace tranos::interp
