// SPDX-License-Identifier: GPL-3.0-or-later
// A difference as text and as JSON.
#include <algorithm>
#include <array>
#include <charconv>

#include "interp/diagnostic.h"
#include "session/difference.h"
#include "session/json_text.h"

namespace tranos::session {

namespace {

constexpr std::array<std::string_view, 4> kWords = {"added", "removed", "moved", "changed"};

// Nine significant digits: what differs by less is told as equal by the hashes.
std::string Digits(double number) {
  char buffer[64];
  const auto [end, error] =
      std::to_chars(buffer, buffer + sizeof buffer, number + 0.0, std::chars_format::general, 9);
  return std::string(buffer, end);
}

std::string PlaceText(const std::optional<SourcePlace>& place) {
  if (!place) return "";
  std::string out = interp::Printable(place->path) + ":" + std::to_string(place->line);
  for (std::size_t i = 0; i < place->turns.size(); ++i) {
    out += (i == 0 ? " turn " : ", ") + interp::Printable(place->turns[i]);
  }
  return out;
}

std::string Value(const std::string& text) {
  return text.empty() ? "none" : interp::Printable(text);
}

void AddMeasure(std::string_view name, std::string_view unit, const std::optional<double>& before,
                const std::optional<double>& after, std::string* out) {
  const std::string x = before ? Digits(*before) : "none", y = after ? Digits(*after) : "none";
  if (x == y) return;
  *out += (out->empty() ? "" : ", ") + std::string(name) + " " + x + " -> " + y +
          (after ? " " + std::string(unit) : "");
}

std::string Line(const ElementChange& change) {
  std::string line(kWords[change.kind]);
  line.resize(9, ' ');
  line += (change.in_group ? "  " : "") + interp::Printable(change.type);
  if (!change.name.empty()) line += " `" + interp::Printable(change.name) + "`";
  if (change.by_m) {
    const geom::Vec3& by = *change.by_m;
    line += " by (" + Digits(by.x()) + ", " + Digits(by.y()) + ", " + Digits(by.z()) + ") m";
  } else if (change.largest_m && *change.largest_m > 0) {
    line += " by up to " + Digits(*change.largest_m) + " m";
  }
  std::string what;
  for (const ParameterChange& parameter : change.parameters) {
    what += (what.empty() ? "" : ", ") + interp::Printable(parameter.name) + " " +
            Value(parameter.before) + " -> " + Value(parameter.after);
  }
  if (change.kind == ElementChange::kMoved || change.kind == ElementChange::kChanged) {
    AddMeasure("length", "m", change.before.length_m, change.after.length_m, &what);
    AddMeasure("area", "m2", change.before.area_m2, change.after.area_m2, &what);
    AddMeasure("volume", "m3", change.before.volume_m3, change.after.volume_m3, &what);
  }
  if (!what.empty()) line += ": " + what;
  const std::string before = PlaceText(change.place_before), after = PlaceText(change.place_after);
  line += "  [" + before + (before.empty() || after.empty() || before == after ? "" : " -> ") +
          (before == after ? "" : after) + "]";
  return line + "\n";
}

void WriteMeasures(const Measures& measures, JsonText* out) {
  out->Open('{');
  for (const auto& [key, value] : {std::pair{"length", measures.length_m},
                                   {"area", measures.area_m2},
                                   {"volume", measures.volume_m3}}) {
    out->Key(key);
    value ? out->Number(*value) : out->Null();
  }
  out->Close('}');
}

void WritePlace(std::string_view key, const std::optional<SourcePlace>& place, JsonText* out) {
  out->Key(key);
  if (!place) {
    out->Null();
    return;
  }
  out->Open('{').Key("path").String(place->path).Key("line").Integer(place->line);
  out->Key("turns").Open('[');
  for (const std::string& turn : place->turns) out->String(turn);
  out->Close(']').Close('}');
}

void WriteText(std::string_view key, const std::string& text, JsonText* out) {
  out->Key(key);
  text.empty() ? out->Null() : out->String(text);
}

void Write(const ElementChange& change, JsonText* out) {
  out->Open('{').Key("change").String(kWords[change.kind]);
  WriteText("name", change.name, out);
  out->Key("type").String(change.type).Key("in_group").Boolean(change.in_group);
  WritePlace("place_before", change.place_before, out);
  WritePlace("place_after", change.place_after, out);
  out->Key("largest_m");
  change.largest_m ? out->Number(*change.largest_m) : out->Null();
  out->Key("by_m");
  change.by_m ? out->Point(*change.by_m) : out->Null();
  out->Key("parameters").Open('[');
  for (const ParameterChange& parameter : change.parameters) {
    out->Open('{').Key("name").String(parameter.name);
    WriteText("before", parameter.before, out);
    WriteText("after", parameter.after, out);
    out->Close('}');
  }
  out->Close(']').Key("measures_before");
  change.kind == ElementChange::kAdded ? static_cast<void>(out->Null())
                                       : WriteMeasures(change.before, out);
  out->Key("measures_after");
  change.kind == ElementChange::kRemoved ? static_cast<void>(out->Null())
                                         : WriteMeasures(change.after, out);
  out->Close('}');
}

}  // namespace

std::string RenderText(const Difference& difference) {
  if (difference.changes.empty()) return "no difference in effect\n";
  std::string out;
  std::array<std::size_t, 4> counts{};
  for (const ElementChange& change : difference.changes) {
    out += Line(change);
    ++counts[change.kind];
  }
  for (std::size_t kind = 0; kind < counts.size(); ++kind) {
    out += (kind ? ", " : "") + std::to_string(counts[kind]) + " " + std::string(kWords[kind]);
  }
  return out + ", " + std::to_string(difference.equal) + " equal\n";
}

std::string RenderJson(const Difference& difference) {
  JsonText out;
  out.Open('{').Key("equal").Integer(difference.equal).Key("changes").Open('[');
  for (const ElementChange& change : difference.changes) Write(change, &out);
  out.Close(']').Close('}');
  return out.text() + "\n";
}

}  // namespace tranos::session
