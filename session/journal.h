// SPDX-License-Identifier: GPL-3.0-or-later
// The journal of a run: lines of JSON, described in docs/journal.md.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interp/run.h"
#include "session/element_geometry.h"
#include "session/json_text.h"

namespace tranos::session {

inline constexpr int kJournalVersion = 1;

// What a run was started with, its text apart.
struct RunSettings {
  std::vector<std::pair<std::string, std::string>> parameters;  // -D
  std::string hypothesis;
  interp::Limits limits;
};

// Told of a run's steps, gives the journal's text piece by piece to a sink.
class JournalWriter {
 public:
  using Sink = std::function<void(std::string_view text)>;
  // `program` is the version of Tranos. The sink gets whole lines, up to `chunk` bytes and one line
  // at a time.
  JournalWriter(RunSettings settings, std::string program, Sink sink, std::size_t chunk = 1 << 16);

  void Add(const interp::Step& step);
  // The last line. To be called once, for a run that ended, well or not.
  void Finish(const interp::ScriptResult& result);

 private:
  void Begin(const interp::Sources& sources);
  void WriteSources(const interp::Sources& sources);
  void WritePlace(const interp::Step& step);
  void WriteEdit(const interp::Step& step);
  void Flush();

  RunSettings settings_;
  std::string program_;
  Sink sink_;
  std::size_t chunk_;
  JsonText out_;
  KnownPrototypes prototypes_;
  bool begun_ = false;
  std::uint64_t steps_ = 0;
  // The place told last, for columns are counted from there.
  interp::Span place_;
  interp::SourceText::Place line_column_{1, 1};
};

// Of a text, as the journal identifies source files.
model::Hash128 HashOfText(std::string_view text);

}  // namespace tranos::session
