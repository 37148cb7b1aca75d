// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/calibrate.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "camera/determination.h"
#include "camera/estimation.h"
#include "camera/likelihood.h"
#include "camera/start.h"
#include "camera/statistics.h"
#include "camera/trace_checks.h"

namespace tranos::camera {

namespace {

using geom::Error;
using geom::ErrorCode;

Eigen::VectorXd StartsOf(std::span<const Unknown> unknowns) {
  Eigen::VectorXd u(unknowns.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    u[i] = std::clamp(unknowns[i].start, unknowns[i].min, unknowns[i].max);
  }
  return u;
}

// The same numbers whatever the unknowns are.
NumbersOfUnknowns Constant(const Numbers& numbers) {
  return [&numbers](const Eigen::VectorXd&) -> geom::Result<Numbers> { return numbers; };
}

// Angles as they are told, without whole turns.
void Unwind(Eigen::VectorXd& state, int cameras) {
  for (int p = 0; p < cameras; ++p) {
    const Camera camera = CameraAt(state, p);
    const Camera plain = CameraOf(FrameFromCamera(camera.parameters),
                                  CameraFromWorld(camera.parameters), camera.position_m());
    state.segment<4>(kParameters * p + kSkew) = plain.parameters.segment<4>(kSkew);
  }
}

// What an adjustment is about.
struct Task {
  std::span<const Photograph> photographs;
  std::span<const Unknown> unknowns;
  const NumbersOfUnknowns& numbers_of;
  Layout layout;
  RefineOptions refine;

