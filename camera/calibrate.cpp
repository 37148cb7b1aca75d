// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/calibrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera/disagreement.h"
#include "camera/estimation.h"
#include "camera/search.h"
#include "camera/statistics.h"
#include "camera/trace_checks.h"
#include "camera/trials.h"

namespace tranos::camera {

namespace {

using geom::Error;
using geom::ErrorCode;

// The same numbers whatever the unknowns are.
NumbersOfUnknowns Constant(const Numbers& numbers) {
  return [&numbers](const Eigen::VectorXd&) -> geom::Result<Numbers> { return numbers; };
}

// The misfit of dots by their stated deviations, and the degrees of freedom that are theirs.
struct DotNoise {
  double variance = 1;  // in units of the stated one
  double dof = 0;
};

DotNoise DotNoiseOf(const Task& task, const Refined& refined) {
  const auto at = LineariseAt(task, refined);
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

std::vector<Estimate> AlternativesOf(const Task& task, std::span<const Refined> others) {
  std::vector<Estimate> alternatives;
  for (const Refined& other : others) {
    const auto at = LineariseAt(task, other);
    if (!at) continue;
    alternatives.push_back(
        EstimatesOf(task.photographs, task.unknowns, task.layout, other, *at).front());
  }
  return alternatives;
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
            LayoutOf(photographs, unknowns, options.given_planes),
            {.loss = options.loss, .noise_scale = 1, .skew_rad = {}}};
  auto adjusted = Adjust(task, *numbers, u);
  if (!adjusted) return tl::unexpected(adjusted.error());
  std::vector<std::string> warnings;
  std::optional<Disagreement> disagreement;
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
  const auto at = LineariseAt(task, adjusted->best);
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
    disagreement = DisagreementAt(task, adjusted->best, *at, chi2, dof);
    if (chi2 > 100.0 * dof && options.loss == Loss::kNone) {
      return tl::unexpected(Error{ErrorCode::kOutOfRange, disagreement->text, disagreement->part,
                                  disagreement->other_part});
    }
  }
  first.alternatives = AlternativesOf(task, adjusted->others);
  const std::vector<TrialSpread> trials =
      options.trials > 0 ? Trials(task, adjusted->best, options.trials, options.seed)
                         : std::vector<TrialSpread>(photographs.size());
  const auto complete = [&](Estimate& estimate) {
    estimate.noise_px = options.noise_px * task.refine.noise_scale;
    estimate.noise_is_estimated = noise_is_estimated;
    if (noise_is_estimated) {
      estimate.dof = std::max(1, static_cast<int>(std::lround(noise.dof)));
      estimate.quantile95 = StudentQuantile(0.975, noise.dof);
    }
    estimate.disagreement = disagreement;
    estimate.warnings.insert(estimate.warnings.begin(), warnings.begin(), warnings.end());
  };
  std::ranges::for_each(estimates, complete);
  std::ranges::for_each(first.alternatives, complete);
  for (std::size_t p = 0; p < estimates.size(); ++p) {
    Estimate& estimate = estimates[p];
    estimate.trials = trials[p];
    for (int i = 0; i < kParameters; ++i) {
      if (!estimate.parameters[i].free()) continue;
      estimate.trials.mean[i] = estimate.trials.deviation[i] =
          std::numeric_limits<double>::quiet_NaN();
    }
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
