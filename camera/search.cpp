// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "camera/estimation.h"
#include "camera/likelihood.h"
#include "camera/pose.h"
#include "camera/space_traces.h"
#include "camera/start.h"
#include "camera/trace_checks.h"

namespace tranos::camera {

namespace {

using geom::Error;
using geom::ErrorCode;

bool FitsAlone(const Task& task) {
  return task.photographs.size() == 1 && task.unknowns.empty() && task.refine.loss == Loss::kNone &&
         task.refine.noise_scale == 1 && NeedsCameraAlone(task.photographs[0]);
}

geom::Result<Refined> RefineAlone(const Task& task, const Numbers& numbers, const Camera& start) {
  const CameraFit fit = FitCamera(task.photographs[0], numbers, start, task.refine.skew_rad);
  if (!std::isfinite(fit.chi2) || !fit.camera.parameters.allFinite()) {
    return tl::unexpected(
        Error{ErrorCode::kDegenerate, "the camera has no image of what is traced"});
  }
  Refined refined;
  refined.state = fit.camera.parameters;
  refined.numbers = numbers;
  refined.chi2 = refined.cost = fit.chi2;
  refined.weights.assign(task.layout.traces.size(), 1.0);
  refined.converged = fit.converged;
  return refined;
}

geom::Result<Refined> RefineFrom(const Task& task, const Numbers& numbers,
                                 std::span<const Camera> cameras, const Eigen::VectorXd& u) {
  if (FitsAlone(task)) return RefineAlone(task, numbers, cameras[0]);
  return Refine(task.photographs, task.unknowns, task.layout, task.numbers_of,
                StartState(task.photographs, task.layout, numbers, cameras, u), task.refine);
}

}  // namespace

Eigen::VectorXd StartsOf(std::span<const Unknown> unknowns) {
  Eigen::VectorXd u(unknowns.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    u[i] = std::clamp(unknowns[i].start, unknowns[i].min, unknowns[i].max);
  }
  return u;
}

geom::Result<Refined> RefineAgain(const Task& task, const Refined& near) {
  if (FitsAlone(task)) return RefineAlone(task, near.numbers, CameraAt(near.state, 0));
  return Refine(task.photographs, task.unknowns, task.layout, task.numbers_of, near.state,
                task.refine);
}

geom::Result<Linearised> LineariseAt(const Task& task, const Refined& refined) {
  return Linearise(task.photographs, task.unknowns, task.layout, refined.numbers, refined.state,
                   task.refine.noise_scale);
}

void Unwind(Eigen::VectorXd& state, int cameras) {
  for (int p = 0; p < cameras; ++p) {
    const Camera camera = CameraAt(state, p);
    const Camera plain = CameraOf(FrameFromCamera(camera.parameters),
                                  CameraFromWorld(camera.parameters), camera.position_m());
    state.segment<4>(kParameters * p + kSkew) = plain.parameters.segment<4>(kSkew);
  }
}

bool SeesAll(const Task& task, const Refined& refined) {
  for (int p = 0; p < task.layout.cameras; ++p) {
    if (!SeesTraces(task.photographs[p], refined.numbers, CameraAt(refined.state, p))) return false;
  }
  return SeesFacades(task.photographs, task.layout, refined.numbers, refined.state);
}

namespace {

// Whether priors and data determine all parameters of cameras that are meant.
bool Determines(const Task& task, const Refined& refined, bool (*is_meant)(int parameter)) {
  const auto at = LineariseAt(task, refined);
  if (!at) return false;
  const std::vector<bool> determined =
      DeterminedOf(task.photographs, task.unknowns, task.layout, refined, *at)
          .determination.with_priors;
  for (int i = 0; i < task.layout.unknown_column(); ++i) {
    if (is_meant(i % kParameters) && !determined[i]) return false;
  }
  return true;
}

}  // namespace

bool HasView(const Task& task, const Refined& refined) {
  return Determines(task, refined, [](int parameter) { return parameter < kX0; });
}

namespace {

bool HasPosition(const Task& task, const Refined& refined) {
  return Determines(task, refined, [](int parameter) { return parameter >= kX0; });
}

bool AreOnePose(const Camera& a, const Camera& b) {
  const Mat3 turn = CameraFromWorld(a.parameters) * CameraFromWorld(b.parameters).transpose();
  const double distance = (a.position_m() - b.position_m()).norm();
  return Eigen::AngleAxisd(turn).angle() < 1e-3 && distance < 1e-3 * (1 + a.position_m().norm());
}

bool IsOne(const Refined& a, const Refined& b) {
  return AreOnePose(CameraAt(a.state, 0), CameraAt(b.state, 0));
}

constexpr double kWithinNoise = 9;

// A pose is another one if it is not yet known and sees what is traced. Where it is open how far
// off the camera stood there is none, for so is which way it looked along an axis.
void AddOther(const Task& task, const Refined& best, Refined pose, std::vector<Refined>* others) {
  const Photograph& photograph = task.photographs[0];
  const bool has_place =
      HasPosition(task, best) || std::ranges::any_of(photograph.traces, [](const Trace& trace) {
        const auto* rectangle = std::get_if<RectangleTrace>(&trace);
        return rectangle && rectangle->facade == 0;
      });
  const auto is_known = [&](const Refined& other) { return IsOne(pose, other); };
  if (!has_place || is_known(best) || std::ranges::any_of(*others, is_known)) return;
  if (SeesAll(task, pose)) others->push_back(std::move(pose));
}

// The starts with all unknowns held, by the camera's own Gauss–Newton, and those that come down to
// the same pose once: most do, and a joint adjustment takes a hundred times as long.
std::vector<Camera> Settled(const Task& task, const Numbers& numbers,
                            std::span<const Camera> starts) {
  const Photograph& photograph = task.photographs[0];
  const bool is_quick = task.refine.loss == Loss::kNone && NeedsCameraAlone(photograph);
  if (!is_quick || FitsAlone(task)) return {starts.begin(), starts.end()};
  std::vector<Camera> settled;
  for (const Camera& start : starts) {
    const CameraFit fit = FitCamera(photograph, numbers, start, task.refine.skew_rad);
    const bool is_sound = std::isfinite(fit.chi2) && fit.camera.parameters.allFinite() &&
                          SeesTraces(photograph, numbers, fit.camera);
    const Camera& camera = is_sound ? fit.camera : start;
    const auto is_known = [&](const Camera& other) { return AreOnePose(camera, other); };
    if (std::ranges::none_of(settled, is_known)) settled.push_back(camera);
  }
  return settled;
}

// Poses of one photograph, refined roughly.
struct Poses {
  std::vector<Refined> seeing{}, others{};  // by whether they have what is traced before them
  Error failure{ErrorCode::kDegenerate, "too little is traced to find a camera from"};

