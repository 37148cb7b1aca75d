// SPDX-License-Identifier: GPL-3.0-or-later
// The face of this room: text in, state and edits out.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "interp/diagnostic.h"
#include "interp/host.h"
#include "interp/library.h"
#include "interp/parser.h"
#include "interp/program.h"
#include "model/edit.h"

namespace tranos::interp {

struct Limits {
  std::uint64_t steps = 50'000'000;
  std::uint64_t elements = 1'000'000;
  std::uint64_t memory = 2'000'000'000;  // bytes of values and elements
  int depth = 200;  // of calls, of definitions, and of nested syntax, each by itself
};

struct BindOptions {
  std::string hypothesis;                                       // "" for the first of each
  std::vector<std::pair<std::string, std::string>> parameters;  // -D name=value
  int depth = 200;
  const Library* library = nullptr;  // null: the standard one
};

// The program of a parsed script. Files that it uses are read through the host and added to
// the sources. With errors the program cannot run.
struct Bound {
  std::shared_ptr<const Program> program;
  Diagnostics diagnostics;
  std::vector<std::string> undeclared;  // -D names that the script does not declare
};
Bound Bind(std::shared_ptr<Sources> sources, const SyntaxTree& tree, const BindOptions& options,
           const Host& host);
// The program of an empty script and all of a library's family.
Bound BindFamily(const Library& library, const LibraryFamily& family);

// One key-in that was carried out, told as it happens.
struct Step {
  std::string key_in;  // with its values, as it could be keyed in again
  Span span;
  const model::Edit* edit = nullptr;    // null when the key-in fired nothing
  std::vector<model::ElementId> ids;    // made or changed
  const model::State* state = nullptr;  // after it
  const Sources* sources = nullptr;     // every file read: complete before the first step
  // Where an element comes from, for matching across runs: the statement's span, the turn of each
  // loop around it, the command's words, and what was answered.
  Span statement;  // of a group: where it ends, and `command` is empty
  std::vector<std::uint32_t> turns;
  std::vector<model::Value> turn_values;  // what each of these loops' variable stands for
  std::string command;
  std::vector<std::pair<std::string, model::Value>> answers;
};

struct AssertResult {
  std::string text, message, value, expected;
  bool passed = false;
  Span span;
};

struct RunOptions {
  Limits limits;
  std::function<void(const Step&)> on_step;  // null: steps are not told, and cost nothing
  // Told the steps done, at every 65536th or so: what shows progress reads the clock itself. May be
  // null.
  std::function<void(std::uint64_t steps)> on_progress = {};
  PhotographFiles photographs = {};  // known beforehand: not read through the host
};

struct Outcome {
  model::State state;
  Diagnostics
      diagnostics;  // an error among them: the run stopped there, and nothing is to be written
  std::vector<AssertResult> asserts;
  std::vector<model::OutputRequest> outputs;
  std::vector<Span> output_spans;  // of each of these: its file's name, or else the command
  std::vector<std::pair<std::string, model::Value>>
      lets;  // of the top level, for tests and inspection
  std::uint64_t steps = 0;
};
Outcome Run(const Program& program, const RunOptions& options, const Host& host);

// Text to outcome in one call: UTF-8, parse, bind, run.
struct ScriptResult {
  std::shared_ptr<Sources> sources;
  Diagnostics diagnostics;  // of all phases
  Outcome outcome;
  bool ran = false;  // false: an error before running
  std::vector<std::string> undeclared;
};
ScriptResult RunScript(std::string path, std::string text, const BindOptions& bind_options,
                       const RunOptions& run_options, const Host& host);

// The same without running: what can be said of the text alone.
ScriptResult CheckScript(std::string path, std::string text, const BindOptions& bind_options,
                         const Host& host);

}  // namespace tranos::interp
