// SPDX-License-Identifier: GPL-3.0-or-later
// Facades: set, constructed from points, recovered through the photograph.
#include <fmt/format.h>

#include <cmath>

#include "interp/commands/drawing.h"
#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/commands/photographs.h"

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

// What the new facade is parallel or perpendicular to, and on which one its dots lie.
struct Known {
  ElementPtr reference, dots_on;
  bool is_parallel = false;
};

tl::expected<Known, CommandError> KnownOf(const State& state, const Answers& answers) {
  Known known;
  known.is_parallel = answers.Has("parallel");
  if (known.is_parallel == answers.Has("perpendicular")) {
    return Fail({.code = Code::kMissingValue,
                 .message = "a facade is recovered perpendicular or parallel to one that is known",
                 .help = "recover facade east perpendicular=front dot=…; recover facade back "
                         "parallel=front through=east dot=…"});
  }
  const std::string_view key = known.is_parallel ? "parallel" : "perpendicular";
  const auto reference = FacadeNamed(state, answers.Text(key), AtKey(key));
  if (!reference) return Fail(reference.error());
  known.reference = known.dots_on = *reference;
  if (answers.Has("through")) {
    const auto through = FacadeNamed(state, answers.Text("through"), AtKey("through"));
    if (!through) return Fail(through.error());
    known.dots_on = *through;
  }
  const bool by_depth = answers.Has("depth");
  if (by_depth && !known.is_parallel) {
    return Fail({.code = Code::kWrongWords,
                 .message = "`depth=` is from a facade that the new one is parallel to",
                 .where = AtKey("depth")});
  }
  if (known.is_parallel && by_depth == answers.Has("through")) {
    return Fail({.code = Code::kMissingValue,
                 .message = by_depth ? "how deep it lies may be said once"
                                     : "how deep does it lie behind the facade it is parallel to?",
                 .help = "by a depth: depth=2m; or by a dot on a facade across: through=east dot=…",
                 .where = by_depth ? AtKey("depth") : Where{}});
  }
  if (answers.points.empty() != by_depth) {
    return Fail({.code = Code::kTooFewPoints,
                 .message = by_depth ? "with `depth=` no dot is needed"
                                     : "a dot tells where the facade lies",
                 .help = "dot=102.5,211"});
  }
  return known;
}

// Lemma 11: a facade across a known one stands on the line in it where a dot lies.
CommandResult RecoverFacade(const State& state, const Answers& answers) {
  const auto name = NewName(state, answers);
  if (!name) return Fail(name.error());
  const auto known = KnownOf(state, answers);
  if (!known) return Fail(known.error());
  const Frame& reference = FacadeOf(*known->reference).plane;
  if (known->is_parallel && answers.Has("depth")) {
    Frame frame = reference;
    frame.origin -= answers.Number("depth") * reference.z();
    return Make(state, FacadeGeometry(*name, frame));
  }
  const auto photograph = CameraMeant(state, answers);
  if (!photograph) return Fail(photograph.error());
  const auto points = DotsOn(PhotographOf(**photograph), FacadeOf(*known->dots_on), answers);
  if (!points) return Fail(points.error());
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : *points) mean += p / static_cast<double>(points->size());
  const Vec3 camera_m = PhotographOf(**photograph).estimate->camera.position_m();
  if (!known->is_parallel) {
    const Vec3 foot = mean - (mean - reference.origin).dot(reference.y) * reference.y;
    const auto frame = FacingCamera(foot, -reference.z(), reference.y, camera_m, *name);
    if (!frame) return Fail(frame.error());
    return Make(state, FacadeGeometry(*name, *frame));
  }
  const Frame& across = FacadeOf(*known->dots_on).plane;
  if (across.z().cross(reference.z()).norm() <= kParallel) {
    return Fail({.code = Code::kDegenerate,
                 .message = "a dot on a facade that is parallel, too, tells no other depth",
                 .help = "through= a facade across it",
                 .where = AtKey("through")});
  }
  Frame frame = reference;
  frame.origin += (mean - reference.origin).dot(reference.z()) * reference.z();
  return Make(state, FacadeGeometry(*name, frame));
}

constexpr Key kRecoverKeys[] = {
    {"perpendicular", Type::kName, "the facade that it is perpendicular to"},
    {"parallel", Type::kName, "the facade that it is parallel to"},
    {"depth", Type::kLength, "how far behind the facade it is parallel to"},
    {"through", Type::kName,
     "the facade that its dots lie on; the one it is perpendicular to without"},
    {"photo", Type::kElement, "the photograph; the one last attached or set without"}};

constexpr Prompt kPoints[] = {{"point"}};
constexpr Prompt kDots[] = {{"dot"}};

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
    {TRANOS_FRONT "recover facade west dot=800,500", "E0220"}};
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
     .summary = "A facade perpendicular to a known one, through the line where a dot lies on it; "
                "or one parallel to a known one, at a depth or through a dot on a facade across.",
     .manner = Manner::kGathers,
     .prompts = kDots,
     .least = 0,
     .keys = kRecoverKeys,
     .asks = "facade",
     .examples = kRecoverExamples,
     .execute = RecoverFacade,
     .dots = true},
};

}  // namespace

std::span<const Command> FacadeCommands() { return kCommands; }

}  // namespace tranos::interp
