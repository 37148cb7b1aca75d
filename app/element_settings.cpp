// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/element_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "interp/run.h"

namespace tranos::app {

namespace {

using interp::DefinedParameter;
using interp::Definition;
using interp::Type;
using model::Value;
using Failed = tl::unexpected<std::string>;

constexpr std::string_view kDetail = "detail";

// In which SI unit a number of this type is written; null for what is no number.
const char* UnitOf(Type type) {
  switch (type) {
    case Type::kNumber:
    case Type::kCount:
      return "";
    case Type::kLength:
      return "m";
    case Type::kArea:
      return "m2";
    case Type::kVolume:
      return "m3";
    case Type::kAngle:
      return "rad";
    default:
      return nullptr;
  }
}

bool HasChoice(const DefinedParameter& parameter) {
  return parameter.type == Type::kWord || parameter.type == Type::kBoolean ||
         UnitOf(parameter.type) != nullptr;
}

// The value of an expression after these statements.
tl::expected<Value, std::string> Evaluate(const std::string& statements, const std::string& text) {
  const std::string kName = "evaluated_here";
  const interp::ScriptResult result = interp::RunScript(
      "parameters", statements + "let " + kName + " = " + text + "\n", {}, {}, {});
  if (result.diagnostics.has_errors())
    return Failed("`" + text + "`: " + result.diagnostics.list().front().message);
  for (const auto& [name, value] : result.outcome.lets) {
    if (name == kName) return value;
  }
  return Failed("`" + text + "` has no value");
}

// A number as the parameter's type takes it, in SI: a bare one is in metres, or degrees.
double InSi(double number, model::Dimension dimension, Type type) {
  return number * (dimension.plain() && type == Type::kAngle ? geom::kPi / 180 : 1);
}

// Somewhere within, written short enough to be read where that is still within.
std::string Within(double low, double high, Pick pick, const DefinedParameter& parameter,
                   Draws* draws) {
  const std::string unit = UnitOf(parameter.type);
  if (parameter.type == Type::kCount) {
    low = std::ceil(low);
    high = std::floor(high);
  }
  if (pick == Pick::kLow) return fmt::format("{}{}", low, unit);
  if (pick == Pick::kHigh) return fmt::format("{}{}", high, unit);
  if (parameter.type == Type::kCount) {
    const auto steps = static_cast<std::size_t>(high - low) + 1;
    return fmt::format("{}", low + static_cast<double>(draws->Below(steps)));
  }
  const double exact = low + draws->UpToOne() * (high - low);
  const std::string brief = fmt::format("{:.5g}", exact);
  const double read = std::stod(brief);
  return (read >= low && read <= high ? brief : fmt::format("{}", exact)) + unit;
}

// One value out of what the parameter's range evaluated to: a range, or a list of alternatives.
tl::expected<std::string, std::string> OneOf(const Value& choices, Pick pick,
                                             const DefinedParameter& parameter, Draws* draws) {
  const auto& items = choices.list();
  if (items.size() == 1 && items[0].kind() == Value::Kind::kRange) {
    const model::ValueRange& range = items[0].range();
    const double low = InSi(range.from, items[0].dimension(), parameter.type);
    const double high = InSi(range.to, items[0].dimension(), parameter.type);
    if (!(low <= high)) return Failed("the range of `" + parameter.name + "` is empty");
    return Within(low, high, pick, parameter, draws);
  }
  if (items.empty()) return Failed("the range of `" + parameter.name + "` is empty");
  const std::size_t index = pick == Pick::kLow    ? 0
                            : pick == Pick::kHigh ? items.size() - 1
                                                  : draws->Below(items.size());
  if (!items[index].is_number())
    return Failed("the range of `" + parameter.name + "` is neither a range nor numbers");
  return fmt::format("{}{}", InSi(items[index].number(), items[index].dimension(), parameter.type),
                     UnitOf(parameter.type));
}

std::string WordOf(const DefinedParameter& parameter, Pick pick, Draws* draws) {
  const std::vector<std::string> words = parameter.type == Type::kBoolean
                                             ? std::vector<std::string>{"false", "true"}
                                             : interp::SplitWords(parameter.words);
  if (pick == Pick::kLow) return words.front();
  if (pick == Pick::kHigh) return words.back();
  return words[draws->Below(words.size())];
}

// The text of a value for this parameter.
tl::expected<std::string, std::string> Drawn(const DefinedParameter& parameter, Pick pick,
                                             const std::string& before, Draws* draws) {
  if (!UnitOf(parameter.type)) return WordOf(parameter, pick, draws);
  const auto choices = Evaluate(before, "[" + parameter.range + "]");
  if (!choices) return Failed(choices.error());
  if (!parameter.list) return OneOf(*choices, pick, parameter, draws);
  const auto standard = Evaluate(before, parameter.standard);
  if (!standard) return Failed(standard.error());
  std::string text;
  const std::size_t count = standard->is_list() ? standard->list().size() : 1;
  for (std::size_t i = 0; i < count; ++i) {
    const auto item = OneOf(*choices, pick, parameter, draws);
    if (!item) return item;
    text += (text.empty() ? "[" : ", ") + *item;
  }
  return text + "]";
}

}  // namespace

double Draws::UpToOne() {
  state_ += 0x9e3779b97f4a7c15;
  std::uint64_t bits = state_;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111eb;
  return std::ldexp(static_cast<double>((bits ^ (bits >> 31)) >> 11), -53);
}

std::size_t Draws::Below(std::size_t count) {
  return static_cast<std::size_t>(UpToOne() * static_cast<double>(count));
}

std::vector<std::string> RangesMissing(const Definition& element) {
  std::vector<std::string> names;
  for (const DefinedParameter& parameter : element.parameters) {
    if (UnitOf(parameter.type) && parameter.range.empty()) names.push_back(parameter.name);
  }
  return names;
}

std::vector<std::string> DetailsOf(const Definition& element) {
  for (const DefinedParameter& parameter : element.parameters) {
    if (parameter.name == kDetail) return interp::SplitWords(parameter.words);
  }
  return {""};
}

std::vector<std::vector<Pick>> CornersOf(const Definition& element) {
  const std::size_t count = element.parameters.size();
  std::vector<std::vector<Pick>> corners;
  for (const Pick pick : {Pick::kStandard, Pick::kLow, Pick::kHigh})
    corners.emplace_back(count, pick);
  for (std::size_t i = 0; i < count; ++i) {
    if (element.parameters[i].name == kDetail || !HasChoice(element.parameters[i])) continue;
    for (const Pick pick : {Pick::kLow, Pick::kHigh}) {
      corners.emplace_back(count, Pick::kStandard);
      corners.back()[i] = pick;
    }
  }
  return corners;
}

tl::expected<std::string, std::string> PlacementOf(const Definition& element,
                                                   const std::vector<Pick>& picks,
                                                   const std::string& detail, Draws* draws) {
  std::string line = element.words;
  std::string before;  // the parameters so far, as lets
  for (std::size_t i = 0; i < element.parameters.size(); ++i) {
    const DefinedParameter& parameter = element.parameters[i];
    const bool is_word = parameter.type == Type::kWord;
    std::string text = parameter.standard;
    bool is_given = true;
    if (parameter.name == kDetail) {
      text = detail;
    } else if (picks[i] != Pick::kStandard && HasChoice(parameter)) {
      auto drawn = Drawn(parameter, picks[i], before, draws);
      if (!drawn) return Failed("`" + element.words + "`: " + drawn.error());
      text = *std::move(drawn);
    } else {
      is_given = false;
    }
    if (is_given) line += " " + parameter.name + "=" + text;
    if (!text.empty())
      before += "let " + parameter.name + " = " + (is_word ? "\"" + text + "\"" : text) + "\n";
  }
  return line + " xy=0,0,0 as it";
}

}  // namespace tranos::app
