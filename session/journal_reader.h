// SPDX-License-Identifier: GPL-3.0-or-later
// A journal's beginning and end, checked; the steps between stay text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "interp/host.h"
#include "session/journal.h"

namespace tranos::session {

// What is wrong with a journal, or what a replay found, by the journal's line (from 1).
struct JournalFinding {
  interp::Code code;
  std::uint64_t line;
  std::string message;
  std::vector<std::string> details = {};  // a line each
};
// As a diagnostic is rendered, with the journal in the place of a script.
std::string RenderText(const JournalFinding& finding, std::string_view path);

struct Journal {
  RunSettings settings;
  std::string program;                      // the version that wrote it
  std::vector<interp::SourceText> sources;  // the script first; without the beginnings of lines
  std::string_view steps;  // of the journal's text: the lines after the first, the last one too
};

// Whether the text begins as a journal does.
bool IsJournal(std::string_view text);
// Refers to the text, which has to outlive it.
tl::expected<Journal, JournalFinding> ReadJournal(std::string_view text);
// Runs the script that the journal holds. It reads nothing but the files that are in the journal;
// what it prints goes to `print`, which may be null.
interp::ScriptResult RunJournal(const Journal& journal,
                                std::function<void(const interp::Step&)> on_step,
                                std::function<void(std::string_view)> print);

}  // namespace tranos::session