  void Add(Task task, const Numbers& numbers, const Eigen::VectorXd& u,
           std::span<const Camera> starts) {
    task.refine.is_rough = true;
    for (const Camera& start : starts) {
      geom::Result<Refined> refined = RefineFrom(task, numbers, {&start, 1}, u);
      if (!refined) {
        failure = refined.error();
        continue;
      }
      Unwind(refined->state, 1);
      (SeesAll(task, *refined) ? seeing : others).push_back(std::move(*refined));
    }
  }
  // Those that see first, each kind by its cost.
  std::vector<Refined> Sorted() && {
    std::ranges::stable_sort(seeing, {}, &Refined::cost);
    std::ranges::stable_sort(others, {}, &Refined::cost);
    std::ranges::move(others, std::back_inserter(seeing));
    return std::move(seeing);
  }
};

// The least χ² itself, where the data are weak but leave no direction free and it is as plausible
// as the place in the valley that it is reached from.
std::optional<Refined> LeastNearby(const Task& task, const Refined& near, const Camera& start) {
  const auto at = LineariseAt(task, near);
  if (!at) return {};
  const Determined determined =
      DeterminedOf(task.photographs, task.unknowns, task.layout, near, *at);
  if (determined.determination.rank < task.layout.columns) return {};
  auto least = RefineAgain(task, near);
  if (!least || !SeesAll(task, *least)) return {};
  const Photograph plausible = Anchored(task.photographs[0], start);
  for (int i = 0; i < kIntrinsics; ++i) {
    const bool is_stated = task.photographs[0].priors[i].sigma > 0;
    if (!is_stated && !(std::abs(least->state[i] - near.state[i]) < plausible.priors[i].sigma))
      return {};
  }
  return std::move(*least);
}

// Where the data leave a camera open, the valley of least χ² leads to where pictures vanish, and
// what is open there is not what is open of a camera. So the verdict is given at a plausible
// camera of the valley; that much is assumed to find it, and nothing of what is told rests on it.
std::optional<Adjusted> InValley(const Task& task, const Numbers& numbers, const Eigen::VectorXd& u,
                                 std::span<const Camera> starts) {
  Photograph photograph = Anchored(task.photographs[0], starts[0]);
  const std::span<const Photograph> one(&photograph, 1);
  const Task anchored{one, task.unknowns, task.numbers_of,
                      LayoutOf(one, task.unknowns, task.layout.facade_number), task.refine};
  Poses poses;
  poses.Add(anchored, numbers, u, Settled(anchored, numbers, starts));
  const std::vector<Refined> found = std::move(poses).Sorted();
  if (found.empty()) return {};
  Adjusted valley{found.front(), {}};
  Refined& near = valley.best;
  // What is determined comes free of the assumptions when these follow the camera; along the valley
  // nothing moves it then.
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < kIntrinsics && round > 0; ++i) {
      if (!(task.photographs[0].priors[i].sigma > 0)) photograph.priors[i].value = near.state[i];
    }
    auto refined = RefineAgain(anchored, near);
    if (!refined) return {};
    near = std::move(*refined);
  }
  if (HasView(task, near)) return {};
  // Another pose is one that the same camera could have had.
  for (const Refined& pose : found) {
    const auto is_known = [&](const Refined& other) { return IsOne(pose, other); };
    if (is_known(near) || pose.cost > found.front().cost + 2 * kWithinNoise) continue;
    auto other = RefineAgain(anchored, pose);
    if (!other || other->cost > near.cost + kWithinNoise) continue;
    Unwind(other->state, 1);
    AddOther(anchored, near, std::move(*other), &valley.others);
  }
  if (auto least = LeastNearby(task, near, starts[0])) near = std::move(*least);
  Unwind(near.state, 1);
  return valley;
}

