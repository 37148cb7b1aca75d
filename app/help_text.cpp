// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/help_text.h"

#include <algorithm>
#include <vector>

#include "app/command_text.h"
#include "app/wrap.h"
#include "interp/functions.h"
#include "interp/program.h"

namespace tranos::app {

namespace {

using interp::Command;

constexpr std::size_t kWords = 26;    // columns of a command's words in a list
constexpr std::size_t kExamples = 2;  // shown of a command

std::string Text(std::string_view text) { return std::string(text); }

std::string Row(std::string_view name, std::size_t width, std::string_view text) {
  return Wrap("  " + Text(name), width + 4, text);
}

template <class F>
std::string CommandRows(F&& wanted) {
  std::string out;
  std::string later;
  for (const Command& c : interp::AllCommands()) {
    if (!wanted(c)) continue;
    if (c.exists())
      out += Row(c.words, kWords, c.summary);
    else
      later += (later.empty() ? "" : ", ") + Text(c.words);
  }
  if (!later.empty()) out += Wrap("", 2, "not in this version yet: " + later);
  return out;
}

std::string ExampleText(const interp::Example& example) {
  std::string out = "    ";
  for (char c : example.script) out += c == '\n' ? "\n    " : std::string(1, c);
  return out + "\n    # then " + Text(example.expect) + "\n";
}

// The shortest tell most.
std::string Examples(const Command& c) {
  std::vector<const interp::Example*> shown;
  for (const interp::Example& example : c.examples) {
    if (!example.expect.starts_with("E0") && !example.expect.starts_with("W0"))
      shown.push_back(&example);
  }
  std::stable_sort(shown.begin(), shown.end(), [](const auto* a, const auto* b) {
    return a->script.size() < b->script.size();
  });
  shown.resize(std::min(shown.size(), kExamples));
  std::string out;
  for (const interp::Example* example : shown) out += "\n" + ExampleText(*example);
  return out;
}

// Those that begin with the same words, or with all but the last.
std::string Relatives(const Command& c) {
  const std::string_view stem = c.words.substr(0, std::min(c.words.rfind(' '), c.words.size()));
  const bool wide = stem.find(' ') == stem.npos;
  std::string out;
  for (const Command& other : interp::AllCommands()) {
    if (&other == &c || !other.exists()) continue;
    const bool longer = other.words.starts_with(Text(c.words) + " ");
    const bool sister = !wide && (other.words == stem || other.words.starts_with(Text(stem) + " "));
    if (longer || sister) out += (out.empty() ? "" : ", ") + Text(other.words);
  }
  return out;
}

bool Speaks(std::string_view text, const std::string& word) {
  std::string lower(text);
  for (char& ch : lower) {
    if (ch >= 'A' && ch <= 'Z') ch = static_cast<char>(ch + 32);
  }
  return lower.find(word) != std::string::npos;
}

}  // namespace

std::string HelpOf(const Command& c) {
  std::string out = Text(c.words) + "\n" + Wrap("", 2, c.summary);
  if (!c.exists())
    return out + "\n  Part of the language; not carried out by this version (E0001).\n";
  out += "\n" + Wrap("", 2, MannerOf(c));
  if (!c.options.empty()) out += Wrap("", 2, "Words: " + QuotedWords(c.options) + ".");
  if (!c.asks.empty())
    out += Wrap("", 2, "Asks for a " + Text(c.asks) + ", written as a bare word or number.");
  if (!c.string_key.empty())
    out += Wrap("", 2, "A bare string is its `" + Text(c.string_key) + "`.");
  if (!c.keys.empty()) out += "\n";
  std::size_t width = 0;
  for (const interp::Key& key : c.keys) width = std::max(width, key.name.size() + 1);
  for (const interp::Key& key : c.keys) out += Row(Text(key.name) + "=", width, TellKey(key, c));
  out += Examples(c);
  if (const std::string relatives = Relatives(c); !relatives.empty())
    out += "\n" + Wrap("  See also", 12, relatives);
  return out;
}

std::string CommandList() {
  std::string out;
  for (std::string_view family : Families()) {
    out += Text(family) + "\n" + CommandRows([&](const Command& c) { return c.family == family; }) +
           "\n";
  }
  return out;
}

std::string CommandsFrom(const std::string& beginning) {
  return CommandRows([&](const Command& c) { return c.words.starts_with(beginning + " "); });
}

std::string CommandsAbout(const std::string& word) {
  std::string out = CommandRows(
      [&](const Command& c) { return Speaks(c.words, word) || Speaks(c.summary, word); });
  for (const interp::Builtin& row : interp::AllBuiltins()) {
    if (Speaks(row.usage, word) || Speaks(row.summary, word))
      out += Row(row.usage, kWords, row.summary);
  }
  return out;
}

std::string StatementList() {
  std::string out;
  for (const Statement& row : AllStatements())
    out += "  " + Text(row.usage) + "\n" + Wrap("", 6, row.summary);
  return out;
}

std::string PointList() {
  std::string out;
  for (const interp::PointKeyRow& row : interp::AllPointKeys())
    out += Row(Text(row.key) + "=", 4, row.summary);
  return out;
}

std::string SettingList() {
  std::string out;
  for (const interp::SettingRow& row : interp::AllSettings()) {
    std::string summary = Text(row.summary);
    if (!row.words.empty()) summary += ": " + QuotedWords(row.words);
    if (!row.standard.empty()) summary += " (" + Text(row.standard) + " at the start)";
    out += Row(Text(row.key) + "=", 8, summary);
  }
  return out;
}

std::string FunctionList() {
  std::string out;
  for (const interp::Builtin& row : interp::AllBuiltins()) out += Row(row.usage, 22, row.summary);
  return out;
}

std::string HelpOfWord(const std::string& word) {
  for (const Statement& row : AllStatements()) {
    if (row.word == word) return Text(row.usage) + "\n" + Wrap("", 2, row.summary);
  }
  if (const interp::SettingRow* row = interp::FindSetting(word)) {
    std::string summary = Text(row->summary);
    if (!row->words.empty()) summary += ": " + QuotedWords(row->words);
    if (!row->standard.empty()) summary += " (" + Text(row->standard) + " at the start)";
    return Text(row->key) + "=\n" + Wrap("", 2, summary);
  }
  if (const interp::PointKeyRow* row = interp::FindPointKey(word)) {
    return Text(row->key) + "=\n" + Wrap("", 2, row->summary);
  }
  if (const int found = interp::FindBuiltin(word); found >= 0) {
    const interp::Builtin& row = interp::AllBuiltins()[static_cast<std::size_t>(found)];
    return Text(row.usage) + "\n" + Wrap("", 2, row.summary);
  }
  return "";
}

}  // namespace tranos::app
