// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/trials.h"

#include "camera/statistics.h"

namespace tranos::camera {

namespace {

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

}  // namespace

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

}  // namespace tranos::camera