// The poses of these that may be within noise of the first, adjusted to the end, by their cost.
// Rough ones may still come down a little.
std::vector<Refined> Settle(const Task& task, const std::vector<Refined>& found) {
  std::vector<Refined> refined;
  for (const Refined& pose : found) {
    const auto is_known = [&](const Refined& other) { return IsOne(pose, other); };
    const bool is_other = pose.cost <= found.front().cost + 2 * kWithinNoise && SeesAll(task, pose);
    if (!refined.empty() && (!is_other || std::ranges::any_of(refined, is_known))) continue;
    geom::Result<Refined> again = RefineAgain(task, pose);
    if (!again) continue;
    Unwind(again->state, 1);
    refined.push_back(std::move(*again));
  }
  std::ranges::stable_sort(refined, {}, &Refined::cost);
  return refined;
}

// A photograph with those of its traces that no unknown moves.
Photograph WithoutUnknowns(const Task& task, const Linearised& at) {
  Photograph photograph = task.photographs[0];
  photograph.traces.clear();
  for (const TraceRows& rows : task.layout.traces) {
    const auto by_unknown = at.jacobian.block(rows.first_row, task.layout.unknown_column(),
                                              rows.rows, task.layout.unknowns);
    if (by_unknown.isZero(0)) photograph.traces.push_back(task.photographs[0].traces[rows.trace]);
  }
  return photograph;
}

