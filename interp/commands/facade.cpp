// SPDX-License-Identifier: GPL-3.0-or-later
// Facades: set, constructed from points, recovered through the photograph.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "interp/commands/drawing.h"
#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/commands/photographs.h"
#include "interp/commands/recover_circle.h"

namespace tranos::interp {

using geom::Frame;
using geom::Vec2;
using geom::Vec3;
using model::ElementPtr;
using model::FacadeOf;
using model::State;

namespace {

// The sine of the angle under which a facade is seen, below which nothing can be drawn on it.
constexpr double kEdgeOn = 0.01;
// The same of directions that do not tell a plane.
constexpr double kParallel = 1e-9;

// The facade's name; an error if there is none or it is taken.
tl::expected<std::string, CommandError> NewName(const State& state, const Answers& answers) {
  if (answers.words.empty()) {
    return Fail({.code = Code::kMissingValue,
                 .message = "a facade has a name, by which it is set",
                 .help = "recover facade east perpendicular=front dot=…"});
  }
  const std::string& name = answers.words[0];
  if (!model::FindFacade(state.model, name)) return name;
  return Fail({.code = Code::kBoundTwice,
               .message = fmt::format("there is a facade `{}` already", Printable(name)),
               .help = "`set facade` takes it; another one has another name"});
}

CommandResult SetFacade(const State& state, const Answers& answers) {
  if (answers.words.empty()) {
    return Fail(
        {.code = Code::kMissingValue, .message = "which facade?", .help = "set facade front"});
  }
  const auto facade = FacadeNamed(state, answers.words[0]);
  if (!facade) return Fail(facade.error());
  auto settings = std::make_shared<model::Settings>(*state.drawing.settings);
  settings->plane = FacadeOf(**facade).plane;
  settings->facade = *facade;
  Fired fired;
  fired.edit.settings = std::move(settings);
  return fired;
}

// Through two points an upright one, through three that of their plane.
CommandResult ConstructFacade(const State& state, const Answers& answers) {
  const auto name = NewName(state, answers);
  if (!name) return Fail(name.error());
  if (const auto error = TooFar(answers)) return Fail(*error);
  const std::vector<Vec3>& points = answers.points;
  Vec3 right = points[1] - points[0], up = Vec3::UnitZ();
  if (points.size() == 2) right.z() = 0;
  if (right.norm() <= geom::kCoincident_m) {
    return Fail({.code = Code::kDegenerate,
                 .message = "both points of the facade are in one place of the plan",
                 .where = AtPoint(1)});
  }
  right.normalize();
  if (points.size() == 3) {
    const Vec3 way = points[2] - points[0];
    up = way - way.dot(right) * right;
    if (up.norm() <= geom::kCoincident_m) {
      return Fail({.code = Code::kDegenerate,
                   .message = "the three points of the facade lie on one line",
                   .where = AtPoint(2)});
    }
  }
  return Make(state, FacadeGeometry(*name, Frame{points[0], right, up.normalized()}));
}

// Where the dots lie on a facade.
tl::expected<std::vector<Vec3>, CommandError> DotsOn(const model::Photograph& photograph,
                                                     const model::Facade& facade,
                                                     const Answers& answers) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < answers.points.size(); ++i) {
    const Vec2 dot_px = answers.points[i].head<2>();
    const auto drawn =
        camera::DrawOnto(photograph.estimate->camera, photograph.frame, facade.plane, dot_px);
    if (!drawn) {
      CommandError error = BadDot(drawn.error(), facade, dot_px);
      error.where = AtPoint(static_cast<int>(i));
      return Fail(std::move(error));
    }
    points.push_back(drawn->point_m);
  }
  return points;
}

