// SPDX-License-Identifier: GPL-3.0-or-later
// calibrate and recover camera. The solving itself is the machine's (calibration.cpp), for it runs
// what stands before.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "interp/camera_report.h"
#include "interp/commands/drawing.h"
#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/commands/photographs.h"
#include "model/facades.h"

namespace tranos::interp {

using model::State;

namespace {

using camera::Mat3;
using geom::Vec2;
using geom::Vec3;

// What a photograph's traces say of a facade.
struct Facade {
  std::string name;
  const model::Trace* rectangle = nullptr;  // the first on it
};

struct Facades {
  std::vector<Facade> named;    // in the order of their traces
  bool world_is_fixed = false;  // by edges or points; else the first is the plane y = 0

  const Facade* Find(const std::string& name) const {
    const auto found = std::find_if(named.begin(), named.end(),
                                    [&](const Facade& facade) { return facade.name == name; });
    return found == named.end() ? nullptr : &*found;
  }
};

Facades FacadesOf(const State& state, model::ElementId photograph) {
  Facades out;
  state.model.ForEach([&](const model::ElementPtr& element) {
    const auto* held = std::get_if<model::TracePtr>(&element->geometry);
    if (!held || (*held)->photograph != photograph) return;
    const model::Trace& trace = **held;
    using Kind = model::Trace::Kind;
    if (trace.kind == Kind::kDirection) return;
    if (trace.kind == Kind::kEdge || trace.kind == Kind::kElement || trace.kind == Kind::kPoint) {
      out.world_is_fixed = true;
      return;
    }
    auto known = std::find_if(out.named.begin(), out.named.end(),
                              [&](const Facade& facade) { return facade.name == trace.facade; });
    if (known == out.named.end()) known = out.named.insert(known, {trace.facade});
    if (trace.kind == Kind::kRectangle && !known->rectangle) known->rectangle = &trace;
  });
  return out;
}

// Whether the camera sees the rectangle from outside: its dots go anticlockwise from bottom left,
// so that its outward normal is its X, found by its vanishing point, by Z.
bool IsBefore(const camera::Camera& camera, const camera::Frame& frame,
              const model::Trace& rectangle) {
  const Mat3 camera_from_dot =
      (frame.DotFromFrame() * camera::FrameFromCamera(camera.parameters)).inverse();
  const Mat3 world_from_camera = camera::CameraFromWorld(camera.parameters).transpose();
  Vec3 ray[4];
  for (std::size_t i = 0; i < 4; ++i) ray[i] = camera_from_dot * rectangle.dots_px[i].homogeneous();
  Vec3 along = ray[0].cross(ray[1]).cross(ray[3].cross(ray[2]));
  const Vec2 moved = along.head<2>() - along.z() * ray[0].head<2>();
  if (moved.dot((ray[1] - ray[0]).head<2>()) < 0) along = -along;
  const Vec3 outward = (world_from_camera * along).cross(Vec3::UnitZ());
  return outward.dot(world_from_camera * (ray[0] + ray[2])) < 0;
}

CommandError NoFacade(const std::string& name, const Facades& facades) {
  std::string known;
  for (const Facade& facade : facades.named) {
    known += (known.empty() ? "`" : ", `") + Printable(facade.name) + "`";
  }
  return {.code = Code::kUnknownName,
          .message = fmt::format("no facade is called `{}`", Printable(name)),
          .label = known.empty() ? "nothing was traced on a facade" : "traced are " + known,
          .help =
              "`trace rectangle … facade=NAME` declares one; `recover camera near=[x,y,z]` says "
              "about where the camera stood",
          .where = {Where::kKey, 0, "facade"}};
}

// How little a camera is the one that is asked for.
using Score = std::function<double(const camera::Camera&)>;

tl::expected<Score, CommandError> ScoreOf(const State& state, const Answers& answers,
                                          const model::Element& photograph) {
  if (const auto near = answers.Point("near")) {
    return [near](const camera::Camera& camera) { return (camera.position_m() - *near).norm(); };
  }
  const Facades facades = FacadesOf(state, photograph.id);
  const std::string name = answers.Text("facade");
  const Facade* facade = facades.Find(name);
  const model::ElementPtr found = name.empty() ? nullptr : model::FindFacade(state.model, name);
  const auto* known =
      found && model::FacadeOf(*found).solved < 0 ? &model::FacadeOf(*found) : nullptr;
  if (!name.empty() && !facade && !known) return Fail(NoFacade(name, facades));
  if (facade && facade->rectangle) {
    return [rectangle = *facade->rectangle,
            frame = PhotographOf(photograph).frame](const camera::Camera& camera) {
      return IsBefore(camera, frame, rectangle) ? 0.0 : 1.0;
    };
  }
  if (known) {
    return [plane = known->plane](const camera::Camera& camera) {
      return plane.z().dot(camera.position_m() - plane.origin) > 0 ? 0.0 : 1.0;
    };
  }
  if (facade && (facades.world_is_fixed || facade != facades.named.data())) {
    return Fail(
        {.code = Code::kNotDetermined,
         .message = fmt::format("which way the facade `{}` faces is not known", Printable(name)),
         .label = "no rectangle was traced on it",
         .help = "trace one, or say about where the camera stood: near=[x,y,z]",
         .where = {Where::kKey, 0, "facade"}});
  }
  return [](const camera::Camera& camera) { return camera[camera::kY0] < 0 ? 0.0 : 1.0; };
}

// What the script built with unknowns stays as it is, and another pose would have them otherwise.
std::vector<CommandError> OfUnknownsThatStay(const model::Photograph& photograph,
                                             const camera::Estimate& after) {
  constexpr double kNoticeable = 0.1;  // of a deviation
  std::vector<CommandError> warnings;
  for (std::size_t i = 0; i < after.unknowns.size(); ++i) {
    const camera::UnknownEstimate &was = photograph.estimate->unknowns[i],
                                  &would_be = after.unknowns[i];
    const double moved = would_be.value - was.value;
    if (was.name.empty() || std::abs(moved) <= kNoticeable * would_be.sigma) continue;
    warnings.push_back({.code = Code::kCameraWeak,
                        .message = fmt::format(
                            "`{}` stays {}, as it was solved for the other pose; for this one it "
                            "is {}",
                            was.name, UnknownText(photograph, *photograph.estimate, i),
                            UnknownText(photograph, after, i))});
  }
  return warnings;
}

// Of the poses that explain the traces, the one that is asked for; without a word on which, the one
// before the plane y = 0.
CommandResult RecoverCamera(const State& state, const Answers& answers) {
  const auto found = PhotographMeant(state, answers);
  if (!found) return Fail(found.error());
  model::Photograph changed = PhotographOf(**found);
  if (!changed.estimate) return Fail(NoCameraYet(**found));
  const auto score = ScoreOf(state, answers, **found);
  if (!score) return Fail(score.error());
  camera::Estimate estimate = *changed.estimate;
  auto best = estimate.alternatives.end();
  double least = (*score)(estimate.camera);
  for (auto other = estimate.alternatives.begin(); other != estimate.alternatives.end(); ++other) {
    if ((*score)(other->camera) >= least) continue;
    least = (*score)(other->camera);
    best = other;
  }
  Fired fired;
  const auto index = best - estimate.alternatives.begin();
  if (best == estimate.alternatives.end()) {
    if (!answers.Has("near") && least > 0) {
      return Fail({.code = Code::kNotDetermined,
                   .message = "no pose of the camera has the facade before it"});
    }
    return fired;
  }
  camera::Estimate chosen = std::move(*best);
  fired.warnings = OfUnknownsThatStay(changed, chosen);
  chosen.alternatives = std::move(estimate.alternatives);
  estimate.alternatives.clear();
  chosen.alternatives[static_cast<std::size_t>(index)] = std::move(estimate);
  state.model.ForEach([&](const model::ElementPtr& element) {
    const auto* facade = std::get_if<model::FacadePtr>(&element->geometry);
    if (!facade || (*facade)->solved < 0) return;
    const auto& [name, plane, solved] = **facade;
    const auto place = static_cast<std::size_t>(solved);
    if (place >= chosen.facades.size()) return;
    const camera::FacadeEstimate& now = chosen.facades[place];
    fired.edit.replaced.push_back(
        model::WithMoved(*model::WithGeometry(*element, FacadeGeometry(name, now.plane, solved)),
                         MovedFacade(name, now, solved)));
  });
  changed.estimate = std::make_shared<const camera::Estimate>(std::move(chosen));
  fired.edit.replaced.push_back(WithPhotograph(**found, std::move(changed)));
  return fired;
}

constexpr Key kCalibrateKeys[] = {
    {"method", Type::kWord, "how: all at once by likelihood, or a method to compare with",
     "likelihood|sweep|paper|dlt|orthocentre", "likelihood"},
    {"skew",
     Type::kRange,
     "the skew angles that sweep and paper try; with likelihood, those of which χ² is told",
     {},
     "88deg..92deg"},
    {"step", Type::kAngle, "from one of these to the next", {}, "0.01deg"},
    {"robust", Type::kBoolean, "trust traces less that lie far off", {}, "false"},
    {"trials", Type::kCount, "also resample the dots so many times (the paper's Step I)", {}, "0"}};
constexpr Key kRecoverKeys[] = {
    {"photo", Type::kElement, "the photograph; the one last attached or set without"},
    {"facade", Type::kName, "the facade that is before the camera"},
    {"near", Type::kPoint, "about where the camera stood"}};

#define TRANOS_HALL                                                              \
  "attach photo \"facade.png\" format=36mm,24.0075mm as hall\n"                  \
  "trace edge from=[0,0,0] to=[10,0,0] dot=294.55,965.37 dot=759.31,986.42\n"    \
  "trace edge from=[0,0,6] to=[10,0,6] dot=312.18,655.51 dot=758.21,628.27\n"    \
  "trace edge from=[0,0,0] to=[0,0,6] dot=294.55,965.37 dot=312.18,655.51\n"     \
  "trace edge from=[10,0,0] to=[10,0,6] dot=759.31,986.42 dot=758.21,628.27\n"   \
  "trace edge from=[10,0,0] to=[10,14,0] dot=759.31,986.42 dot=1014.05,948.66\n" \
  "trace edge from=[10,0,6] to=[10,14,6] dot=758.21,628.27 dot=1005.25,704.29\n" \
  "trace edge from=[10,14,0] to=[10,14,6] dot=1014.05,948.66 dot=1005.25,704.29\n"

constexpr Example kCalibrateExamples[] = {
    {TRANOS_HALL "calibrate", "hall.focal consistent 35mm"},
    {TRANOS_HALL "calibrate method=sweep skew=88.5deg..89.5deg step=0.05deg",
     "hall.focal within 35mm +- 1mm"},
    {TRANOS_HALL "calibrate robust=true trials=10", "hall.determined"},
    {"calibrate", "E0901"}};
constexpr Example kRecoverExamples[] = {
    {"place camera f=35mm format=36mm,24mm size=1600,1067 xy=10,-30,2 as paper\n"
     "set camera paper\n"
     "trace rectangle a=6m b=4m facade=front\n"
     "dot=600,700 dot=1000,700 dot=1000,433 dot=600,433\n"
     "recover camera photo=paper facade=front",
     "paper.y == -30m"},
    {TRANOS_HALL "calibrate; recover camera facade=front", "E0201"},
    {TRANOS_HALL "calibrate; recover camera near=[20,-25,2]", "hall.y < -20m"},
    {"recover camera facade=front", "E0901"}};
#undef TRANOS_HALL

constexpr Command kCommands[] = {
    {.words = "calibrate",
     .family = "photograph",
     .summary = "Finds the cameras of all photographs attached before it, and the unknowns, from "
                "everything traced.",
     .keys = kCalibrateKeys,
     .examples = kCalibrateExamples,
     .calibrates = true},
    {.words = "recover camera",
     .family = "photograph",
     .summary = "Of the poses that explain what was traced, takes the one with the facade before "
                "the camera, or the one nearest to where it is said to have stood.",
     .keys = kRecoverKeys,
     .examples = kRecoverExamples,
     .execute = RecoverCamera},
};

}  // namespace

std::span<const Command> CalibrateCommands() { return kCommands; }

}  // namespace tranos::interp