// What another look finds, from the solved unknowns and from traces that these do not move: where
// their starts were far off, or one of two poses has others, only one may have been in reach.
void LookAgain(const Task& task, std::vector<Refined>* refined) {
  const Refined best = refined->front();
  const auto at = LineariseAt(task, best);
  if (!at) return;
  const Eigen::VectorXd u = best.state.segment(task.layout.unknown_column(), task.layout.unknowns);
  std::vector<Camera> starts =
      Settled(task, best.numbers, Starts(task.photographs[0], best.numbers));
  const Photograph without = WithoutUnknowns(task, *at);
  if (without.traces.size() < task.photographs[0].traces.size()) {
    Task settling = task;
    settling.photographs = {&without, 1};
    std::ranges::move(Settled(settling, best.numbers, Starts(without, best.numbers)),
                      std::back_inserter(starts));
  }
  std::erase_if(starts, [&](const Camera& start) {
    return std::ranges::any_of(*refined, [&](const Refined& known) {
      return AreOnePose(start, CameraAt(known.state, 0));
    });
  });
  Poses poses;
  poses.Add(task, best.numbers, u, starts);
  // A rough pose may still come down, but one that fits far worse than what is known does not get
  // there, and creeps along its valley.
  const bool sees = SeesAll(task, best);
  std::erase_if(poses.seeing, [&](const Refined& pose) {
    return sees && pose.cost > 2 * best.cost + 2 * kWithinNoise;
  });
  std::ranges::stable_sort(poses.seeing, {}, &Refined::cost);
  std::vector<Refined> more = Settle(task, poses.seeing);
  if (more.empty()) return;
  if (!sees) refined->clear();
  std::ranges::move(more, std::back_inserter(*refined));
  std::ranges::stable_sort(*refined, {}, &Refined::cost);
}

// Brings a usual pose to the front where others are equal but for rounding: what is traced may not
// tell the signs of the axes.
void PreferUsual(std::vector<Refined>* refined) {
  const double equal = refined->front().cost * (1 + 1e-6) + 1e-6;
  const auto usual = std::ranges::find_if(*refined, [&](const Refined& pose) {
    return pose.cost <= equal && IsUsual(CameraFromWorld(CameraAt(pose.state, 0).parameters));
  });
  if (usual != refined->end()) std::rotate(refined->begin(), usual, usual + 1);
}

geom::Result<Adjusted> AdjustOne(const Task& task, const Numbers& numbers,
                                 const Eigen::VectorXd& u) {
  const std::vector<Camera> starts = Starts(task.photographs[0], numbers);
  if (starts.empty()) {
    return tl::unexpected(
        Error{ErrorCode::kDegenerate, "too little is traced to find a camera from"});
  }
  const std::vector<Camera> settled = Settled(task, numbers, starts);
  const std::span<const Camera> all(settled);
  Poses poses;
  poses.Add(task, numbers, u, all.first(1));
  const auto& first = poses.seeing.empty() ? poses.others : poses.seeing;
  if (!first.empty() && !HasView(task, first[0])) {
    if (auto open = InValley(task, numbers, u, starts)) return *std::move(open);
  }
  poses.Add(task, numbers, u, all.subspan(1));
  const Error failure = poses.failure;
  const std::vector<Refined> found = std::move(poses).Sorted();
  if (found.empty()) return tl::unexpected(failure);
  std::vector<Refined> refined = Settle(task, found);
  if (!refined.empty() && !task.unknowns.empty()) LookAgain(task, &refined);
  if (refined.empty()) return tl::unexpected(Error{ErrorCode::kDegenerate, "no camera fits"});
  PreferUsual(&refined);
  Adjusted adjusted{std::move(refined.front()), {}};
  for (std::size_t i = 1; i < refined.size(); ++i) {
    if (refined[i].cost > adjusted.best.cost + kWithinNoise) break;
    AddOther(task, adjusted.best, std::move(refined[i]), &adjusted.others);
  }
  return adjusted;
}

}  // namespace

geom::Result<Adjusted> Adjust(const Task& task, const Numbers& numbers, const Eigen::VectorXd& u) {
  if (task.photographs.size() == 1) return AdjustOne(task, numbers, u);
  std::vector<Camera> cameras;
  for (const Photograph& photograph : task.photographs) {
    const std::span<const Photograph> one(&photograph, 1);
    const auto alone =
        AdjustOne({one, task.unknowns, task.numbers_of,
                   LayoutOf(one, task.unknowns, task.layout.facade_number), task.refine},
                  numbers, u);
    if (!alone) {
      return tl::unexpected(ErrorAmong(task.photographs, std::ssize(cameras), alone.error()));
    }
    cameras.push_back(CameraAt(alone->best.state, 0));
  }
  auto refined = RefineFrom(task, numbers, cameras, u);
  if (!refined) return tl::unexpected(refined.error());
  Unwind(refined->state, task.layout.cameras);
  return Adjusted{std::move(*refined), {}};
}

}  // namespace tranos::camera