// The plane through the point with its x along this line, facing the camera.
tl::expected<Frame, CommandError> FacingCamera(const Vec3& at, const Vec3& along, const Vec3& up,
                                               const Vec3& camera_m, const std::string& name) {
  Frame frame{at, along, up};
  const Vec3 to_camera = camera_m - at;
  const double sine = frame.z().dot(to_camera) / to_camera.norm();
  if (!(std::abs(sine) > kEdgeOn)) {
    return Fail({.code = Code::kEdgeOn,
                 .message = fmt::format("the facade `{}` would be seen edge-on", Printable(name)),
                 .label = fmt::format("under {:.2f}°", std::asin(std::abs(sine)) / kDegree),
                 .help = "recover it through another photograph"});
  }
  if (sine < 0) frame.x = -frame.x;
  return frame;
}

// How a facade is to be found from what is known.
enum class Way : std::uint8_t {
  kEdge,           // along a horizontal edge, through a known point or by the edge's length
  kPerpendicular,  // on the line in a known facade where dots lie
  kDepth,          // parallel to a known one, so far behind it
  kThrough,        // parallel to a known one, through dots on one across
  kReveals,        // parallel to a known one, where edges across it end
};

CommandError Unsaid(std::string message, std::string_view help) {
  return {.code = Code::kMissingValue, .message = std::move(message), .help = std::string(help)};
}

tl::expected<Way, CommandError> WayOf(const Answers& answers) {
  const bool parallel = answers.Has("parallel"), depth = answers.Has("depth"),
             through = answers.Has("through");
  const bool edge = answers.Has("at") || answers.Has("length");
  const int said = static_cast<int>(answers.Has("perpendicular")) + static_cast<int>(parallel) +
                   static_cast<int>(edge);
  if (said != 1 || (answers.Has("at") && answers.Has("length"))) {
    return Fail(Unsaid(
        said == 0 ? "what is known of the facade?" : "what is known of the facade may be said once",
        "perpendicular=front dot=…; parallel=front depth=2m; at=POINT or length=3m, "
        "with two dots of a horizontal edge"));
  }
  for (const auto& [key, is_given] : {std::pair{"depth", depth}, {"through", through}}) {
    if (!is_given || parallel) continue;
    return Fail({.code = Code::kWrongWords,
                 .message = fmt::format("`{}=` is for a facade that is parallel to another", key),
                 .where = AtKey(key)});
  }
  if (depth && through) {
    return Fail({.code = Code::kWrongWords,
                 .message = "how deep the facade lies may be said once",
                 .where = AtKey("through")});
  }
  if (edge) return Way::kEdge;
  if (!parallel) return Way::kPerpendicular;
  return depth ? Way::kDepth : through ? Way::kThrough : Way::kReveals;
}

// The dots that the way goes by; an error if there are others.
std::optional<CommandError> WrongDots(Way way, const Answers& answers) {
  const std::size_t count = answers.points.size();
  switch (way) {
    case Way::kDepth:
      if (count == 0) return std::nullopt;
      return CommandError{.code = Code::kWrongCount,
                          .message = "with `depth=` no dot is needed",
                          .where = AtPoint(0)};
    case Way::kEdge:
      if (count >= 2) return std::nullopt;
      return CommandError{.code = Code::kTooFewPoints,
                          .message = "a horizontal edge of the facade has two dots or more",
                          .help = "dot=102.5,211 dot=340,188"};
    case Way::kReveals:
      if (count >= 2 && count % 2 == 0) return std::nullopt;
      return CommandError{.code = Code::kTooFewPoints,
                          .message = "how deep does it lie behind the facade it is parallel to?",
                          .help =
                              "depth=2m; a dot on a facade across: through=east dot=…; or two "
                              "dots for each edge that goes from the one to the other"};
    default:
      if (count >= 1) return std::nullopt;
      return CommandError{.code = Code::kTooFewPoints,
                          .message = "a dot tells where the facade lies",
                          .help = "dot=102.5,211"};
  }
}

CommandError SeenEndOn(const geom::Error& error, int dot) {
  return {.code = Code::kBadDot,
          .message = error.detail,
          .help = "trace another edge, or recover the facade through another photograph",
          .where = AtPoint(dot)};
}

