// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/gallery.h"

#include "app/element_settings.h"
#include "app/element_text.h"
#include "output/plan_svg.h"
#include "output/write.h"

namespace tranos::app {

namespace {

using interp::Definition;

constexpr int kWidth_px = 320, kHeight_px = 240;
constexpr int kPlan_px = 160;
constexpr std::string_view kFolder = "gallery/";

constexpr std::string_view kHead =
    "# The library\n\nEvery element of the standard library at its defaults: its picture and its "
    "plan symbol, the "
    "line that placed it, its parameters. No script needs a `use` for it. "
    "[stdlib/README.md](../stdlib/README.md) tells what all of them keep to; `tranos help place "
    "dome cruciform` tells the same on a terminal. This page is made by `./dev gallery`.\n";

std::string Cell(std::string_view text) {
  std::string out;
  for (char c : text) out += c == '|' ? "\\|" : std::string(1, c);
  return out;
}

// In a link's target and in a heading's anchor alike.
std::string AnchorOf(const std::string& words) {
  std::string anchor = words;
  for (char& c : anchor) {
    if (c == ' ') c = '-';
  }
  return anchor;
}

// Runs one line; `problem` tells what went wrong.
interp::ScriptResult Placed(const std::string& line, std::string* problem) {
  interp::ScriptResult result = interp::RunScript("gallery", line, {}, {}, {});
  if (result.diagnostics.has_errors())
    *problem = interp::RenderText(result.diagnostics.list().front(), *result.sources, false);
  return result;
}

std::string LineOf(const std::string& words) { return words + " xy=0,0,0"; }

std::string Parameters(const Definition& element) {
  std::string out = "| parameter | |\n|---|---|\n";
  for (const interp::DefinedParameter& parameter : element.parameters)
    out += "| `" + parameter.name + "` | " + Cell(TellParameter(parameter)) + " |\n";
  return out;
}

// Its place in the page, and its plan.
std::string Show(const BoundFamily& family, const Definition& element, GalleryElement* shown,
                 std::vector<std::string>* problems) {
  const std::string file = std::string(kFolder) + FileNameOf(element.words);
  *shown = {element.words, file + ".png", file + ".svg", ""};
  std::string problem;
  const interp::ScriptResult whole = Placed(LineOf(element.words), &problem);
  const interp::ScriptResult plan = Placed(element.words + " detail=plan xy=0,0,0", &problem);
  const auto svg = output::PlanSvgOf(plan.outcome.state.model, kPlan_px);
  if (svg) shown->plan = *svg;
  if (!svg) problem = svg.error().message;
  if (!problem.empty()) problems->push_back("`" + element.words + "`: " + problem);
  std::string out = "\n### " + element.words + "\n\n" + element.summary + "\n\n";
  out += "![" + element.words + "](" + shown->picture_file + ") ![its plan](" + shown->plan_file +
         ")\n\n```trn\n" + LineOf(element.words) + "\n```\n\n" + Parameters(element);
  const auto add = [&](std::string_view head, const std::string& text) {
    if (!text.empty()) out += "\n" + std::string(head) + ": " + text + ".\n";
  };
  add("Interfaces", TellInterfaces(element));
  add("Parts", TellParts(family, element));
  std::string facts;
  for (const std::string& fact : FactsOf(StandardElements(), element))
    facts += (facts.empty() ? "" : "; ") + fact;
  add("Held to", facts);
  return out + "\n<!-- shows " + model::Hex(whole.outcome.state.model.hash) + " -->\n";
}

}  // namespace

Gallery MakeGallery() {
  Gallery gallery;
  std::string contents, shows;
  for (const interp::LibraryFamily& each : interp::StandardLibrary().families()) {
    const BoundFamily family = BindLibraryFamily(StandardElements(), each);
    contents += "\n- " + each.name + ":";
    shows += "\n## " + each.name + "\n";
    for (const Definition* element : family.elements) {
      contents += " [" + element->words.substr(element->words.find(' ') + 1) + "](#" +
                  AnchorOf(element->words) + ")";
      shows += Show(family, *element, &gallery.elements.emplace_back(), &gallery.problems);
    }
  }
  gallery.page = std::string(kHead) + contents + "\n" + shows;
  return gallery;
}

tl::expected<std::string, std::string> PictureOf(const std::string& words, int threads) {
  std::string problem;
  model::RenderRequest request;
  request.model = Placed(LineOf(words), &problem).outcome.state.model;
  if (!problem.empty()) return tl::make_unexpected(problem);
  request.view = {
      .mode = model::RenderMode::kPhong, .antialias = true, .shadows = true, .direction = "iso"};
  request.width_px = kWidth_px;
  request.height_px = kHeight_px;
  auto bytes = output::PictureFileOf(request, threads);
  if (!bytes) return tl::make_unexpected(bytes.error().message);
  return *std::move(bytes);
}

}  // namespace tranos::app
