// SPDX-License-Identifier: GPL-3.0-or-later
// Running scripts that are in memory.
#pragma once

#include <map>
#include <string>

#include "session/difference.h"
#include "session/journal.h"

namespace tranos::session {

inline interp::Host HostOf(const std::map<std::string, std::string>& files) {
  interp::Host host;
  host.read = [files](std::string_view path) -> tl::expected<std::string, interp::HostError> {
    const auto found = files.find(std::string(path));
    if (found != files.end()) return found->second;
    return tl::make_unexpected(interp::HostError{interp::HostError::kMissing, "no such file"});
  };
  return host;
}

inline RunRecord RecordOf(const std::string& path, const std::string& text,
                          const RunSettings& settings = {},
                          const std::map<std::string, std::string>& files = {}) {
  RunRecord record;
  OriginRecorder recorder(&record);
  record.result = interp::RunScript(
      path, text, {settings.hypothesis, settings.parameters, settings.limits.depth},
      {settings.limits, [&](const interp::Step& step) { recorder.Add(step); }}, HostOf(files));
  return record;
}

inline std::string ProblemsOf(const interp::ScriptResult& result) {
  std::string out;
  for (const auto& diagnostic : result.diagnostics.list())
    out += interp::RenderText(diagnostic, *result.sources, false);
  if (!result.undeclared.empty()) out += "undeclared " + result.undeclared[0];
  return out;
}

inline std::string JournalOf(const std::string& text, const RunSettings& settings = {},
                             const std::map<std::string, std::string>& files = {},
                             std::size_t chunk = 1 << 16) {
  std::string journal;
  JournalWriter writer(
      settings, "1.2.3", [&](std::string_view piece) { journal += piece; }, chunk);
  const auto result = interp::RunScript(
      "test.trn", text, {settings.hypothesis, settings.parameters, settings.limits.depth},
      {settings.limits, [&](const interp::Step& step) { writer.Add(step); }}, HostOf(files));
  writer.Finish(result);
  return journal;
}

inline Difference DiffOf(const std::string& a, const std::string& b) {
  return Diff(RecordOf("a.trn", a), RecordOf("b.trn", b));
}

// A line for each change, equal ones counted: "moved line `sill` by 0,1,0 x3: start, next point".
std::string Summary(const Difference& difference);

}  // namespace tranos::session