// Lemma 9: an upright facade with a horizontal edge, and a control point or a length for the scale.
CommandResult AlongEdge(const State& state, const Answers& answers, const std::string& name,
                        const model::Photograph& photograph) {
  std::vector<Vec2> dots_px;
  for (const Vec3& dot : answers.points) dots_px.emplace_back(dot.head<2>());
  const auto line = camera::FitImageLine(dots_px, 1);
  if (!line) return Fail(SeenEndOn(line.error(), 1));
  const camera::Camera& taken_by = photograph.estimate->camera;
  const auto along = camera::LevelDirection(taken_by, photograph.frame, *line);
  if (!along) return Fail(SeenEndOn(along.error(), 1));
  Vec3 at = Vec3::Zero();
  if (const auto known = answers.Point("at")) {
    at = *known;
  } else {
    const double length_m = answers.Number("length");
    if (!(length_m > geom::kCoincident_m)) {
      return Fail({.code = Code::kOutOfRange,
                   .message = "the edge's length is above zero",
                   .where = AtKey("length")});
    }
    const auto begins = camera::BeginningOf(taken_by, photograph.frame, *line, *along, length_m);
    if (!begins) return Fail(SeenEndOn(begins.error(), 1));
    at = *begins;
  }
  const auto frame = FacingCamera(at, *along, Vec3::UnitZ(), taken_by.position_m(), name);
  if (!frame) return Fail(frame.error());
  return Make(state, FacadeGeometry(name, *frame));
}

Vec3 MeanOf(const std::vector<Vec3>& points) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points) mean += p / static_cast<double>(points.size());
  return mean;
}

// Lemma 11: a facade across a known one stands on the line in it where dots lie.
CommandResult Across(const State& state, const Answers& answers, const std::string& name,
                     const Frame& reference, const model::Facade& dots_on,
                     const model::Photograph& photograph) {
  const auto points = DotsOn(photograph, dots_on, answers);
  if (!points) return Fail(points.error());
  const Vec3 mean = MeanOf(*points);
  const Vec3 foot = mean - (mean - reference.origin).dot(reference.y) * reference.y;
  const auto frame = FacingCamera(foot, -reference.z(), reference.y,
                                  photograph.estimate->camera.position_m(), name);
  if (!frame) return Fail(frame.error());
  return Make(state, FacadeGeometry(name, *frame));
}

struct Depth {
  double m;
  double chi2_px2;  // Σ (how far it misses the edge's end, px)², edges − 1 degrees
};
// The depth at which the edges across a facade end, each from a dot on it to one at its other end:
// a known direction gives the depth (Debevec). Edges count by their images' squared length for each
// metre.
tl::expected<Depth, CommandError> DepthOfReveals(const Answers& answers,
                                                 const model::Facade& reference,
                                                 const model::Photograph& photograph) {
  const auto begins = DotsOn(photograph, reference, answers);
  if (!begins) return Fail(begins.error());
  double sum = 0, squares = 0, weights = 0;
  for (std::size_t i = 0; i + 1 < answers.points.size(); i += 2) {
    const Vec2 from_px = answers.points[i].head<2>(), to_px = answers.points[i + 1].head<2>();
    const auto depth_m = camera::LengthAlong(photograph.estimate->camera, photograph.frame,
                                             (*begins)[i], -reference.plane.z(), to_px);
    if (!depth_m) return Fail(SeenEndOn(depth_m.error(), static_cast<int>(i) + 1));
    if (std::abs(*depth_m) <= geom::kCoincident_m) {
      return Fail(SeenEndOn({geom::ErrorCode::kDegenerate, "the edge has no length"},
                            static_cast<int>(i) + 1));
    }
    const double weight = (to_px - from_px).squaredNorm() / (*depth_m * *depth_m);
    sum += weight * *depth_m;
    squares += weight * *depth_m * *depth_m;
    weights += weight;
  }
  const double mean_m = sum / weights;
  return Depth{mean_m, std::max(0.0, squares - sum * mean_m)};
}

