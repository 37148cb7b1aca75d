// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/commands/solid_edges.h"

#include <fmt/format.h>

#include <algorithm>

#include "geom/solid.h"
#include "interp/commands/range.h"

namespace tranos::interp {

using geom::Solid;
using geom::SolidEdge;
using model::State;

namespace {

using Edges = std::vector<SolidEdge>;

// The edges to work on: all, or the one nearest to `at=`.
tl::expected<Edges, CommandError> EdgesOf(const Answers& answers, std::size_t chosen,
                                          const Solid& solid, std::string_view what) {
  const auto facets = solid.Facets();
  if (!facets) return Fail(FromGeom(facets.error(), what, AtChosen(chosen)));
  Edges edges = geom::SolidEdgesOf(**facets);
  if (edges.empty()) {
    return Fail({.code = Code::kWrongElement,
                 .message = fmt::format("{} is made along straight edges between flat faces, and "
                                        "{} has none",
                                        what, NameForMessage(*answers.chosen[chosen])),
                 .where = AtChosen(chosen)});
  }
  const std::optional<geom::Vec3> at = answers.Point("at");
  if (!at) return edges;
  return Edges{*std::min_element(edges.begin(), edges.end(), [&](const auto& a, const auto& b) {
    return geom::Distance(a, *at) < geom::Distance(b, *at);
  })};
}

// The size that does not fit, with the range that would along these edges.
std::optional<CommandError> TooLarge(const State& state, const Edges& edges, std::string_view what,
                                     const EdgeTool& tool) {
  const bool shared = edges.size() > 1;
  std::vector<EdgeTool::Size> least = tool.sizes(edges[0], shared);
  for (const SolidEdge& edge : edges) {
    const std::vector<EdgeTool::Size> sizes = tool.sizes(edge, shared);
    for (std::size_t i = 0; i < least.size(); ++i) {
      least[i].largest_m = std::min(least[i].largest_m, sizes[i].largest_m);
    }
  }
  for (const EdgeTool::Size& size : least) {
    if (size.size_m <= size.largest_m + geom::kCoincident_m) continue;
    return CommandError{.code = Code::kOutOfRange,
                        .message = fmt::format("{} of {} reaches across the faces beside {}", what,
                                               InWords(size.size_m, *state.drawing.settings),
                                               shared ? "the edges" : "the edge"),
                        .label = RangeInWords(size.largest_m, *state.drawing.settings),
                        .help = shared ? "`at=` works on the nearest edge alone" : "",
                        .where = AtKey(size.key)};
  }
  return std::nullopt;
}

tl::expected<Solid, CommandError> Worked(const Solid& solid, const Edges& edges,
                                         std::string_view what, const EdgeTool& tool,
                                         std::size_t chosen) {
  std::vector<Solid> filled = {solid}, cut;
  for (const SolidEdge& edge : edges) {
    auto mesh = tool.prism(edge);
    if (!mesh) return Fail(FromGeom(mesh.error(), what, AtChosen(chosen)));
    auto prism = Solid::FromMesh(*std::move(mesh));
    if (!prism) return Fail(FromGeom(prism.error(), what, AtChosen(chosen)));
    (edge.is_convex ? cut : filled).push_back(*std::move(prism));
  }
  return Solid::Difference(Solid::Union(std::move(filled)), std::move(cut));
}

}  // namespace

EdgeTool FilletOfEdges(const State& state, double radius_m) {
  const geom::Tolerance tolerance = state.drawing.settings->tolerance;
  return {[=](const SolidEdge& edge, bool shared) -> std::vector<EdgeTool::Size> {
            return {{"radius", radius_m, geom::LargestRadius(edge, shared)}};
          },
          [=](const SolidEdge& edge) { return geom::FilletPrism(edge, radius_m, tolerance); }};
}

EdgeTool ChamferOfEdges(double first_m, std::optional<double> second_m) {
  return {[=](const SolidEdge& edge, bool shared) -> std::vector<EdgeTool::Size> {
            const auto& room_m = shared ? edge.shared_room_m : edge.room_m;
            if (!second_m) return {{"distance", first_m, std::min(room_m[0], room_m[1])}};
            return {{"distance", first_m, room_m[0]}, {"second", *second_m, room_m[1]}};
          },
          [=](const SolidEdge& edge) {
            return geom::ChamferPrism(edge, first_m, second_m.value_or(first_m));
          }};
}

CommandResult WorkEdges(const State& state, const Answers& answers, std::string_view what,
                        const EdgeTool& tool) {
  Fired fired;
  for (std::size_t i = 0; i < answers.chosen.size(); ++i) {
    const auto* solid = std::get_if<model::SolidPtr>(&answers.chosen[i]->geometry);
    if (!solid) {
      return Fail({.code = Code::kWrongElement,
                   .message = fmt::format("{} is made of solids or of curves, not of both, and "
                                          "this is {}",
                                          what, NameForMessage(*answers.chosen[i])),
                   .where = AtChosen(i)});
    }
    const auto edges = EdgesOf(answers, i, **solid, what);
    if (!edges) return Fail(edges.error());
    if (auto error = TooLarge(state, *edges, what, tool)) return Fail(*error);
    auto worked = Worked(**solid, *edges, what, tool, i);
    if (!worked) return Fail(worked.error());
    fired.edit.replaced.push_back(
        model::WithGeometry(*answers.chosen[i], std::make_shared<const Solid>(*std::move(worked))));
  }
  return fired;
}

}  // namespace tranos::interp
