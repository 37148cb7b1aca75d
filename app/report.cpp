// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "model/element.h"

namespace tranos::app {

namespace {

using nlohmann::ordered_json;

ordered_json Number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json BoxJson(const geom::Box& box) {
  if (box.empty()) return nullptr;
  return {{"min", {box.min.x(), box.min.y(), box.min.z()}}, {"max", {box.max.x(), box.max.y(), box.max.z()}}};
}

ordered_json Text(std::string_view text) { return text.empty() ? ordered_json(nullptr) : ordered_json(text); }

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
          {"hash", model::Hex(element.hash)}};
}

// The element, and a group's members after it, each with its parent.
template <class F>
void ForEachListed(const model::Element& element, model::ElementId parent, F&& f) {
  f(element, parent);
  if (const auto* group = std::get_if<model::GroupPtr>(&element.geometry)) {
    for (const model::ElementPtr& member : (*group)->members) ForEachListed(*member, element.id, f);
  }
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

std::string Cell(std::string text, std::size_t width, bool right) {
  if (text.size() > width) text = text.substr(0, width - 1) + "~";
  const std::string space(width - text.size(), ' ');
  return right ? space + text : text + space;
}

std::string Measure(const std::optional<double>& value, const char* unit) {
  if (!value) return "";
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.4f %s", *value, unit);
  return buffer;
}

}  // namespace

std::string ReportJson(const ScriptRun& run, int status, const std::vector<OutputFile>& outputs) {
  ordered_json elements = ordered_json::array();
  const model::Model& model = run.result.outcome.state.model;
  if (status != kScriptIsWrong) {
    model.ForEach([&](const model::ElementPtr& element) {
      ForEachListed(*element, model::kNoElement, [&](const model::Element& listed, model::ElementId parent) {
        elements.push_back(ElementJson(listed, parent));
      });
    });
  }
  ordered_json files = ordered_json::array();
  for (const OutputFile& file : outputs) files.push_back({{"path", file.path}, {"bytes", file.bytes}});
  ordered_json asserts = ordered_json::array();
  ordered_json diagnostics = ordered_json::array();
  if (run.result.sources) {
    for (const interp::AssertResult& assertion : run.result.outcome.asserts) {
      asserts.push_back(AssertJson(assertion, *run.result.sources));
    }
    for (const interp::Diagnostic& diagnostic : run.result.diagnostics.list()) {
      diagnostics.push_back(ordered_json::parse(interp::RenderJson(diagnostic, *run.result.sources)));
    }
  }
  const ordered_json report = {{"status", status},
                               {"model_hash", model::Hex(model.hash)},
                               {"elements", std::move(elements)},
                               {"outputs", std::move(files)},
                               {"asserts", std::move(asserts)},
                               {"cameras", ordered_json::array()},
                               {"diagnostics", std::move(diagnostics)}};
  return report.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string ReportTable(const ScriptRun& run) {
  const model::Model& model = run.result.outcome.state.model;
  std::string out = Cell("id", 6, true) + "  " + Cell("name", 20, false) + Cell("type", 18, false) + Cell("level", 10, false) +
                    Cell("evidence", 12, false) + Cell("length", 16, true) + Cell("area", 18, true) +
                    Cell("volume", 18, true) + "\n";
  model.ForEach([&](const model::ElementPtr& top) {
    ForEachListed(*top, model::kNoElement, [&](const model::Element& element, model::ElementId parent) {
      const std::string indent = parent == model::kNoElement ? "" : "· ";
      out += Cell(std::to_string(element.id), 6, true) + "  " +
             Cell(indent + interp::Printable(element.name_or_empty()), indent.empty() ? 20 : 21, false) +
             Cell(model::TypeOf(element), 18, false) + Cell(element.attributes->level, 10, false) +
             Cell(std::string(model::WordOf(element.attributes->evidence)), 12, false) +
             Cell(Measure(model::Length(element), "m"), 16, true) + Cell(Measure(model::Area(element), "m2"), 18, true) +
             Cell(Measure(model::Volume(element), "m3"), 18, true) + "\n";
    });
  });
  out += std::to_string(model.live) + (model.live == 1 ? " element" : " elements") + ", model hash " + model::Hex(model.hash) + "\n";
  return out;
}

}  // namespace tranos::app
