// SPDX-License-Identifier: GPL-3.0-or-later
// How long an orthophoto of 4 000 × 3 000 pixels takes, from a photograph of 24 million pixels,
// with a building's colonnade before the facade. Usage: orthophoto_benchmark [THREADS]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "output/orthophoto.h"
#include "tests/output/models.h"

namespace tranos::bench {
namespace {

using geom::Vec3;
constexpr double kDegree = geom::kPi / 180;

model::Orthophoto Large() {
  model::Photograph photograph;
  photograph.frame = {{36, 24}, {6000, 4000}};
  camera::Estimate estimate;
  estimate.camera.parameters << 24, 1.01, 0.2, -0.1, 89 * kDegree, 12 * kDegree, 8 * kDegree,
      1 * kDegree, 26, -48, 4;
  photograph.estimate = std::make_shared<const camera::Estimate>(estimate);
  camera::Photo photo{6000, 4000, {}};
  photo.rgb.resize(std::size_t{3} * 6000 * 4000);
  for (std::size_t i = 0; i < photo.rgb.size(); ++i) {
    photo.rgb[i] = static_cast<std::uint8_t>(i * 2654435761u >> 24);
  }
  std::vector<model::ElementPtr> columns;
  for (int i = 0; i < 12; ++i) {
    columns.push_back(output::WallOf({3.0 * i, -2, 0}, 0.6, 9));
  }
  model::Orthophoto made;
  made.facade = "front";
  made.photograph = output::ElementOf(std::make_shared<const model::Photograph>(photograph));
  made.pixels = std::make_shared<const camera::Photo>(std::move(photo));
  made.plane = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitZ()};
  made.pixel_m = 0.01;
  made.size_px = {4000, 3000};
  made.tolerance_m = 0.02;
  made.standing = std::make_shared<const model::Model>(output::ModelOf(std::move(columns)));
  return made;
}

int Run(int threads) {
  const model::Orthophoto made = Large();
  double least_s = 1e9;
  std::size_t hidden = 0, outside = 0;
  for (int i = 0; i < 7; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const auto rectified = output::Rectify(made, threads);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    if (!rectified) return 1;
    least_s = std::min(least_s, taken.count());
    hidden = rectified->seen.hidden, outside = rectified->seen.outside;
  }
  fmt::print(
      "orthophoto of 4000 × 3000 px, {} threads: {:.3f} s at best of 7 ({:.0f} % hidden, {:.0f} % "
      "outside the photograph)\n",
      threads, least_s, static_cast<double>(hidden) / 120'000,
      static_cast<double>(outside) / 120'000);
  return 0;
}

}  // namespace
}  // namespace tranos::bench

int main(int argc, char** argv) { return tranos::bench::Run(argc > 1 ? std::atoi(argv[1]) : 2); }
