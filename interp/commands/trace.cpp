// SPDX-License-Identifier: GPL-3.0-or-later
// trace: what is seen on a photograph of things whose direction, place or size is known.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/commands/photographs.h"
#include "model/facades.h"

namespace tranos::interp {

using geom::Vec2;
using model::ElementPtr;
using model::State;
using model::Trace;
using model::Value;

namespace {

using Kind = Trace::Kind;

Where AtDot(std::size_t index) { return {Where::kPoint, static_cast<int>(index), {}}; }

// `group` dots belong together, and are apart; those of two edges may meet in a corner.
std::optional<CommandError> CheckDots(const Answers& answers, const camera::Frame& frame,
                                      std::size_t group) {
  for (std::size_t i = 0; i < answers.points.size(); ++i) {
    const Vec2 dot = answers.points[i].head<2>();
    if (auto error = OutsidePhotograph(frame, dot, Code::kBadTrace)) {
      error->where = AtDot(i);
      return error;
    }
    for (std::size_t j = i - i % group; j < i; ++j) {
      if ((answers.points[j].head<2>() - dot).norm() > 1e-6) continue;
      return CommandError{.code = Code::kBadTrace,
                          .message = "two dots of the trace are in one place",
                          .where = AtDot(i)};
    }
  }
  return std::nullopt;
}

// Of the first dot outside the photograph.
std::vector<CommandError> WarningsOfDots(const Answers& answers, const camera::Frame& frame) {
  for (std::size_t i = 0; i < answers.points.size(); ++i) {
    auto warning = JustOutsidePhotograph(frame, answers.points[i].head<2>());
    if (!warning) continue;
    warning->where = AtDot(i);
    return {*std::move(warning)};
  }
  return {};
}

CommandResult MakeTrace(const State& state, const Answers& answers, Trace trace, std::size_t dots) {
  const auto photograph = TracedPhotograph(state, answers.Has("photo") ? answers : Answers{});
  if (!photograph) return Fail(photograph.error());
  const camera::Frame& frame = PhotographOf(**photograph).frame;
  const std::size_t group = trace.kind == Kind::kRatio ? 2 : answers.points.size();
  if (auto error = CheckDots(answers, frame, group)) return Fail(*error);
  if (dots > 0 && answers.points.size() != dots) {
    return Fail({.code = Code::kBadTrace,
                 .message = fmt::format("this trace takes {} dots, and has {}", dots,
                                        answers.points.size())});
  }
  for (const geom::Vec3& dot : answers.points) trace.dots_px.emplace_back(dot.head<2>());
  trace.photograph = (*photograph)->id;
  trace.noise_px = state.drawing.settings->noise_px;
  trace.facade = answers.Text("facade", kMainFacade);
  const ElementPtr known = model::FindFacade(state.model, trace.facade);
  if (known && answers.Has("facade") && model::FacadeOf(*known).plane.y.z() < 1 - 1e-9) {
    return Fail({.code = Code::kBadTrace,
                 .message = fmt::format("the facade `{}` is not upright, and what is traced on one "
                                        "is",
                                        Printable(trace.facade)),
                 .where = {Where::kKey, 0, "facade"}});
  }
  CommandResult made = Make(state, std::make_shared<const Trace>(std::move(trace)));
  made->warnings = WarningsOfDots(answers, frame);
  return made;
}

// How many pixels a line was fitted to.
tl::expected<double, CommandError> SamplesOf(const Answers& answers) {
  const Value* given = answers.Find("samples");
  if (!given) return 0;
  if (answers.points.size() != 2) {
    return Fail({.code = Code::kBadTrace,
                 .message = "`samples=` is for the two ends of a fitted line",
                 .where = {Where::kKey, 0, "samples"}});
  }
  if (given->is_string()) {
    const Vec2 along = (answers.points[1] - answers.points[0]).head<2>();
    return std::max(2.0, std::floor(along.norm()));
  }
  if (given->number() >= 2) return given->number();
  return Fail({.code = Code::kOutOfRange,
               .message = "a line is fitted to two pixels or more",
               .where = {Where::kKey, 0, "samples"}});
}

void AddPoint(const Value& point, std::vector<Value>* numbers) {
  for (std::size_t i = 0; i < 3; ++i) {
    numbers->push_back(i < point.list().size() ? point.list()[i]
                                               : Value::Number(0, model::kLength));
  }
}

// Which edge it is must be said once.
std::optional<CommandError> UnsaidEdge(const Answers& answers) {
  const bool from = answers.Has("from"), to = answers.Has("to");
  const int said = static_cast<int>(answers.words.size()) + answers.Has("of") + (from || to);
  if (said == 1 && from == to) return std::nullopt;
  if (said == 1) {
    return CommandError{
        .code = Code::kMissingValue,
        .message = fmt::format("an edge in space has two ends, and `{}=` is not given",
                               from ? "to" : "from"),
        .help = "trace edge from=[0,0,0] to=[0,14m,0] …",
        .where = {Where::kKey, 0, from ? "from" : "to"}};
  }
  return CommandError{
      .code = Code::kMissingValue,
      .message = said == 0 ? "which edge is it? An axis, both ends, or an element of the model"
                           : "which edge it is may be said once: an axis, both ends, or an element",
      .help = "trace edge x …; trace edge from=[0,0,0] to=[0,14m,0] …; trace edge of=sill …"};
}

CommandResult TraceEdge(const State& state, const Answers& answers) {
  Trace trace{.kind = Kind::kDirection};
  const auto samples = SamplesOf(answers);
  if (!samples) return Fail(samples.error());
  trace.samples = *samples;
  if (const auto error = UnsaidEdge(answers)) return Fail(*error);
  if (!answers.words.empty()) trace.axis = answers.words[0][0] - 'x';
  if (answers.Has("from")) {
    trace.kind = Kind::kEdge;
    if ((*answers.Point("from") - *answers.Point("to")).norm() <= geom::kCoincident_m) {
      return Fail({.code = Code::kBadTrace,
                   .message = "the edge has no length",
                   .where = {Where::kKey, 0, "to"}});
    }
    AddPoint(*answers.Find("from"), &trace.numbers);
    AddPoint(*answers.Find("to"), &trace.numbers);
  }
  if (const Value* of = answers.Find("of")) {
    trace.kind = Kind::kElement;
    trace.of = of->element();
    if (!std::holds_alternative<model::CurvePtr>(trace.of->geometry)) {
      return Fail({.code = Code::kWrongElement,
                   .message = fmt::format("an edge is a line, an arc or another curve, and this is "
                                          "{}",
                                          NameForMessage(*trace.of)),
                   .where = {Where::kKey, 0, "of"}});
    }
  }
  return MakeTrace(state, answers, std::move(trace), 0);
}

CommandResult TraceLine(const State& state, const Answers& answers) {
  Trace trace{.kind = Kind::kDirection, .axis = -1};
  const auto samples = SamplesOf(answers);
  if (!samples) return Fail(samples.error());
  trace.samples = *samples;
  return MakeTrace(state, answers, std::move(trace), 0);
}

CommandResult TracePoint(const State& state, const Answers& answers) {
  Trace trace{.kind = Kind::kPoint};
  AddPoint(*answers.Find("at"), &trace.numbers);
  return MakeTrace(state, answers, std::move(trace), 1);
}

// Twice the area, positive where dots run anticlockwise as seen with y down.
double DoubleArea(const std::vector<geom::Vec3>& dots) {
  double area = 0;
  for (std::size_t i = 0, j = dots.size() - 1; i < dots.size(); j = i++) {
    area += dots[i].x() * dots[j].y() - dots[j].x() * dots[i].y();
  }
  return area;
}

bool IsConvex(const std::vector<geom::Vec3>& dots) {
  int left = 0, right = 0;
  for (std::size_t i = 0; i < dots.size(); ++i) {
    const Vec2 a = dots[i].head<2>(), b = dots[(i + 1) % dots.size()].head<2>(),
               c = dots[(i + 2) % dots.size()].head<2>();
    const double turn = (b - a).x() * (c - b).y() - (b - a).y() * (c - b).x();
    (turn > 0 ? left : right) += 1;
  }
  return left == 0 || right == 0;
}

CommandResult TraceRectangle(const State& state, const Answers& answers) {
  if (answers.points.size() == 4 && !IsConvex(answers.points)) {
    return Fail({.code = Code::kBadTrace,
                 .message = "the rectangle is traced crosswise",
                 .help = "its dots go anticlockwise from bottom left",
                 .where = AtDot(3)});
  }
  if (answers.points.size() == 4 && DoubleArea(answers.points) < 0) {
    return Fail({.code = Code::kBadTrace,
                 .message = "the rectangle is traced clockwise",
                 .help = "its dots go anticlockwise from bottom left"});
  }
  Trace trace{.kind = Kind::kRectangle};
  for (const std::string_view side : {"a", "b"}) {
    trace.numbers.push_back(*answers.Find(side));
    if (trace.numbers.back().number() > geom::kCoincident_m) continue;
    return Fail({.code = Code::kBadTrace,
                 .message = fmt::format("the side `{}` of the rectangle is not above zero", side),
                 .where = {Where::kKey, 0, side}});
  }
  return MakeTrace(state, answers, std::move(trace), 4);
}

CommandResult TraceRatio(const State& state, const Answers& answers) {
  Trace trace{.kind = Kind::kRatio};
  const Value* ratio = answers.Find("value");
  trace.numbers.push_back(ratio ? *ratio : Value::Number(1));
  if (!(trace.numbers[0].number() > 0)) {
    return Fail({.code = Code::kBadTrace,
                 .message = "a ratio of lengths is above zero",
                 .where = {Where::kKey, 0, "value"}});
  }
  return MakeTrace(state, answers, std::move(trace), 4);
}

// How far dots lie off the line through them, in pixels, on the average.
double OffLine(const std::vector<geom::Vec3>& dots) {
  Vec2 mean = Vec2::Zero();
  for (const geom::Vec3& dot : dots) mean += dot.head<2>() / static_cast<double>(dots.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const geom::Vec3& dot : dots) {
    const Vec2 from_mean = dot.head<2>() - mean;
    scatter += from_mean * from_mean.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(scatter);
  return std::sqrt(std::max(solver.eigenvalues()[0], 0.0) / static_cast<double>(dots.size()));
}

CommandResult TraceCircle(const State& state, const Answers& answers) {
  const double noise_px = state.drawing.settings->noise_px;
  if (OffLine(answers.points) <= (noise_px > 0 ? noise_px : 0.5)) {
    return Fail({.code = Code::kBadTrace,
                 .message = "the dots of the circle lie on one line, within their noise",
                 .label = "this trace",
                 .help = "five dots or more, all around it"});
  }
  return MakeTrace(state, answers, Trace{.kind = Kind::kCircle}, 0);
}

constexpr Key kPhoto = {"photo", Type::kElement,
                        "the photograph; the one last attached or set without"};
constexpr Key kFacade = {"facade", Type::kName, "the facade that it lies on", {}, kMainFacade};
constexpr Key kEdgeKeys[] = {
    {"from", Type::kPoint, "where the edge begins"},
    {"to", Type::kPoint, "where it ends"},
    {"of", Type::kElement, "the line, arc or other curve that it is the image of"},
    {"samples", Type::kCount,
     "how many pixels the line was fitted to; `edge`: one for each pixel of its length", "edge"},
    kPhoto};
constexpr Key kLineKeys[] = {kEdgeKeys[3], kPhoto};
constexpr Key kPointKeys[] = {{"at", Type::kPoint, "where the point is", {}, {}, -1, true}, kPhoto};
constexpr Key kRectangleKeys[] = {{"a", Type::kLength, "its width, along X", {}, {}, -1, true},
                                  {"b", Type::kLength, "its height, along Z", {}, {}, -1, true},
                                  kFacade,
                                  kPhoto};
constexpr Key kEqualKeys[] = {kFacade, kPhoto};
constexpr Key kRatioKeys[] = {
    {"value", Type::kNumber, "the first edge's length by the second's", {}, {}, -1, true},
    kFacade,
    kPhoto};

constexpr Prompt kDots[] = {{"dot"}};

#define TRANOS_PHOTO "attach photo \"facade.png\" format=36mm,24mm as hall\n"
constexpr Example kEdgeExamples[] = {
    {TRANOS_PHOTO "trace edge x samples=edge photo=hall dot=102.5,211.0 dot=340.2,188.4 as sill",
     "len(sill.dots) == 2"},
    {TRANOS_PHOTO "trace edge from=[0,0,0] to=[0,14m,0] dot=102,211 dot=340,188", "true"},
    {TRANOS_PHOTO "place line xy=0,0,6 dl=10 as eaves; trace edge of=eaves dot=102,211 dot=340,188",
     "true"},
    {TRANOS_PHOTO "trace edge x dot=102,211", "E0402"}};
constexpr Example kLineExamples[] = {
    {TRANOS_PHOTO "trace line samples=edge photo=hall dot=102.5,211.0 dot=340.2,188.4 as sill",
     "sill.type == \"trace line\""},
    {TRANOS_PHOTO "trace line dot=102,211 dot=102,211", "E0903"}};
constexpr Example kPointExamples[] = {
    {TRANOS_PHOTO "trace point at=[0,0,6m] photo=hall dot=211,290 as corner",
     "len(corner.dots) == 1"},
    {TRANOS_PHOTO "trace point at=[0,0,6m] dot=21100,290", "E0903"}};
constexpr Example kRectangleExamples[] = {
    {TRANOS_PHOTO "trace rectangle a=1.20m b=2.10m facade=front photo=hall\n"
                  "dot=100,400 dot=180,390 dot=180,250 dot=100,260 as door",
     "len(door.dots) == 4"},
    {TRANOS_PHOTO "trace rectangle a=1.20m b=2.10m dot=100,400 dot=180,250 dot=180,390 dot=100,260",
     "E0903"}};
constexpr Example kEqualExamples[] = {
    {TRANOS_PHOTO "trace equal facade=front photo=hall\n"
                  "dot=100,400 dot=180,390 dot=100,400.5 dot=100,320",
     "true"},
    {TRANOS_PHOTO "trace equal dot=100,400 dot=180,390 dot=100,320", "E0402"}};
constexpr Example kRatioExamples[] = {
    {TRANOS_PHOTO "trace ratio value=1.5 facade=front photo=hall\n"
                  "dot=100,400 dot=180,390 dot=100,400.5 dot=100,350",
     "true"},
    {TRANOS_PHOTO "trace ratio value=0 dot=100,400 dot=180,390 dot=100,400.5 dot=100,350",
     "E0903"}};
constexpr Example kCircleExamples[] = {
    {TRANOS_PHOTO "trace circle facade=front photo=hall\n"
                  "dot=100,50 dot=150,100 dot=100,150 dot=50,100 dot=135,64 as oculus",
     "len(oculus.dots) == 5"},
    {TRANOS_PHOTO "trace circle dot=100,50 dot=150,100", "E0402"},
    {TRANOS_PHOTO "trace circle dot=0,0 dot=50,50 dot=100,100 dot=150,150 dot=200,200", "E0903"}};
#undef TRANOS_PHOTO

// What all traces have in common: they gather dots, and become one element when they end.
constexpr Command Tracing(Command row) {
  row.manner = Manner::kGathers;
  row.prompts = kDots;
  row.dots = true;
  row.informs = true;
  return row;
}

constexpr int kMostDots = 100'000;
constexpr Command kCommands[] = {
    Tracing({.words = "trace edge",
             .family = "photograph",
             .summary = "The image line of an edge: along an axis, at a known place, or of an "
                        "element. Two dots, or more along it.",
             .least = 2,
             .most = kMostDots,
             .keys = kEdgeKeys,
             .options = "x|y|z",
             .examples = kEdgeExamples,
             .execute = TraceEdge}),
    Tracing({.words = "trace line",
             .family = "photograph",
             .summary = "The image line of an edge of which nothing is known yet, for `detect "
                        "vanishing points`; `calibrate` leaves it out.",
             .least = 2,
             .most = kMostDots,
             .keys = kLineKeys,
             .examples = kLineExamples,
             .execute = TraceLine}),
    Tracing({.words = "trace point",
             .family = "photograph",
             .summary = "The image of a point whose place is known.",
             .least = 1,
             .most = 1,
             .keys = kPointKeys,
             .examples = kPointExamples,
             .execute = TracePoint}),
    Tracing({.words = "trace rectangle",
             .family = "photograph",
             .summary = "The image of an upright rectangle on a facade: four dots, anticlockwise "
                        "from bottom left.",
             .least = 4,
             .most = 4,
             .keys = kRectangleKeys,
             .examples = kRectangleExamples,
             .execute = TraceRectangle}),
    Tracing({.words = "trace equal",
             .family = "photograph",
             .summary = "The image of two orthogonal edges of equal length on a facade.",
             .least = 4,
             .most = 4,
             .keys = kEqualKeys,
             .examples = kEqualExamples,
             .execute = TraceRatio}),
    Tracing({.words = "trace ratio",
             .family = "photograph",
             .summary = "The image of two orthogonal edges on a facade whose lengths have a known "
                        "ratio.",
             .least = 4,
             .most = 4,
             .keys = kRatioKeys,
             .examples = kRatioExamples,
             .execute = TraceRatio}),
    Tracing({.words = "trace circle",
             .family = "photograph",
             .summary = "The image of a circle on a facade: five dots or more.",
             .least = 5,
             .most = kMostDots,
             .keys = kEqualKeys,
             .examples = kCircleExamples,
             .execute = TraceCircle}),
};

}  // namespace

std::span<const Command> TraceCommands() { return kCommands; }

}  // namespace tranos::interp
