// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/reference.h"

#include <algorithm>
#include <map>
#include <vector>

#include "interp/functions.h"
#include "interp/program.h"

namespace tranos::app {

namespace {

using interp::Command;
using interp::Manner;

std::string Text(std::string_view text) { return std::string(text); }

bool IsThere(const Command& command) {
  return command.execute || command.history != interp::HistoryStep::kNone;
}

std::string Pad(std::string text, std::size_t width) {
  if (text.size() < width) text.append(width - text.size(), ' ');
  return text;
}

// How a command runs, in a sentence made from its row.
std::string MannerOf(const Command& c) {
  std::string prompts;
  for (std::size_t i = 0; i < c.prompts.size(); ++i)
    prompts += (i ? ", then " : "") + Text(c.prompts[i].name);
  switch (c.manner) {
    case Manner::kImmediate:
      return "Asks for no data point; runs at the end of its statement.";
    case Manner::kPlaces:
    case Manner::kTransforms: {
      std::string out = "Asks for " + prompts;
      if (static_cast<std::size_t>(c.again) < c.prompts.size()) {
        out += c.again > 0
                   ? "; then again from " + Text(c.prompts[static_cast<std::size_t>(c.again)].name)
                   : "; then begins anew";
      }
      if (c.manner == Manner::kTransforms) out += ". Works on `of=` or on what is chosen";
      return out + ".";
    }
    case Manner::kGathers:
      return "Gathers data points, " + std::to_string(c.least) +
             " or more, and makes one element when it ends.";
    case Manner::kPicks:
      return "Takes `of=`, or what is chosen and picked by data points; a point farther than `lt` "
             "from everything, or the command's end, accepts.";
    case Manner::kEdits:
      return "Takes `of=`, or what is chosen, or picks by data points; a point farther than `lt` "
             "from everything accepts picks.";
    case Manner::kChooses:
      return "Takes the nearest element within `lt` at each data point.";
  }
  return "";
}

std::string Words(std::string_view list) {
  std::string out;
  for (const std::string& word : interp::SplitWords(list))
    out += (out.empty() ? "`" : ", `") + word + "`";
  return out;
}

std::string KeyLine(const interp::Key& key, const Command& c) {
  std::string line = "`" + Text(key.name) + "=` " +
                     (key.type == interp::Type::kWord
                          ? "one of " + Words(key.words)
                          : (key.list ? "a list, each " : "") + Text(Describe(key.type)));
  if (!key.summary.empty()) line += ": " + Text(key.summary);
  if (key.prompt >= 0 && static_cast<std::size_t>(key.prompt) < c.prompts.size()) {
    line += "; answers \"" + Text(c.prompts[static_cast<std::size_t>(key.prompt)].name) + "\"";
  }
  if (key.required) line += "; must be given";
  if (!key.standard.empty()) line += "; " + Text(key.standard) + " if not given";
  return line;
}

std::string CommandSection(const Command& c) {
  std::string out = "### " + Text(c.words) + "\n\n" + Text(c.summary) + "\n\n";
  if (!IsThere(c))
    return out + "Part of the language; not carried out by this version (E0001).\n\n";
  out += MannerOf(c) + "\n\n";
  if (!c.options.empty()) out += "Words: " + Words(c.options) + ".\n\n";
  if (!c.asks.empty())
    out += "Asks for a " + Text(c.asks) + ", written as a bare word or number.\n\n";
  if (!c.string_key.empty()) out += "A bare string is its `" + Text(c.string_key) + "`.\n\n";
  for (const interp::Key& key : c.keys) out += "- " + KeyLine(key, c) + "\n";
  if (!c.keys.empty()) out += "\n";
  for (const interp::Example& example : c.examples) {
    out += "```trn\n" + Text(example.script) + "\n" +
           (example.expect.starts_with("E0") || example.expect.starts_with("W0")
                ? "# gives " + Text(example.expect)
                : "assert " + Text(example.expect)) +
           "\n```\n\n";
  }
  return out;
}

template <class F>
void ForEachFamily(F&& f) {
  std::vector<std::string_view> families;
  for (const Command& c : interp::AllCommands()) {
    if (std::find(families.begin(), families.end(), c.family) == families.end())
      families.push_back(c.family);
  }
  for (std::string_view family : families) f(family);
}

// Backticks and emphasis taken away, for a terminal.
std::string Plain(std::string text) {
  std::string out;
  for (char c : text) {
    if (c != '`') out += c;
  }
  return out;
}

}  // namespace

std::string HelpOf(const Command& c) {
  std::string out = Text(c.words) + "\n  " + Text(c.summary) + "\n\n";
  if (!IsThere(c))
    return out + "  Part of the language; not carried out by this version (E0001).\n";
  out += "  " + Plain(MannerOf(c)) + "\n";
  if (!c.options.empty()) out += "  Words: " + Plain(Words(c.options)) + "\n";
  if (!c.asks.empty()) out += "  Asks for a " + Text(c.asks) + ".\n";
  for (const interp::Key& key : c.keys) out += "    " + Plain(KeyLine(key, c)) + "\n";
  for (const interp::Example& example : c.examples) {
    if (example.expect.starts_with("E0")) continue;
    out += "\n  Example:\n";
    std::string line = "    ";
    for (char ch : example.script) {
      line += ch;
      if (ch == '\n') line += "    ";
    }
    out += line + "\n";
  }
  return out;
}

std::string CommandList() {
  std::string out;
  ForEachFamily([&](std::string_view family) {
    out += Text(family) + "\n";
    for (const Command& c : interp::AllCommands()) {
      if (c.family != family) continue;
      out += "  " + Pad(Text(c.words), 30) + Text(c.summary) +
             (IsThere(c) ? "" : " (not there yet)") + "\n";
    }
  });
  return out;
}

std::string FunctionList() {
  std::string out;
  for (const interp::Builtin& row : interp::AllBuiltins()) {
    out += "  " + Pad(Text(row.usage), 30) + Text(row.summary) + "\n";
  }
  return out;
}

std::string SettingList() {
  std::string out;
  for (const interp::SettingRow& row : interp::AllSettings()) {
    out += "  " + Pad(Text(row.key) + "=", 10) + Text(row.summary) +
           (row.standard.empty() ? "" : " (" + Text(row.standard) + " at the start)") + "\n";
  }
  return out;
}

std::string Reference() {
  std::string out =
      "# Reference\n\nGenerated by `tranos docs` from the tables of the program; a test fails when "
      "it is stale.\n"
      "The language itself is told in [language.md](language.md).\n\n## Data points\n\n";
  for (const interp::PointKeyRow& row : interp::AllPointKeys())
    out += "- `" + Text(row.key) + "=` " + Text(row.summary) + "\n";
  out += "\n## Settings\n\n| key | what it sets | at the start |\n|---|---|---|\n";
  for (const interp::SettingRow& row : interp::AllSettings()) {
    std::string summary = Text(row.summary);
    if (!row.words.empty()) summary += ": " + Words(row.words);
    out += "| `" + Text(row.key) + "=` | " + summary + " | " + Text(row.standard) + " |\n";
  }
  out += "\n## Commands\n\n";
  ForEachFamily([&](std::string_view family) {
    for (const Command& c : interp::AllCommands()) {
      if (c.family == family) out += CommandSection(c);
    }
  });
  out += "## Functions\n\n| function | what it gives |\n|---|---|\n";
  for (const interp::Builtin& row : interp::AllBuiltins())
    out += "| `" + Text(row.usage) + "` | " + Text(row.summary) + " |\n";
  out +=
      "\n## Diagnostics\n\n`tranos explain CODE` tells more.\n\n| code | situation |\n|---|---|\n";
  for (interp::Code code : interp::AllCodes()) {
    out +=
        "| " + Text(interp::InfoOf(code).code) + " | " + Text(interp::InfoOf(code).title) + " |\n";
  }
  return out;
}

}  // namespace tranos::app
