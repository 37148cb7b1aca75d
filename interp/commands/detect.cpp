// SPDX-License-Identifier: GPL-3.0-or-later
// detect: the edges of a photograph, and which of them point along one direction, found without a
// hand. They become traces like those of a hand.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "camera/line_detection.h"
#include "camera/trace_checks.h"
#include "camera/vanishing_directions.h"
#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/commands/photographs.h"

namespace tranos::interp {

using geom::Vec2;
using model::ElementPtr;
using model::State;
using model::Trace;

namespace {

using Kind = Trace::Kind;

// Dots lie on a binary grid, which a script and a journal both hold to the last digit.
constexpr double kPerPixel = 256;
Vec2 Rounded(const Vec2& dot_px) {
  return (kPerPixel * dot_px).array().round().matrix() / kPerPixel;
}

// Of each coordinate of a dot; where it is to be estimated, deviations are in units of it.
double Unit(const Trace& trace) { return trace.noise_px > 0 ? trace.noise_px : 1; }

// The edges of a photograph, found once in a run: what stands before `calibrate` is run again and
// again, and a replay, which has no pixels, has them from its journal.
tl::expected<std::vector<FoundEdge>, CommandError> EdgesOn(const model::Element& photograph,
                                                           const model::Detection& detection,
                                                           double noise_px,
                                                           const Surroundings& surroundings) {
  const std::string key = EdgesKey(detection, noise_px);
  const auto known = surroundings.photographs.edges.find(key);
  if (known != surroundings.photographs.edges.end()) return known->second;
  const auto pixels = PixelsOf(photograph);
  if (!pixels) return Fail(pixels.error());
  const auto lines = camera::DetectLines(**pixels, {.min_length_px = detection.min_length_px});
  if (!lines || lines->empty()) {
    return Fail({.code = Code::kNotCalibrated,
                 .message = fmt::format(
                     "no straight edge is seen on {}: {}", NameForMessage(photograph),
                     lines ? "nothing in it is straight for long enough" : lines.error().detail),
                 .help = "`trace edge` says where they are"});
  }
  std::vector<FoundEdge> edges;
  for (const camera::ImageLine& line : *lines) {
    edges.push_back({{Rounded(line.a_px), Rounded(line.b_px)},
                     static_cast<double>(camera::SamplesOf(line, noise_px > 0 ? noise_px : 1))});
  }
  return surroundings.photographs.edges.emplace(key, std::move(edges)).first->second;
}

CommandResult DetectEdges(const State& state, const Answers& answers,
                          const Surroundings& surroundings) {
  const auto photograph = TracedPhotograph(state, answers);
  if (!photograph) return Fail(photograph.error());
  const double noise_px = state.drawing.settings->noise_px;
  const model::Detection detection{PhotographOf(**photograph).content, answers.Number("least")};
  const auto edges = EdgesOn(**photograph, detection, noise_px, surroundings);
  if (!edges) return Fail(edges.error());
  Fired fired;
  fired.edit.detection = detection;
  for (const FoundEdge& edge : *edges) {
    Trace trace{.kind = Kind::kDirection, .axis = camera::kNoAxis};
    trace.photograph = (*photograph)->id;
    trace.dots_px.assign(edge.ends_px.begin(), edge.ends_px.end());
    trace.facade = kMainFacade;
    trace.noise_px = noise_px;
    trace.samples = edge.samples;
    fired.edit.added.push_back(NewElement(state, std::make_shared<const Trace>(std::move(trace))));
  }
  fired.messages.push_back(
      fmt::format("{} edges on {}", edges->size(), NameForMessage(**photograph)));
  return fired;
}

// The edges of a photograph that nothing but a direction is known of, if that.
struct Edges {
  std::vector<ElementPtr> elements;
  std::vector<const Trace*> traces;
  std::vector<camera::ImageLine> lines;