CommandResult RecoverFacade(const State& state, const Answers& answers) {
  const auto name = NewName(state, answers);
  if (!name) return Fail(name.error());
  const auto way = WayOf(answers);
  if (!way) return Fail(way.error());
  if (auto error = WrongDots(*way, answers)) return Fail(*error);
  if (const auto error = TooFar(answers)) return Fail(*error);
  const std::string_view key = *way == Way::kPerpendicular ? "perpendicular" : "parallel";
  ElementPtr reference;
  if (*way != Way::kEdge) {
    const auto found = FacadeNamed(state, answers.Text(key), AtKey(key));
    if (!found) return Fail(found.error());
    reference = *found;
  }
  if (*way == Way::kDepth) {
    Frame frame = FacadeOf(*reference).plane;
    frame.origin -= answers.Number("depth") * frame.z();
    return Make(state, FacadeGeometry(*name, frame));
  }
  const auto meant = CameraMeant(state, answers);
  if (!meant) return Fail(meant.error());
  const model::Photograph& photograph = PhotographOf(**meant);
  if (*way == Way::kEdge) return AlongEdge(state, answers, *name, photograph);
  Frame frame = FacadeOf(*reference).plane;
  if (*way == Way::kPerpendicular) {
    return Across(state, answers, *name, frame, FacadeOf(*reference), photograph);
  }
  if (*way == Way::kReveals) {
    const auto depth = DepthOfReveals(answers, FacadeOf(*reference), photograph);
    if (!depth) return Fail(depth.error());
    frame.origin -= depth->m * frame.z();
    CommandResult made = Make(state, FacadeGeometry(*name, frame));
    const double noise_px = NoiseOf(state, (*meant)->id);
    // Both ends of an edge were drawn.
    const auto misfit =
        Misfit(depth->chi2_px2 / (2 * noise_px * noise_px),
               static_cast<double>(answers.points.size()) / 2 - 1, "the edges end at no one depth");
    if (made && misfit) made->warnings.push_back(*misfit);
    return made;
  }
  const auto across = FacadeNamed(state, answers.Text("through"), AtKey("through"));
  if (!across) return Fail(across.error());
  if (FacadeOf(**across).plane.z().cross(frame.z()).norm() <= kParallel) {
    return Fail({.code = Code::kDegenerate,
                 .message = "a dot on a facade that is parallel, too, tells no other depth",
                 .help = "through= a facade across it",
                 .where = AtKey("through")});
  }
  const auto points = DotsOn(photograph, FacadeOf(**across), answers);
  if (!points) return Fail(points.error());
  frame.origin += (MeanOf(*points) - frame.origin).dot(frame.z()) * frame.z();
  return Make(state, FacadeGeometry(*name, frame));
}

constexpr Key kRecoverKeys[] = {
    {"perpendicular", Type::kName, "the facade that it is perpendicular to"},
    {"parallel", Type::kName, "the facade that it is parallel to"},
    {"depth", Type::kLength, "how far behind the facade it is parallel to"},
    {"through", Type::kName, "the facade across it that its dots lie on"},
    {"at", Type::kPoint, "a point of it whose place is known"},
    {"length", Type::kLength, "of the horizontal edge from its first dot to its last"},
    {"photo", Type::kElement, "the photograph; the one last attached or set without"}};

constexpr Key kCircleKeys[] = {
    {"facade", Type::kName, "the facade that it lies on; the one that is set without"},
    {"photo", Type::kElement, "the photograph; the one last attached or set without"}};

constexpr Prompt kPoints[] = {{"point"}};
constexpr Prompt kDots[] = {{"dot"}};
constexpr int kMostDots = 10'000;

#define TRANOS_FRONT                                                                       \
  "place camera f=35mm format=36mm,24mm size=1600,1067 phi=-30deg xy=-20,-30,2 as paper\n" \
  "set camera paper\n"                                                                     \
  "construct facade front xy=0,0 xy=10,0\n"
constexpr Example kSetExamples[] = {
    {TRANOS_FRONT "set facade front; place point dot=800,500 as p", "p.y within 0m +- 1e-9m"},
    {"set facade front", "E0908"}};
constexpr Example kConstructExamples[] = {
    {"construct facade front xy=0,0 xy=10,0 as f", "f.normal == [0, -1, 0]"},
    {"construct facade roof xy=0,0,6 xy=10,0,6 xy=0,5,9 as f", "f.right == [1, 0, 0]"},
    {"construct facade front xy=0,0 xy=0,0,5", "E0501"}};
