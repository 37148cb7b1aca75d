// SPDX-License-Identifier: GPL-3.0-or-later
// Measures what is found on real photographs with nothing traced by hand. The photographs lie
// beside the project or in $TRANOS_DATA; where they are not, that is all it says.
//
// Usage: line_benchmark [--each] [--write-docs DOCS]. Prints Markdown; with --each a line for each
// photograph, too; with --write-docs also rewrites the generated blocks of DOCS/camera.md.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <iostream>
#include <numeric>

#include "bench/report.h"
#include "tests/camera/real/facades.h"

namespace tranos::bench {
namespace {

using namespace camera;
using camera::real::Known;

struct Settings {
  bool each = false;
  std::string docs;  // empty: nothing is written
};

// What is known of one photograph's lines, and how long it took.
struct Automatic {
  std::vector<ImageLine> lines;
  std::vector<int> axis;  // empty where it is refused
  double seconds = 0;     // of the processor, from pixels to axes
};

Automatic FoundOn(const Known& known) {
  const Photo photo = real::PhotoOf(known);
  Automatic found;
  const std::clock_t start = std::clock();
  if (auto lines = DetectLines(photo)) found.lines = *std::move(lines);
  if (auto directions = FindVanishingDirections(found.lines, known.frame))
    found.axis = std::move(directions->axis);
  found.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return found;
}

real::Found Solved(const Known& known, const Automatic& lines, const std::vector<int>& axis) {
  return axis.empty() ? real::Found{}
                      : real::FoundCamera(real::TracedLines(known, lines.lines, axis));
}

std::string Percent(double share, int digits = 1) {
  return fmt::format("{:.{}f} %", 100 * share, digits);
}

TableRow RowOf(const std::string& what, const real::Errors& errors) {
  return {what,
          Percent(errors.DirectionsWithin(1)),
          Percent(errors.DirectionsWithin(2)),
          Percent(errors.DirectionsWithin(5)),
          Percent(errors.HorizonArea(0.25), 2),
          Percent(real::Quantile(errors.focal, 0.5)),
          Percent(real::Quantile(errors.focal, 0.75)),
          Percent(real::Quantile(errors.focal, 0.9))};
}

void AddYork(const std::vector<Known>& york, const Settings& settings, Report& report) {
  real::Errors found, directions, labels, labelled;
  std::vector<double> seconds;
  int refused = 0;
  for (const Known& known : york) {
    const Automatic lines = FoundOn(known);
    seconds.push_back(lines.seconds);
    refused += lines.axis.empty();
    found.Add(Solved(known, lines, lines.axis), known);
    directions.Add(Solved(known, lines, real::AxesByDirections(known, lines.lines)), known);
    labels.Add(Solved(known, lines, real::AxesByLabels(known, lines.lines)), known);
    labelled.Add(real::FoundCamera(real::TracedDirections(known)), known);
    if (!settings.each) continue;
    std::array<int, 3> counts{};
    for (const int axis : lines.axis)
      counts[0] += axis == 0, counts[1] += axis == 1, counts[2] += axis == 2;
    fmt::print("{} of {} lines X {} Y {} Z {}", known.name, lines.lines.size(), counts[0],
               counts[1], counts[2]);
    for (const real::Errors* e : {&found, &directions, &labels, &labelled})
      fmt::print(" | {:.2f}° {} {}", e->direction_deg.back(), Percent(e->horizon.back(), 2),
                 Percent(e->focal.back()));
    fmt::print("\n");
  }
  report.Add(
      "york-lines",
      Table({{"York Urban, 51 photographs", "directions ≤ 1°", "≤ 2°", "≤ 5°", "horizon",
              "f, median", "third quartile", "90 %"},
             RowOf("lines and directions found", found),
             RowOf("lines found, directions of the truth", directions),
             RowOf("lines found that are labelled, their labels", labels),
             RowOf("lines labelled by hand", labelled)}) +
          fmt::format(
              "\nRefused: {}. From pixels to axes {:.0f} ms of the processor in the median, "
              "{:.0f} ms at most.\n",
              refused, 1000 * real::Quantile(seconds, 0.5), 1000 * real::Quantile(seconds, 1)));
}

void AddCastle(const std::vector<Known>& castle, const Settings& settings, Report& report) {
  std::vector<real::Found> found;
  for (const Known& known : castle) {
    const Automatic lines = FoundOn(known);
    found.push_back(Solved(known, lines, lines.axis));
    if (settings.each) fmt::print("{} {:.0f} ms\n", known.name, 1000 * lines.seconds);
  }
  const auto focal = real::FocalErrors(found, castle, real::Loose::kCounts);
  const auto rotation = real::RotationErrors(found, castle, 4);
  const auto upright = real::UprightErrors(found, castle);
  const std::vector<Mat3> truth = real::TrueRotations(found, castle, 4);
  std::vector<double> directions;
  for (std::size_t i = 0; i < found.size(); ++i)
    directions.push_back(real::DirectionError(found[i].camera_from_world, truth[i]));
  std::vector<TableRow> rows{{"Castle", "f", "vertical", "directions", "rotation"}};
  const auto degrees = [](double angle) { return fmt::format("{:.2f}°", angle); };
  const auto row = [&](const std::string& name, const auto& of) {
    rows.push_back({name, Percent(of(focal)), degrees(of(upright)), degrees(of(directions)),
                    degrees(of(rotation))});
  };
  for (std::size_t i = 0; i < castle.size(); ++i)
    row(castle[i].name, [&](const std::vector<double>& errors) { return errors[i]; });
  row("median", [](const std::vector<double>& errors) { return real::Quantile(errors, 0.5); });
  report.Add("castle-lines", Table(rows));
}

void AddFronts(const std::vector<real::Front>& fronts, Report& report) {
  std::vector<TableRow> rows{
      {"Street front", "windows", "box filled, mean", "least", "without rectification"}};
  std::vector<double> all, before;
  const auto mean = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  const auto row = [&](const std::string& name, const std::vector<double>& filled,
                       const std::vector<double>& unrectified) {
    rows.push_back({name, fmt::format("{}", filled.size()), fmt::format("{:.3f}", mean(filled)),
                    fmt::format("{:.3f}", *std::ranges::min_element(filled)),
                    fmt::format("{:.3f}", mean(unrectified))});
  };
  for (const real::Front& front : fronts) {
    const Automatic lines = FoundOn(front.photograph);
    const real::Found found = Solved(front.photograph, lines, lines.axis);
    const Mat3 front_from_dot =
        lines.axis.empty() ? Mat3::Identity()
                           : real::FrontFromDot(front.photograph, found, lines.lines, lines.axis);
    std::vector<double> filled, unrectified;
    for (const auto& window : front.windows) {
      filled.push_back(real::BoxFilled(window, front_from_dot));
      unrectified.push_back(real::BoxFilled(window, Mat3::Identity()));
    }
    row(front.photograph.name, filled, unrectified);
    all.insert(all.end(), filled.begin(), filled.end());
    before.insert(before.end(), unrectified.begin(), unrectified.end());
  }
  row("all", all, before);
  report.Add("front-lines", Table(rows));
}

int Main(const std::vector<std::string_view>& words) {
  Settings settings;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--each") {
      settings.each = true;
    } else if (words[i] == "--write-docs" && i + 1 < words.size()) {
      settings.docs = words[++i];
    } else {
      std::cerr << "usage: line_benchmark [--each] [--write-docs DOCS]\n";
      return 2;
    }
  }
  const auto data = real::DataFolder();
  if (!data) {
    std::cout << "skipped: no test photographs\n";
    return 0;
  }
  Report report;
  AddYork(real::YorkUrban(*data), settings, report);
  AddCastle(real::Castle(*data), settings, report);
  AddFronts(real::Fronts(*data), report);
  return settings.docs.empty() || WriteDocs(settings.docs, report) ? 0 : 1;
}

}  // namespace
}  // namespace tranos::bench

int main(int argc, char** argv) { return tranos::bench::Main({argv + 1, argv + argc}); }
