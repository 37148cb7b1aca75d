// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command_text.h"

#include <algorithm>

namespace tranos::app {

using interp::Command;
using interp::Manner;

namespace {

std::string Prompts(const Command& c) {
  std::string out;
  for (const interp::Prompt& prompt : c.prompts)
    out += (out.empty() ? "" : ", then ") + std::string(prompt.name);
  return out;
}

std::string PlacingManner(const Command& c) {
  const auto again = static_cast<std::size_t>(c.again);
  std::string out;
  if (c.prompts.empty()) {
    out = "Asks for no data point";
  } else {
    out = "Asks for " + Prompts(c);
    if (again < c.prompts.size()) {
      out += c.again > 0 ? "; then again from " + std::string(c.prompts[again].name)
                         : "; then begins anew";
    }
  }
  return out + (c.manner == Manner::kTransforms ? ". Works on `of=`, or on what is chosen." : ".");
}

}  // namespace

std::string MannerOf(const Command& c) {
  switch (c.manner) {
    case Manner::kImmediate:
      return "Asks for no data point; runs at the end of its statement.";
    case Manner::kPlaces:
    case Manner::kTransforms:
      return PlacingManner(c);
    case Manner::kGathers:
      return "Gathers data points, " + std::to_string(c.least) +
             " or more, and makes one element when it ends.";
    case Manner::kPicks:
      return "Takes `of=`, or what is chosen and picked by data points; a point farther than `lt` "
             "from everything, or "
             "the command's end, accepts.";
    case Manner::kEdits:
      return "Takes `of=`, or what is chosen, or picks by data points; a point farther than `lt` "
             "from everything "
             "accepts the picks.";
    case Manner::kChooses:
      return "Takes the nearest element within `lt` at each data point.";
  }
  return "";
}

std::string QuotedWords(std::string_view list) {
  std::string out;
  for (const std::string& word : interp::SplitWords(list))
    out += (out.empty() ? "`" : ", `") + word + "`";
  return out;
}

std::string TellKey(const interp::Key& key, const Command& c) {
  std::string out = key.type == interp::Type::kWord && !key.words.empty()
                        ? "one of " + QuotedWords(key.words)
                        : (key.list ? "a list, each " : "") + std::string(Describe(key.type));
  if (!key.summary.empty()) out += ": " + std::string(key.summary);
  if (key.prompt >= 0 && static_cast<std::size_t>(key.prompt) < c.prompts.size()) {
    out += "; in place of the point for \"" +
           std::string(c.prompts[static_cast<std::size_t>(key.prompt)].name) + "\"";
  }
  if (key.required) out += "; must be given";
  if (!key.standard.empty()) out += "; " + std::string(key.standard) + " if not given";
  return out;
}

std::vector<std::string_view> Families() {
  std::vector<std::string_view> families;
  for (const Command& c : interp::AllCommands()) {
    if (std::find(families.begin(), families.end(), c.family) == families.end())
      families.push_back(c.family);
  }
  return families;
}

const std::vector<Statement>& AllStatements() {
  static const std::vector<Statement> statements = {
      {"let", "let bay = 30m", "gives a value a name, once in its block"},
      {"as", "place line xy=0,0 xy=5,0 as sill", "names what a command made, and ends the command"},
      {"reset", "reset", "ends the active command"},
      {"parameter", "parameter height : length = 12m in 4m..40m",
       "a value that `-D height=14m` may set"},
      {"function", "function half(x) = x/2", "a function of your own"},
      {"define", "define place pier width : length = 1m { … }",
       "a command of your own, made of others"},
      {"interface", "interface crown at=[0,0,h] radius=3m",
       "within a definition: where others meet the element"},
      {"for", "for i = 0 to 7 { … }",
       "repeats; also `for i = 0 to 1m step 10cm`, `for x in list`, `for i, x in list`"},
      {"if", "if height > 6m { … } else { … }", "runs the one or the other"},
      {"group", "group as wing { … }", "binds what is made within into one element"},
      {"hypothesis", "hypothesis dome { … }",
       "alternatives that follow one another: `--hypothesis` names the one to run"},
      {"use", "use \"elements/local.trn\"",
       "takes the functions, definitions, units and lets of a file"},
      {"unit", "unit pechys = 0.648m", "a unit of your own"},
      {"unknown", "unknown depth = 14m",
       "a number that a photograph is to find; keeps its start without one"},
      {"assert", "assert nave.length within 35.5m +- 2% \"from the excavation\"",
       "checks; a failed one gives exit status 4, and everything is written all the same"},
  };
  return statements;
}

}  // namespace tranos::app