constexpr Example kRecoverExamples[] = {
    {TRANOS_FRONT "recover facade west perpendicular=front photo=paper dot=800,500 as w",
     "abs(w.normal.x + 1) < 1e-9"},
    {TRANOS_FRONT "recover facade back parallel=front depth=14m as b", "b.origin.y == 14m"},
    {TRANOS_FRONT "recover facade west perpendicular=front dot=800,500 reset\n"
                  "recover facade back parallel=front through=west dot=600,500 as b",
     "b.origin.y > 1m"},
    {TRANOS_FRONT "recover facade reveal parallel=front dot=800,500 dot=790,501 as r",
     "r.origin.y > 0m"},
    {TRANOS_FRONT "recover facade tower at=[3,4,5] dot=900,400 dot=990,420 as t",
     "distance([3m,4m,5m], t) < 1mm"},
    {TRANOS_FRONT "recover facade tower length=3m dot=900,400 dot=990,420 as t", "t.normal.y < 0"},
    {TRANOS_FRONT "recover facade west dot=800,500", "E0220"}};
constexpr Example kCircleExamples[] = {
    {TRANOS_FRONT "recover circle facade=front photo=paper\n"
                  "dot=900,500 dot=870,560 dot=800,580 dot=740,550 as oculus",
     "oculus.radius > 10cm"},
    {TRANOS_FRONT "recover circle facade=front dot=900,500 dot=850,500 dot=800,500", "E0909"}};
constexpr Example kArcExamples[] = {
    {TRANOS_FRONT "recover arc facade=front photo=paper\n"
                  "dot=900,500 dot=870,560 dot=800,580 dot=740,550 as arch",
     "arch.start.x > arch.end.x"},
    {TRANOS_FRONT "recover arc dot=900,500 dot=870,560 dot=800,580", "E0908"}};
#undef TRANOS_FRONT

constexpr Command kCommands[] = {
    {.words = "set facade",
     .family = "set",
     .summary = "Makes a facade the active plane, and the one that dots are drawn on, until the "
                "closing brace.",
     .asks = "facade",
     .examples = kSetExamples,
     .execute = SetFacade},
    {.words = "construct facade",
     .family = "construct",
     .summary = "A facade by two points of the plan, an upright one with its right from the first "
                "to the second; or by three points of its plane.",
     .manner = Manner::kGathers,
     .prompts = kPoints,
     .least = 2,
     .most = 3,
     .asks = "facade",
     .examples = kConstructExamples,
     .execute = ConstructFacade},
    {.words = "recover facade",
     .family = "photograph",
     .summary = "A facade: perpendicular to a known one, through the line where a dot lies on it; "
                "parallel to one, at a depth, through a dot on a facade across, or where edges "
                "across it end, two dots for each; or upright along a horizontal edge, with a "
                "known point or the edge's length.",
     .manner = Manner::kGathers,
     .prompts = kDots,
     .least = 0,
     .keys = kRecoverKeys,
     .asks = "facade",
     .examples = kRecoverExamples,
     .execute = RecoverFacade,
     .dots = true},
    {.words = "recover circle",
     .family = "photograph",
     .summary = "The circle on a facade that is seen along its dots: three of them, better nine.",
     .manner = Manner::kGathers,
     .prompts = kDots,
     .least = 3,
     .most = kMostDots,
     .keys = kCircleKeys,
     .examples = kCircleExamples,
     .execute = RecoverCircle,
     .dots = true},
    {.words = "recover arc",
     .family = "photograph",
     .summary =
         "The arc of a circle on a facade that is seen along its dots, from the first to the "
         "last.",
     .manner = Manner::kGathers,
     .prompts = kDots,
     .least = 3,
     .most = kMostDots,
     .keys = kCircleKeys,
     .examples = kArcExamples,
     .execute = RecoverArc,
     .dots = true},
};

}  // namespace

std::span<const Command> FacadeCommands() { return kCommands; }

}  // namespace tranos::interp
