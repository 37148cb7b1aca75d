// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report.h"
#include "app/camera_json.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "model/covariance.h"

namespace tranos::app {

namespace {

using nlohmann::ordered_json;

ordered_json Number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json BoxJson(const geom::Box& box) {
  if (box.empty()) return nullptr;
  return {{"min", {box.min.x(), box.min.y(), box.min.z()}},
          {"max", {box.max.x(), box.max.y(), box.max.z()}}};
}

ordered_json Text(std::string_view text) {
  return text.empty() ? ordered_json(nullptr) : ordered_json(text);
}

// Of a drawn point, in m²: null where nothing of it is uncertain.
ordered_json CovarianceJson(const model::Element& element) {
  const auto covariance = model::CovarianceOf(element);
  if (!covariance) return nullptr;
  ordered_json rows = ordered_json::array();
  for (const auto& row : covariance->rowwise()) rows.push_back({row[0], row[1], row[2]});
  return rows;
}

ordered_json ElementJson(const model::Element& element, model::ElementId parent) {
  return {{"id", element.id},
          {"name", Text(element.name_or_empty())},
          {"type", model::TypeOf(element)},
          {"level", element.attributes->level},
          {"evidence", Text(model::WordOf(element.attributes->evidence))},
          {"source", Text(element.attributes->source)},
          {"parent", parent == model::kNoElement ? ordered_json(nullptr) : ordered_json(parent)},
          {"bbox", BoxJson(model::BoundingBox(element))},
          {"length", Number(model::Length(element))},
          {"area", Number(model::Area(element))},
          {"volume", Number(model::Volume(element))},
          {"covariance", CovarianceJson(element)},
          {"hash", model::Hex(element.hash)}};
}

// The element, and a group's members after it, each with its parent.
template <class F>
void ForEachBelow(const model::Element& element, model::ElementId parent, F&& f) {
  f(element, parent);
  if (const auto* group = std::get_if<model::GroupPtr>(&element.geometry)) {
    for (const model::ElementPtr& member : (*group)->members) ForEachBelow(*member, element.id, f);
  }
}

template <class F>
void ForEachListed(const model::Model& model, F&& f) {
  model.ForEach(
      [&](const model::ElementPtr& element) { ForEachBelow(*element, model::kNoElement, f); });
}

ordered_json AssertJson(const interp::AssertResult& assertion, const interp::Sources& sources) {
  const auto& source = sources.files[assertion.span.file];
  const auto place = source.PlaceOf(assertion.span.begin);
  return {{"text", assertion.text},
          {"message", Text(assertion.message)},
          {"value", assertion.value},
          {"expected", assertion.expected},
          {"passed", assertion.passed},
          {"span",
           {{"path", source.path},
            {"line", place.line},
            {"column", place.column},
            {"begin", assertion.span.begin},
            {"end", assertion.span.end}}}};
}

// A list of the report, printed entry by entry.
class JsonList {
 public:
  explicit JsonList(const char* name) { PrintOut("  \"" + std::string(name) + "\": ["); }
  void Add(const ordered_json& entry) {
    PrintOut((any_ ? ",\n    " : "\n    ") +
             entry.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
    any_ = true;
  }
  void End(bool last = false) {
    PrintOut(any_ ? "\n  ]" : "]");
    PrintOut(last ? "\n}\n" : ",\n");
  }

 private:
  bool any_ = false;
};

bool BeginsCharacter(char c) { return (c & 0xC0) != 0x80; }

// Padded or cut to a width in characters, with a space before the next cell.
std::string Cell(std::string text, std::size_t width, bool right) {
  auto columns = static_cast<std::size_t>(std::count_if(text.begin(), text.end(), BeginsCharacter));
  if (columns >= width) {
    for (; columns > width - 2; --columns) {
      while (!BeginsCharacter(text.back())) text.pop_back();
      text.pop_back();
    }
    text += "…";
    ++columns;
  }
  const std::string space(width - columns, ' ');
  return right ? space + text : text + space;
}

std::string Measure(const std::optional<double>& value, const char* unit) {
  if (!value) return "";
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.4f %s", *value, unit);
  return buffer;
}

}  // namespace

void PrintJson(const ScriptRun& run, const std::vector<OutputFile>& outputs) {
  const model::Model& model = run.result.outcome.state.model;
  // A million elements are printed one by one.
  PrintOut("{\n  \"status\": " + std::to_string(run.status) + ",\n  \"model_hash\": " +
           (run.made_model() ? "\"" + model::Hex(model.hash) + "\"" : "null") + ",\n");
  JsonList elements("elements");
  if (run.made_model())
    ForEachListed(model, [&](auto&... listed) { elements.Add(ElementJson(listed...)); });
  elements.End();
  JsonList files("outputs");
  for (const OutputFile& file : outputs) files.Add({{"path", file.path}, {"bytes", file.bytes}});
  files.End();
  JsonList asserts("asserts");
  for (const interp::AssertResult& assertion : run.result.outcome.asserts) {
    asserts.Add(AssertJson(assertion, *run.result.sources));
  }
  asserts.End();
  JsonList cameras("cameras");
  model.ForEach([&](const model::ElementPtr& element) {
    const auto* photograph = std::get_if<model::PhotographPtr>(&element->geometry);
    if (run.made_model() && photograph && (*photograph)->estimate) {
      cameras.Add(CameraJson(*element, **photograph));
    }
  });
  cameras.End();
  JsonList diagnostics("diagnostics");
  for (const interp::Diagnostic& diagnostic : run.result.diagnostics.list()) {
    diagnostics.Add(ordered_json::parse(interp::RenderJson(diagnostic, *run.result.sources)));
  }
  diagnostics.End(true);
}

void PrintTable(const ScriptRun& run) {
  const model::Model& model = run.result.outcome.state.model;
  PrintOut(Cell("id", 6, true) + "  " + Cell("name", 20, false) + Cell("type", 18, false) +
           Cell("level", 10, false) + Cell("evidence", 12, false) + Cell("length", 16, true) +
           Cell("area", 18, true) + Cell("volume", 18, true) + "\n");
  ForEachListed(model, [](const model::Element& element, model::ElementId parent) {
    const std::string indent = parent == model::kNoElement ? "" : "· ";
    PrintOut(Cell(std::to_string(element.id), 6, true) + "  " +
             Cell(indent + interp::Printable(element.name_or_empty()), 20, false) +
             Cell(interp::Printable(model::TypeOf(element)), 18, false) +
             Cell(interp::Printable(element.attributes->level), 10, false) +
             Cell(std::string(model::WordOf(element.attributes->evidence)), 12, false) +
             Cell(Measure(model::Length(element), "m"), 16, true) +
             Cell(Measure(model::Area(element), "m2"), 18, true) +
             Cell(Measure(model::Volume(element), "m3"), 18, true) + "\n");
  });
  PrintOut(std::to_string(model.live) + (model.live == 1 ? " element" : " elements") +
           ", model hash " + model::Hex(model.hash) + "\n");
}

}  // namespace tranos::app