  bool HasAxis(std::size_t i) const { return traces[i]->axis != camera::kNoAxis; }
};

Edges EdgesOf(const State& state, model::ElementId photograph) {
  Edges edges;
  state.model.ForEach([&](const ElementPtr& element) {
    const auto* held = std::get_if<model::TracePtr>(&element->geometry);
    if (!held || (*held)->photograph != photograph) return;
    const Trace& trace = **held;
    if (trace.kind != Kind::kDirection) return;
    const auto line = camera::FitImageLine(trace.dots_px, Unit(trace), trace.samples);
    if (!line) return;
    edges.elements.push_back(element);
    edges.traces.push_back(&trace);
    edges.lines.push_back(*line);
  });
  return edges;
}

// Which axis each direction found is called: as most of the edges say whose axis is traced already.
std::array<int, 3> NamesOf(const Edges& edges, const std::vector<int>& axis) {
  std::array<std::array<int, 3>, 3> votes{};  // by the axis found and the one traced
  for (std::size_t i = 0; i < axis.size(); ++i) {
    if (axis[i] == camera::kNoAxis || !edges.HasAxis(i)) continue;
    ++votes[axis[i]][edges.traces[i]->axis];
  }
  std::array<int, 3> names{0, 1, 2}, best = names;
  int most = -1;
  do {
    const int agree = votes[0][names[0]] + votes[1][names[1]] + votes[2][names[2]];
    if (agree > most) most = agree, best = names;
  } while (std::next_permutation(names.begin(), names.end()));
  return best;
}

// The line as one of its direction, as sure as a trace says it.
camera::ImageLine SureAs(const Edges& edges, std::size_t i) {
  const double unit_px = Unit(*edges.traces[i]);
  const camera::ImageLine& line = edges.lines[i];
  const int samples =
      camera::SamplesOf(camera::AsParallel(line, camera::DirectionSearch().parallel_rad), unit_px);
  return camera::FitImageLine({line.a_px, line.b_px}, unit_px, samples).value_or(line);
}

ElementPtr WithAxis(const Edges& edges, std::size_t i, const camera::DirectionTrace& made) {
  Trace trace = *edges.traces[i];
  trace.axis = made.axis;
  if (trace.dots_px.size() > 2) trace.dots_px = {edges.lines[i].a_px, edges.lines[i].b_px};
  trace.samples = camera::SamplesOf(made.line, Unit(trace));
  return model::WithGeometry(*edges.elements[i], std::make_shared<const Trace>(std::move(trace)));
}

std::string Summary(std::size_t all, const std::array<int, 3>& counts, const ElementPtr& of) {
  std::string text = fmt::format("{} edges on {}:", all, NameForMessage(*of));
  int left = static_cast<int>(all);
  for (std::size_t k = 0; k < 3; ++k) {
    if (counts[k] == 0) continue;
    text += fmt::format(" {} along {},", counts[k], "XYZ"[k]);
    left -= counts[k];
  }
  return text + fmt::format(" {} along none of them", left);
}

CommandResult DetectVanishingPoints(const State& state, const Answers& answers) {
  const auto photograph = TracedPhotograph(state, answers);
  if (!photograph) return Fail(photograph.error());
  const Edges edges = EdgesOf(state, (*photograph)->id);
  if (edges.lines.empty()) {
    return Fail({.code = Code::kNotCalibrated,
                 .message = fmt::format("there are no edges on {} yet whose direction could be "
                                        "found",
                                        NameForMessage(**photograph)),
                 .help = "`detect edges` finds them; `trace line` says where one is"});
  }
  const auto found = camera::FindVanishingDirections(
      edges.lines, PhotographOf(**photograph).frame,
      {.seed = static_cast<std::uint64_t>(answers.Number("seed", 1))});
  if (!found) {
    return Fail({.code = Code::kNotCalibrated,
                 .message = fmt::format("the edges on {} do not show two directions of a building",
                                        NameForMessage(**photograph)),
                 .label = found.error().detail,
                 .help = "`trace edge x`, `y` and `z` say which edges are parallel to an axis"});
  }
  const std::array<int, 3> names = NamesOf(edges, found->axis);
  Fired fired;
  std::array<int, 3> counts{};
  camera::Photograph taken;  // those traced before come first
  std::vector<std::size_t> made;
  for (const bool before : {true, false}) {
    for (std::size_t i = 0; i < edges.lines.size(); ++i) {
      if (before != edges.HasAxis(i)) continue;
      if (before)
        taken.traces.push_back(camera::DirectionTrace{edges.lines[i], edges.traces[i]->axis});
      if (before || found->axis[i] == camera::kNoAxis) continue;
      const int axis = names[static_cast<std::size_t>(found->axis[i])];
      taken.traces.push_back(camera::DirectionTrace{SureAs(edges, i), axis});
      made.push_back(i);
    }
  }
  // Pieces of one edge that lie on each other would count twice; `calibrate` refuses them.
  const std::vector<bool> repeats = camera::RepeatsALine(taken, {});
  const std::size_t first = taken.traces.size() - made.size();
  for (std::size_t m = 0; m < made.size(); ++m) {
    const auto& trace = std::get<camera::DirectionTrace>(taken.traces[first + m]);
    if (repeats[first + m]) continue;
    ++counts[static_cast<std::size_t>(trace.axis)];
    fired.edit.replaced.push_back(WithAxis(edges, made[m], trace));
  }
  fired.messages.push_back(Summary(edges.lines.size(), counts, *photograph));
  return fired;
}

constexpr Key kPhoto = {"photo", Type::kElement,
                        "the photograph; the one last attached or set without"};
constexpr Key kEdgeKeys[] = {
    {"least", Type::kCount,
     "how long the shortest is, in pixels; without, 3 % of the photograph's shorter side, and 12"},
    kPhoto};
constexpr Key kVanishingKeys[] = {
    {"seed", Type::kCount, "of the pairs of edges that are tried", {}, "1"}, kPhoto};

#define TRANOS_PHOTO "attach photo \"house.png\" as house\n"
constexpr Example kEdgeExamples[] = {
    {TRANOS_PHOTO "detect edges photo=house least=40 as found", "len(found) > 9"},
    {"attach photo \"facade.png\"; detect edges", "E0907"}};
constexpr Example kVanishingExamples[] = {
    {TRANOS_PHOTO "detect edges as found; detect vanishing points photo=house seed=2",
     "found[0].type == \"trace edge\""},
    {TRANOS_PHOTO "detect vanishing points", "E0907"},
    {TRANOS_PHOTO "for i = 0 to 9 { trace line samples=edge dot=10,(10+30*i) dot=300,(10+30*i) }\n"
                  "detect vanishing points",
     "E0907"}};
#undef TRANOS_PHOTO

constexpr Command kCommands[] = {
    {.words = "detect edges",
     .family = "photograph",
     .summary = "Finds the straight edges of a photograph, each a `trace line`.",
     .keys = kEdgeKeys,
     .examples = kEdgeExamples,
     .execute_with = DetectEdges,
     .informs = true},
    {.words = "detect vanishing points",
     .family = "photograph",
     .summary = "Finds the orthogonal directions of a building among the edges of its photograph, "
                "and makes each `trace line` of one of them a `trace edge` along X, Y or Z.",
     .keys = kVanishingKeys,
     .examples = kVanishingExamples,
     .execute = DetectVanishingPoints,
     .informs = true},
};

}  // namespace

std::string EdgesKey(const model::Detection& detection, double noise_px) {
  // To fewer digits than a journal keeps, so that a replay has the same.
  return fmt::format("{} {:.9g} {:.9g}", model::Hex(detection.content), detection.min_length_px,
                     noise_px);
}

std::span<const Command> DetectCommands() { return kCommands; }

}  // namespace tranos::interp