  bool needs_camera_alone() const {
    return photographs.size() == 1 && unknowns.empty() && refine.loss == Loss::kNone &&
           refine.noise_scale == 1 && NeedsCameraAlone(photographs[0]);
  }
};

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
  if (task.needs_camera_alone()) return RefineAlone(task, numbers, cameras[0]);
  return Refine(task.photographs, task.unknowns, task.layout, task.numbers_of,
                StartState(task.photographs, task.layout, numbers, cameras, u), task.refine);
}

// From a state that is nearly right.
geom::Result<Refined> RefineAgain(const Task& task, const Refined& near) {
  if (task.needs_camera_alone()) return RefineAlone(task, near.numbers, CameraAt(near.state, 0));
  return Refine(task.photographs, task.unknowns, task.layout, task.numbers_of, near.state,
                task.refine);
}

bool SeesAll(const Task& task, const Refined& refined) {
  for (int p = 0; p < task.layout.cameras; ++p) {
    if (!SeesTraces(task.photographs[p], refined.numbers, CameraAt(refined.state, p))) return false;
  }
  return SeesFacades(task.photographs, task.layout, refined.numbers, refined.state);
}

// Poses of one photograph, that of least cost first; those that see what is traced before others.
geom::Result<std::vector<Refined>> Poses(const Task& task, const Numbers& numbers,
                                         const Eigen::VectorXd& u, std::span<const Camera> starts) {
  std::vector<Refined> seeing, others;
  Error failure{ErrorCode::kDegenerate, "too little is traced to find a camera from"};
  Task rough = task;
  rough.refine.is_rough = true;
  for (const Camera& start : starts) {
    geom::Result<Refined> refined = RefineFrom(rough, numbers, {&start, 1}, u);
    if (!refined) {
      failure = refined.error();
      continue;
    }
    Unwind(refined->state, 1);
    (SeesAll(task, *refined) ? seeing : others).push_back(std::move(*refined));
  }
  const auto by_cost = [](const Refined& a, const Refined& b) { return a.cost < b.cost; };
  std::ranges::stable_sort(seeing, by_cost);
  std::ranges::stable_sort(others, by_cost);
  seeing.insert(seeing.end(), std::make_move_iterator(others.begin()),
                std::make_move_iterator(others.end()));
  if (seeing.empty()) return tl::unexpected(failure);
  return seeing;
}

bool AreOnePose(const Camera& a, const Camera& b) {
  const Mat3 turn = CameraFromWorld(a.parameters) * CameraFromWorld(b.parameters).transpose();
  const double distance = (a.position_m() - b.position_m()).norm();
  return Eigen::AngleAxisd(turn).angle() < 1e-3 && distance < 1e-3 * (1 + a.position_m().norm());
}

bool IsOne(const Refined& a, const Refined& b) {
  return AreOnePose(CameraAt(a.state, 0), CameraAt(b.state, 0));
}

// Whether priors and data leave nothing of a camera open but, perhaps, where it stood.
bool HasView(const Task& task, const Refined& refined) {
  const auto at = Linearise(task.photographs, task.unknowns, task.layout, refined.numbers,
                            refined.state, task.refine.noise_scale);
  if (!at) return false;
  const std::vector<bool> determined =
      DeterminedOf(task.photographs, task.unknowns, task.layout, refined, *at)
          .determination.with_priors;
  for (int i = 0; i < task.layout.unknown_column(); ++i) {
    if (i % kParameters < kX0 && !determined[i]) return false;
  }
  return true;
}

// The photograph with something plausible assumed of each intrinsic parameter that has no prior,
// about where a start has it.
Photograph Anchored(Photograph photograph, const Camera& start) {
  const double width = photograph.frame.size_mm.x();
  const bool is_usual = start[kFocal] > 0.3 * width && start[kFocal] < 10 * width;
  const Prior usual[kIntrinsics] = {
      is_usual ? Prior{start[kFocal], 0.2 * start[kFocal]} : Prior{1.1 * width, 0.3 * width},
      {1, 0.1},
      {0, 0.1 * width},
      {0, 0.1 * width},
      {kPi / 2, 2 * kPi / 180}};
  for (int i = 0; i < kIntrinsics; ++i) {
    if (!(photograph.priors[i].sigma > 0)) photograph.priors[i] = usual[i];
  }
  return photograph;
}

// The least χ² itself, where the data are weak but leave no direction free and it is as plausible
// as the place in the valley that it is reached from.
std::optional<Refined> LeastNearby(const Task& task, const Refined& near, const Camera& start) {
  const auto at = Linearise(task.photographs, task.unknowns, task.layout, near.numbers, near.state,
                            task.refine.noise_scale);
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
// Nothing where the data leave nothing open.
std::optional<Refined> InValley(const Task& task, const Numbers& numbers, const Eigen::VectorXd& u,
                                std::span<const Camera> starts) {
  Task rough = task;
  rough.refine.is_rough = true;
  const auto first = RefineFrom(rough, numbers, starts.first(1), u);
  if (!first || HasView(task, *first)) return {};
  Photograph photograph = Anchored(task.photographs[0], starts[0]);
  const std::span<const Photograph> one(&photograph, 1);
  const Task anchored{one, task.unknowns, task.numbers_of, LayoutOf(one, task.unknowns),
                      task.refine};
  const auto poses = Poses(anchored, numbers, u, starts);
  if (!poses) return {};
  Refined near = poses->front();
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
  if (auto least = LeastNearby(task, near, starts[0])) near = std::move(*least);
  Unwind(near.state, 1);
  return near;
}

struct Adjusted {
  Refined best;
  std::vector<Refined> others;  // poses within noise, of a single photograph
};

geom::Result<Adjusted> AdjustOne(const Task& task, const Numbers& numbers,
                                 const Eigen::VectorXd& u) {
  constexpr double kWithinNoise = 9;
  const std::vector<Camera> starts = Starts(task.photographs[0], numbers);
  if (starts.empty()) {
    return tl::unexpected(
        Error{ErrorCode::kDegenerate, "too little is traced to find a camera from"});
  }
  if (auto open = InValley(task, numbers, u, starts)) return Adjusted{std::move(*open), {}};
  const auto poses = Poses(task, numbers, u, starts);
  if (!poses) return tl::unexpected(poses.error());
  // Rough ones may still come down so far.
  const double most = poses->front().cost + 2 * kWithinNoise;
  std::vector<Refined> refined;
  for (const Refined& pose : *poses) {
    const auto is_known = [&](const Refined& other) { return IsOne(pose, other); };
    const bool is_other = pose.cost <= most && SeesAll(task, pose);
    if (!refined.empty() && (!is_other || std::ranges::any_of(refined, is_known))) continue;
    geom::Result<Refined> again = RefineAgain(task, pose);
    if (!again) continue;
    Unwind(again->state, 1);
    refined.push_back(std::move(*again));
  }
  if (refined.empty()) return tl::unexpected(Error{ErrorCode::kDegenerate, "no camera fits"});
  std::ranges::stable_sort(refined, {}, &Refined::cost);
  Adjusted adjusted{std::move(refined.front()), {}};
  for (std::size_t i = 1; i < refined.size(); ++i) {
    Refined& pose = refined[i];
    const auto is_known = [&](const Refined& other) { return IsOne(pose, other); };
    if (pose.cost <= adjusted.best.cost + kWithinNoise && SeesAll(task, pose) &&
        !is_known(adjusted.best) && std::ranges::none_of(adjusted.others, is_known)) {
      adjusted.others.push_back(std::move(pose));
    }
  }
  return adjusted;
}

// Each photograph's own pose, and all photographs together from these.
geom::Result<Adjusted> Adjust(const Task& task, const Numbers& numbers, const Eigen::VectorXd& u) {
  if (task.photographs.size() == 1) return AdjustOne(task, numbers, u);
  std::vector<Camera> cameras;
  int traces_before = 0;
  for (const Photograph& photograph : task.photographs) {
    const std::span<const Photograph> one(&photograph, 1);
    const auto alone =
        AdjustOne({one, task.unknowns, task.numbers_of, LayoutOf(one, task.unknowns), task.refine},
                  numbers, u);
    if (!alone) {
      Error error = alone.error();
      if (error.part >= 0) error.part += traces_before;
      return tl::unexpected(std::move(error));
    }
    traces_before += static_cast<int>(photograph.traces.size());
    cameras.push_back(CameraAt(alone->best.state, 0));
  }
  auto refined = RefineFrom(task, numbers, cameras, u);
  if (!refined) return tl::unexpected(refined.error());
  Unwind(refined->state, task.layout.cameras);
  return Adjusted{std::move(*refined), {}};
}

// The misfit of dots by their stated deviations, and the degrees of freedom that are theirs.
struct DotNoise {
  double variance = 1;  // in units of the stated one
  double dof = 0;
};

DotNoise DotNoiseOf(const Task& task, const Refined& refined) {
  const auto at = Linearise(task.photographs, task.unknowns, task.layout, refined.numbers,
                            refined.state, task.refine.noise_scale);
  if (!at) return {};
  const Determined determined =
      DeterminedOf(task.photographs, task.unknowns, task.layout, refined, *at);
  // Each prior takes as many of the parameters upon itself as it has a share in them.
  double taken = determined.determination.rank;
  const int priors = task.layout.rows() - task.layout.trace_rows;
  const auto rows = at->jacobian.bottomRows(priors);
  taken -= (rows * determined.determination.inverse_information * rows.transpose()).trace();
  const double chi2 = at->residuals.head(task.layout.trace_rows).squaredNorm();
  const double dof = task.layout.trace_rows - taken;
  return {dof > 0.5 ? chi2 / dof : 1, dof};
}

// Scales the noise until the dots' misfit is what it should be. The scale moves the solution only
// where there are priors.
geom::Result<DotNoise> EstimateNoise(Task& task, Adjusted& adjusted) {
  constexpr int kRounds = 20;
  DotNoise noise;
  for (int i = 0; i < kRounds; ++i) {
    noise = DotNoiseOf(task, adjusted.best);
    // Exact traces leave nothing but rounding.
    const double scale = std::max(std::sqrt(noise.variance), 1e-6);
    task.refine.noise_scale *= scale;
    if (task.layout.rows() > task.layout.trace_rows && HasView(task, adjusted.best)) {
      auto refined = RefineAgain(task, adjusted.best);
      if (!refined) return tl::unexpected(refined.error());
      adjusted.best = std::move(*refined);
    }
    if (std::abs(scale - 1) < 1e-6 || task.refine.noise_scale < 1e-5) break;
  }
  return noise;
}

// The trace or unknown without which the misfit would fall most, for the number of its residuals.
struct Worst {
  std::string name;
  int photograph = -1;
  int trace = -1;  // in the photograph
  int part = -1;   // through all photographs' traces
  double fall = 0;
  std::string rival{};  // what could as well be the one, if any
};

// rᵀ R⁻¹ r, R the block of the redundancy matrix I − J (JᵀJ)⁻¹ Jᵀ: to first order, by how much χ²
// falls when the rows are left out; a square of a studentised residual (Cook and Weisberg,
// Residuals and Influence in Regression, 2.2). What nothing else checks has no part in it.
double FallWithout(const Eigen::MatrixXd& redundancy, const Eigen::VectorXd& residuals) {
  constexpr double kChecked = 1e-6;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(redundancy);
  const Eigen::VectorXd along = solver.eigenvectors().transpose() * residuals;
  double fall = 0;
  for (Eigen::Index i = 0; i < along.size(); ++i) {
    const double checked = solver.eigenvalues()[i];
    if (checked > kChecked) fall += along[i] * along[i] / checked;
  }
  return fall;
}

Worst WorstOf(const Task& task, const Refined& refined, const Linearised& at) {
  const Determined determined =
      DeterminedOf(task.photographs, task.unknowns, task.layout, refined, at);
  const Eigen::MatrixXd& j = determined.jacobian;
  const Eigen::MatrixXd& inverse = determined.determination.inverse_information;
  // Of two that disagree with each other and with nothing else, the later one is named first: what
  // was traced before it did agree.
  constexpr double kAlike = 0.99;
  Worst worst;
  std::vector<Worst> all;
  const auto consider = [&](int first_row, int rows, Worst candidate) {
    const auto block = j.middleRows(first_row, rows);
    const Eigen::MatrixXd redundancy =
        Eigen::MatrixXd::Identity(rows, rows) - block * inverse * block.transpose();
    const double fall = FallWithout(redundancy, at.residuals.segment(first_row, rows)) / rows;
    candidate.fall = fall;
    all.push_back(std::move(candidate));
  };
  for (std::size_t i = 0; i < task.layout.traces.size(); ++i) {
    const TraceRows& rows = task.layout.traces[i];
    consider(rows.first_row, rows.rows,
             {fmt::format("trace {}", i + 1), rows.photograph, rows.trace, static_cast<int>(i)});
  }
  int row = task.layout.trace_rows;
  for (const Unknown& unknown : task.unknowns) {
    if (!(unknown.sigma > 0)) continue;
    consider(row++, 1, {unknown.name.empty() ? "a dimension" : "`" + unknown.name + "`"});
  }
  double most = 0;
  for (const Worst& candidate : all) most = std::max(most, candidate.fall);
  for (Worst& candidate : all) {
    if (candidate.fall < kAlike * most) continue;
    candidate.rival = worst.name;
    worst = std::move(candidate);
  }
  return worst;
}

std::string Disagreement(const Task& task, const Worst& worst, double chi2, int dof) {
  const bool is_direction =
      worst.trace >= 0 && std::holds_alternative<DirectionTrace>(
                              task.photographs[worst.photograph].traces[worst.trace]);
  return fmt::format(
      "{}: χ² is {:.4g} with {} degrees of freedom, and {} is farthest off{}",
      is_direction ? "the edges' directions are not parallel or orthogonal as they are said to be, "
                     "or the noise is larger than stated"
                   : "dimensions and traces disagree, or the noise is larger than stated",
      chi2, dof, worst.name,
      worst.rival.empty() ? "" : fmt::format("; without {} the rest agrees as well", worst.rival));
}

void Scatter(ImageLine& line, NormalNumbers& noise) {
  const Vec2 along = (line.b_px - line.a_px).normalized(), across(-along.y(), along.x());
  const double centre = line.centre_sigma_px * noise.Next(),
               tilt = line.tilt_sigma_px * noise.Next();
  line.a_px += (centre - 0.5 * tilt) * across;
  line.b_px += (centre + 0.5 * tilt) * across;
}

// Another drawing of everything that was measured or assumed, about what was.
void Scatter(Photograph& photograph, double scale, NormalNumbers& noise) {
  for (Trace& trace : photograph.traces) {
    std::visit(
        [&](auto& t) {
          if constexpr (requires { t.line; }) {
            ImageLine scaled = t.line;
            scaled.centre_sigma_px *= scale, scaled.tilt_sigma_px *= scale;
            Scatter(scaled, noise);
            t.line.a_px = scaled.a_px, t.line.b_px = scaled.b_px;
          } else {
            const auto move = [&](Vec2& dot) {
              dot.x() += scale * t.sigma_px * noise.Next();
              dot.y() += scale * t.sigma_px * noise.Next();
            };
            if constexpr (requires { t.dots_px; }) {
              for (Vec2& dot : t.dots_px) move(dot);
            } else {
              move(t.dot_px);
            }
          }
        },
        trace);
  }
  for (Prior& prior : photograph.priors) {
    if (prior.sigma > 0) prior.value += prior.sigma * noise.Next();
  }
}

// By photograph; trials that find no camera are not counted.
std::vector<TrialSpread> Trials(const Task& task, const Refined& near, int trials,
                                std::uint64_t seed) {
  NormalNumbers noise(seed);
  std::vector<TrialSpread> spread(task.photographs.size());
  std::vector<ParameterVector> squares(spread.size(), ParameterVector::Zero());
  for (int i = 0; i < trials; ++i) {
    std::vector<Photograph> photographs(task.photographs.begin(), task.photographs.end());
    std::vector<Unknown> unknowns(task.unknowns.begin(), task.unknowns.end());
    for (Photograph& photograph : photographs) Scatter(photograph, task.refine.noise_scale, noise);
    for (Unknown& unknown : unknowns) unknown.start += unknown.sigma * noise.Next();
    auto refined =
        RefineAgain({photographs, unknowns, task.numbers_of, task.layout, task.refine}, near);
    if (!refined) continue;
    Unwind(refined->state, task.layout.cameras);
    for (std::size_t p = 0; p < spread.size(); ++p) {
      const ParameterVector x = CameraAt(refined->state, static_cast<int>(p)).parameters;
      // About the estimate, so that squares of large numbers are not subtracted.
      const ParameterVector d = x - CameraAt(near.state, static_cast<int>(p)).parameters;
      ++spread[p].trials;
      spread[p].mean += d;
      squares[p] += d.cwiseProduct(d);
    }
  }
  for (std::size_t p = 0; p < spread.size(); ++p) {
    TrialSpread& s = spread[p];
    if (s.trials < 2) continue;
    const ParameterVector mean = s.mean / s.trials;
    s.mean = CameraAt(near.state, static_cast<int>(p)).parameters + mean;
    s.deviation = ((squares[p] - s.trials * mean.cwiseProduct(mean)) / (s.trials - 1))
                      .cwiseMax(0)
                      .cwiseSqrt();
  }
  return spread;
}

bool IsSound(const SkewRange& range) {
  return range.step_rad > 0 && std::isfinite(range.at(range.count)) && range.count >= 1 &&
         range.count <= 100'001;
}

// From the estimate outward on both sides, each from its neighbour.
std::vector<ProfilePoint> Profile(const Task& task, const Refined& best, const SkewRange& range) {
  std::vector<ProfilePoint> profile(static_cast<std::size_t>(range.count));
  for (int i = 0; i < range.count; ++i) {
    profile[i] = {range.at(i), std::numeric_limits<double>::infinity()};
  }
  const double here = (best.state[kSkew] - range.from_rad) / range.step_rad;
  const int middle = std::clamp(static_cast<int>(std::lround(here)), 0, range.count - 1);
  for (const int way : {1, -1}) {
    Refined near = best;
    for (int i = way > 0 ? middle : middle - 1; i >= 0 && i < range.count; i += way) {
      Task held = task;
      held.refine.skew_rad = profile[i].alpha_rad;
      auto refined = RefineAgain(held, near);
      if (!refined) break;
      near = std::move(*refined);
      profile[i].chi2 = near.cost;
    }
  }
  return profile;
}

geom::Result<std::vector<Estimate>> Calibrated(std::span<const Photograph> photographs,
                                               std::span<const Unknown> unknowns,
                                               const NumbersOfUnknowns& numbers_of,
                                               const CalibrateOptions& options) {
  if (photographs.empty())
    return tl::unexpected(Error{ErrorCode::kDegenerate, "there is no photograph"});
  if (options.profile && !IsSound(*options.profile)) {
    return tl::unexpected(Error{ErrorCode::kOutOfRange,
                                "the skew's range takes a step above 0 and at most 100000 steps"});
  }
  const Eigen::VectorXd u = StartsOf(unknowns);
  const geom::Result<Numbers> numbers = numbers_of(u);
  if (!numbers) return tl::unexpected(numbers.error());
  if (auto wrong = WrongWith(photographs, *numbers)) return tl::unexpected(*wrong);
  Task task{photographs,
            unknowns,
            numbers_of,
            LayoutOf(photographs, unknowns),
            {.loss = options.loss, .noise_scale = 1, .skew_rad = {}}};
  auto adjusted = Adjust(task, *numbers, u);
  if (!adjusted) return tl::unexpected(adjusted.error());
  std::vector<std::string> warnings;
  DotNoise noise;
  bool noise_is_estimated = false;
  if (options.noise_is_estimated) {
    noise = DotNoiseOf(task, adjusted->best);
    noise_is_estimated = noise.dof > 0.5;
    if (noise_is_estimated) {
      const auto estimated = EstimateNoise(task, *adjusted);
      if (!estimated) return tl::unexpected(estimated.error());
      noise = *estimated;
    } else {
      warnings.push_back(
          "nothing is traced beyond what the camera needs, so the noise cannot be "
          "estimated: it is taken as stated");
    }
  }
  auto at = Linearise(photographs, unknowns, task.layout, adjusted->best.numbers,
                      adjusted->best.state, task.refine.noise_scale);
  if (!at) return tl::unexpected(at.error());
  if (!SeesAll(task, adjusted->best)) {
    warnings.push_back("every camera that fits has some of what is traced behind it");
  }
  std::vector<Estimate> estimates =
      EstimatesOf(photographs, unknowns, task.layout, adjusted->best, *at);
  Estimate& first = estimates.front();
  const int dof = first.dof;
  const double chi2 = at->residuals.squaredNorm();
  if (dof > 0 && ChiSquaredTail(chi2, dof) < 1e-6 && !noise_is_estimated) {
    const Worst worst = WorstOf(task, adjusted->best, *at);
    const std::string text = Disagreement(task, worst, chi2, dof);
    if (chi2 > 100.0 * dof && options.loss == Loss::kNone)
      return tl::unexpected(Error{ErrorCode::kOutOfRange, text, worst.part});
    warnings.push_back(text);
  }
  for (std::size_t i = 0; i < adjusted->others.size() && first.determined(); ++i) {
    Refined& other = adjusted->others[i];
    const auto there = Linearise(photographs, unknowns, task.layout, other.numbers, other.state,
                                 task.refine.noise_scale);
    if (!there) continue;
    const std::vector<Estimate> of_other =
        EstimatesOf(photographs, unknowns, task.layout, other, *there);
    first.alternatives.push_back({of_other[0].camera, of_other[0].chi2, of_other[0].covariance});
  }
  const std::vector<TrialSpread> trials =
      options.trials > 0 ? Trials(task, adjusted->best, options.trials, options.seed)
                         : std::vector<TrialSpread>(photographs.size());
  for (std::size_t p = 0; p < estimates.size(); ++p) {
    Estimate& estimate = estimates[p];
    estimate.noise_px = options.noise_px * task.refine.noise_scale;
    estimate.noise_is_estimated = noise_is_estimated;
    if (noise_is_estimated) {
      estimate.dof = std::max(1, static_cast<int>(std::lround(noise.dof)));
      estimate.quantile95 = StudentQuantile(0.975, noise.dof);
    }
    estimate.trials = trials[p];
    for (int i = 0; i < kParameters; ++i) {
      if (!estimate.parameters[i].free()) continue;
      estimate.trials.mean[i] = estimate.trials.deviation[i] =
          std::numeric_limits<double>::quiet_NaN();
    }
    estimate.warnings.insert(estimate.warnings.begin(), warnings.begin(), warnings.end());
  }
  if (options.profile) first.profile = Profile(task, adjusted->best, *options.profile);
  return estimates;
}

}  // namespace

geom::Result<std::vector<Estimate>> Calibrate(std::span<const Photograph> photographs,
                                              std::span<const Unknown> unknowns,
                                              const NumbersOfUnknowns& numbers_of,
                                              const CalibrateOptions& options) {
  try {
    return Calibrated(photographs, unknowns, numbers_of, options);
  } catch (const std::exception& e) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, e.what()});
  }
}

geom::Result<Estimate> Calibrate(const Photograph& photograph, const Numbers& numbers,
                                 const CalibrateOptions& options) {
  auto estimates = Calibrate({&photograph, 1}, {}, Constant(numbers), options);
  if (!estimates) return tl::unexpected(estimates.error());
  return std::move(estimates->front());
}

}  // namespace tranos::camera
