// SPDX-License-Identifier: GPL-3.0-or-later
// An arch on a facade, seen obliquely by a skewed camera, traced many times: for the test and the
// benchmark.
#pragma once

#include "camera/circle_fit.h"
#include "tests/camera/scenes.h"

namespace tranos::camera::scenes {

inline const geom::Frame kCirclePlane{Vec3(1, 0, 0), Vec3::UnitX(), Vec3::UnitZ()};
inline const Vec2 kCircleCentre{5, 4};

inline Camera CircleCamera() {
  Camera camera;
  camera.parameters << 34, 1.02, 0.4, -0.7, 1.555, 0.15, 0.4, 0.02, 14, -24, 1.7;
  return camera;
}

struct CircleView {
  double radius_px = 60;  // the shorter half axis of its image
  int dots = 9;
  double sweep_rad = kPi;  // evenly, from the right over the top
};

inline Vec2 CircleDot(double radius_m, double angle_rad) {
  const Vec2 p = kCircleCentre + radius_m * Vec2(std::cos(angle_rad), std::sin(angle_rad));
  return DotOf(CircleCamera(), {}, kCirclePlane.ToWorld({p.x(), p.y(), 0}));
}

// The radius whose image is that large.
inline double RadiusOf(const CircleView& seen) {
  constexpr double kSmall_m = 1e-3;
  const Vec2 centre = CircleDot(0, 0);
  double least = std::numeric_limits<double>::infinity();
  for (int degrees = 0; degrees < 180; ++degrees) {
    least = std::min(least, (CircleDot(kSmall_m, degrees * kPi / 180) - centre).norm());
  }
  return seen.radius_px * kSmall_m / least;
}

inline std::vector<Vec2> DotsOf(const CircleView& seen, double sigma_px, std::uint64_t seed) {
  Noise noise(seed);
  const double radius_m = RadiusOf(seen);
  const bool is_whole = seen.sweep_rad > 1.99 * kPi;
  std::vector<Vec2> dots_px;
  for (int i = 0; i < seen.dots; ++i) {
    const double t = seen.sweep_rad * i / (is_whole ? seen.dots : seen.dots - 1);
    dots_px.push_back(CircleDot(radius_m, t) + sigma_px * noise.Draw2());
  }
  return dots_px;
}

struct CircleTrials {
  double within_one_per_cent = 0;  // shares of the seeds
  double within_95 = 0;            // of the interval that is stated
  double rms_share = 0;            // of the error, by the radius
};

// Dots with a deviation of half a pixel; trial i has seed i + 1.
inline CircleTrials TrialsOf(const CircleView& seen, int seeds) {
  constexpr double kSigma_px = 0.5;
  const double radius_m = RadiusOf(seen);
  CircleTrials trials;
  for (int i = 0; i < seeds; ++i) {
    const auto fitted =
        FitCircleSeen(CircleCamera(), {}, kCirclePlane,
                      DotsOf(seen, kSigma_px, static_cast<std::uint64_t>(i + 1)), kSigma_px);
    if (!fitted) continue;
    const double error = fitted->radius_m / radius_m - 1;
    const double sigma = std::sqrt(fitted->covariance(2, 2)) / radius_m;
    trials.within_one_per_cent += std::abs(error) <= 0.01 ? 1.0 / seeds : 0;
    trials.within_95 += std::abs(error) <= 1.959963984540054 * sigma ? 1.0 / seeds : 0;
    trials.rms_share += error * error / seeds;
  }
  trials.rms_share = std::sqrt(trials.rms_share);
  return trials;
}

}  // namespace tranos::camera::scenes
