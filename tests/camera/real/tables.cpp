// SPDX-License-Identifier: GPL-3.0-or-later
// Prints, as Markdown, the cameras found from real photographs beside the true ones.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/camera/real/results.h"

namespace tranos::camera::real {
namespace {

double LargestFinite(const std::vector<double>& errors) {
  double largest = 0;
  for (const double e : errors) {
    if (std::isfinite(e)) largest = std::max(largest, e);
  }
  return largest;
}

void PrintYork(const std::vector<Known>& known) {
  fmt::print("| loss | counted | median | third quartile | 90 % | largest finite |\n");
  fmt::print("|---|---|---|---|---|---|\n");
  constexpr std::pair<Loss, const char*> kLosses[] = {
      {Loss::kNone, "none"}, {Loss::kHuber, "Huber"}, {Loss::kCauchy, "Cauchy"}};
  for (const auto& [loss, name] : kLosses) {
    const std::vector<Found> found = FoundCameras(known, loss);
    const auto print = [&](const std::string& which, Loose loose) {
      const std::vector<double> errors = FocalErrors(found, known, loose);
      const auto percent = [&](double p) { return 100 * Quantile(errors, p); };
      fmt::print("| {} | {} | {:.2f} % | {:.2f} % | {:.2f} % | {:.1f} % |\n", name, which,
                 percent(0.5), percent(0.75), percent(0.9), 100 * LargestFinite(errors));
    };
    print("every one", Loose::kCounts);
    print(fmt::format("infinite error where ± is more than 20 % ({} of {})",
                      std::ranges::count_if(found, &Found::is_loose), found.size()),
          Loose::kInfinite);
  }
}

std::string Focal(const Found& f, const Known& known) {
  if (!f.is_found) return "not found | ∞";
  const double error = 100 * std::abs(f.focal_px / known.focal_px - 1);
  return fmt::format("{:.1f} ± {:.1f} | {:.2f} %", f.focal_px, f.sigma_px, error);
}

void PrintEachOfYork(const std::vector<Known>& known) {
  fmt::print("\n| photograph | edges | noise, px | f, px | error | rotation |\n");
  fmt::print("|---|---|---|---|---|---|\n");
  for (const Known& k : known) {
    const Found f = FoundCamera(TracedEdges(k));
    fmt::print("| {} | {} | {:.2f} | {} | {:.2f}° |\n", f.name, f.edges, f.noise_px, Focal(f, k),
               RotationErrorUpToSigns(f.camera_from_world, k.camera_from_world));
  }
}

void PrintCoverage(const char* name, const std::vector<Known>& known) {
  fmt::print("\n{}: 1.96 deviations of f cover the truth in {:.0f} %.\n", name,
             100 * Coverage(FoundCameras(known), known));
}

void PrintCastle(const std::vector<Known>& known) {
  const std::vector<Found> found = FoundCameras(known);
  const std::vector<double> rotation = RotationErrors(found, known),
                            upright = UprightErrors(found, known),
                            relative = RelativeRotationErrors(found, known);
  fmt::print("\n| photograph | edges | noise, px | f, px | error | rotation | upright |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < found.size(); ++i) {
    fmt::print("| {} | {} | {:.2f} | {} | {:.2f}° | {:.2f}° |\n", found[i].name, found[i].edges,
               found[i].noise_px, Focal(found[i], known[i]), rotation[i], upright[i]);
  }
  fmt::print("| median | | | | {:.2f} % | {:.2f}° | {:.2f}° |\n",
             100 * Quantile(FocalErrors(found, known, Loose::kCounts), 0.5),
             Quantile(rotation, 0.5), Quantile(upright, 0.5));
  fmt::print("\nTurns from one photograph to another, all {} pairs: median {:.2f}°.\n",
             relative.size(), Quantile(relative, 0.5));
}

void PrintSquare(const Known& known) {
  for (const auto& [method, camera] : {std::pair("orthocentre", SquareByOrthocentre(known)),
                                       std::pair("likelihood", SquareByLikelihood(known))}) {
    if (!camera) continue;
    fmt::print("| {} | {} | {:.3f} | {:.3f} | {:.3f}, {:.3f} | {:.3f}, {:.3f} |\n", known.name,
               method, camera->focal_px, known.focal_px, camera->principal_px.x(),
               camera->principal_px.y(), known.principal_px.x(), known.principal_px.y());
  }
}

}  // namespace
}  // namespace tranos::camera::real

int main() {
  using namespace tranos::camera::real;
  const auto data = DataFolder();
  if (!data) {
    std::puts("skipped: no test photographs");
    return 0;
  }
  const std::vector<Known> york = YorkUrban(*data);
  PrintYork(york);
  PrintEachOfYork(york);
  PrintCoverage("York", york);
  PrintCastle(Castle(*data));
  fmt::print("\n| photograph | method | f, px | stated | principal point, px | stated |\n");
  fmt::print("|---|---|---|---|---|---|\n");
  PrintSquare(ShiftedLandscape(*data));
  PrintSquare(Tower(*data));
}
