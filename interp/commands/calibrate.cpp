// SPDX-License-Identifier: GPL-3.0-or-later
// calibrate and recover camera. The solving itself is the machine's (calibration.cpp), for it runs
// what stands before.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/commands/photographs.h"

namespace tranos::interp {

using model::State;

namespace {

// Of the poses that explain the traces, the one that is asked for. Facades face the negative Y.
CommandResult RecoverCamera(const State& state, const Answers& answers) {
  const auto found = PhotographMeant(state, answers);
  if (!found) return Fail(found.error());
  model::Photograph changed = PhotographOf(**found);
  if (!changed.estimate) return Fail(NoCameraYet(**found));
  camera::Estimate estimate = *changed.estimate;
  const auto near = answers.Point("near");
  const auto score = [&](const camera::Camera& camera) {
    if (near) return (camera.position_m() - *near).norm();
    return camera[camera::kY0] < 0 ? 0.0 : 1.0;
  };
  auto best = estimate.alternatives.end();
  double least = score(estimate.camera);
  for (auto other = estimate.alternatives.begin(); other != estimate.alternatives.end(); ++other) {
    if (score(other->camera) >= least) continue;
    least = score(other->camera);
    best = other;
  }
  Fired fired;
  if (best == estimate.alternatives.end()) {
    if (!near && least > 0) {
      return Fail({.code = Code::kNotDetermined,
                   .message = "no pose of the camera has the facade before it"});
    }
    return fired;
  }
  std::swap(estimate.camera, best->camera);
  std::swap(estimate.chi2, best->chi2);
  std::swap(estimate.covariance, best->covariance);
  std::swap(estimate.deviations, best->deviations);
  for (int i = 0; i < camera::kParameters && estimate.covariance.size() > 0; ++i) {
    estimate.parameters[i].sigma = std::sqrt(std::max(estimate.covariance(i, i), 0.0));
  }
  changed.estimate = std::make_shared<const camera::Estimate>(std::move(estimate));
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
     "recover camera photo=paper facade=front",
     "paper.y == -30m"},
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
