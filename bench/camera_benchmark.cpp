// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's Section 6 as a Monte Carlo: every method on the benchmark's cuboids, against the
// truth, the paper's printed values and the Cramér–Rao bounds; small tilt and pan; speed.
//
// Usage: camera_benchmark [--trials N] [--write-docs DOCS] [PART...]. Prints Markdown; with
// --write-docs also rewrites the generated blocks of DOCS/camera.md and the plots in DOCS/camera.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>

#include "bench/camera_trials.h"
#include "bench/report.h"
#include "bench/svg_plot.h"
#include "camera/likelihood.h"
#include "camera/paper_method.h"
#include "camera/statistics.h"
#include "camera/sweep.h"
#include "tests/camera/circle_trials.h"

namespace tranos::bench {
namespace {

using camera::kFocal;
using camera::kOmega;
using camera::kPhi;
using camera::kPi;
using camera::kSkew;
using camera::kX0;
using camera::Parameter;
using camera::benchmark::CuboidOf;
using camera::benchmark::TraceCuboid;
using camera::benchmark::TracedCuboid;

constexpr double kDegree = kPi / 180;
constexpr const char* kColumns[kParameters] = {"f mm", "r",   "u mm", "v mm", "skew °", "ω °",
                                               "φ °",  "κ °", "X0 m", "Y0 m", "Z0 m"};
constexpr const char* kColours[kMethods] = {"#e69f00", "#56b4e9", "#d55e00", "#009e73", "#0072b2"};

constexpr std::string_view kParts[] = {"speed",     "penalty", "open",   "metric",
                                       "section-6", "angles",  "circles"};

struct Settings {
  int trials = 2000;
  std::string docs;                // empty: nothing is written
  std::vector<std::string> parts;  // empty: all

  bool Wants(const std::string& part) const {
    return parts.empty() || std::ranges::find(parts, part) != parts.end();
  }
};

// What the paper prints in its Tables 1 to 3.
struct Printed {
  double dlt[kParameters];
  double proposed[kParameters];
  double deviation[kParameters];
};
const std::map<std::string_view, Printed> kPrinted = {
    {"B1",
     {{16.92, 1.06, -0.33, 0.18, 90.00, -20.97, 13.49, 0.45, 12.93, -21.77, 7.28},
      {16.94, 1.05, -0.28, 0.15, 89.15, -20.65, 14.52, 0.04, 12.62, -21.90, 7.23},
      {0.04, 0.02, 0.02, 0.02, 0.12, 0.07, 0.08, 0.01, 0.08, 0.12, 0.06}}},
    {"B2",
     {{36.02, 1.07, -0.39, 0.16, 90.00, -10.54, 10.49, 0.15, 21.26, -14.70, 6.68},
      {35.88, 1.04, -0.24, 0.14, 89.21, -10.21, 10.34, 0.02, 20.92, -15.22, 6.62},
      {0.04, 0.01, 0.02, 0.02, 0.17, 0.08, 0.06, 0.01, 0.09, 0.08, 0.05}}},
    {"B3",
     {{34.82, 1.02, -0.02, -0.08, 90.00, 20.14, 30.12, 0.02, 10.21, -29.90, 2.08},
      {35.74, 1.03, -0.18, 0.12, 89.29, 20.20, 29.58, 0.02, 9.52, -30.13, 2.16},
      {0.03, 0.01, 0.02, 0.01, 0.12, 0.08, 0.06, 0.01, 0.06, 0.06, 0.04}}}};

TableRow HeadRow(std::string first) {
  TableRow row{std::move(first)};
  row.insert(row.end(), std::begin(kColumns), std::end(kColumns));
  return row;
}

template <class Values>
TableRow RowOf(std::string first, const Values& values, int digits) {
  TableRow row{std::move(first)};
  for (int i = 0; i < kParameters; ++i) row.push_back(fmt::format("{:.{}f}", values[i], digits));
  return row;
}

TableRow MeanRow(std::string first, const ParameterVector& mean, const ParameterVector& deviation) {
  TableRow row{std::move(first)};
  for (int i = 0; i < kParameters; ++i)
    row.push_back(fmt::format("{:.3f} ± {:.3f}", mean[i], deviation[i]));
  return row;
}

std::string FailuresOf(const Errors& errors) {
  return errors.failures > 0 ? fmt::format(" ({} of {} failed)", errors.failures, errors.trials)
                             : "";
}

bool AllFailed(const Errors& errors) { return errors.each.size() < 2; }

// ---- Section 6

// All methods for one cuboid and noise; cases are numbered by what is simulated, so that every
// method sees the same traces.
struct Case {
  const Cuboid* cuboid;
  Noise noise;
  std::array<Errors, kMethods> errors;
};

Case Simulated(const Settings& settings, const Cuboid& cuboid, const Noise& noise, int chosen) {
  Case result{&cuboid, noise, {}};
  for (int m = 0; m < kMethods; ++m) {
    const auto method = static_cast<Method>(m);
    result.errors[static_cast<std::size_t>(m)] =
        Simulate(cuboid, noise, method, settings.trials, chosen);
  }
  return result;
}

std::string TableOfCase(const Case& c) {
  const std::string name(c.cuboid->name);
  const ParameterVector truth = InTableUnits(c.cuboid->truth.parameters);
  std::vector<TableRow> rows{HeadRow(name), RowOf("truth", truth, 2)};
  if (const auto printed = kPrinted.find(c.cuboid->name); printed != kPrinted.end()) {
    rows.push_back(RowOf("paper prints: DLT", printed->second.dlt, 2));
    rows.push_back(RowOf("paper prints: proposed", printed->second.proposed, 2));
    rows.push_back(RowOf("paper prints: ± std. dev.", printed->second.deviation, 2));
  }
  for (int m = 0; m < kMethods; ++m) {
    const Errors& errors = c.errors[static_cast<std::size_t>(m)];
    const std::string method = kMethodNames[m];
    if (AllFailed(errors)) {
      TableRow row{method + FailuresOf(errors)};
      row.resize(kParameters + 1, "–");
      rows.push_back(row);
      continue;
    }
    rows.push_back(MeanRow(method + FailuresOf(errors), truth + errors.Mean(), errors.Deviation()));
    rows.push_back(RowOf(method + ": RMSE", errors.Rmse(), 4));
  }
  rows.push_back(RowOf("Cramér–Rao bound", BoundOf(*c.cuboid, c.noise), 4));
  return Table(rows) + "\n";
}

std::string TableOfNoises(const std::vector<Case>& cases) {
  std::vector<TableRow> rows{{"camera, method"}};
  for (const Noise& noise : kNoises) rows[0].push_back(noise.name() + " px");
  for (std::size_t first = 0; first < cases.size(); first += kNoises.size())
    for (std::size_t m = 0; m < kMethods; ++m) {
      TableRow row{fmt::format("{} {}", cases[first].cuboid->name, kMethodNames[m])};
      for (std::size_t n = 0; n < kNoises.size(); ++n) {
        const Errors& errors = cases[first + n].errors[m];
        if (AllFailed(errors)) {
          row.push_back("all failed");
          continue;
        }
        const ParameterVector rmse = errors.Rmse();
        row.push_back(fmt::format("{:.2g} / {:.2g} / {:.2g}{}", rmse[kFocal], rmse[kSkew],
                                  rmse[kX0], FailuresOf(errors)));
      }
      rows.push_back(row);
    }
  return Table(rows) + "\n";
}

std::string TableOfRatios(const std::vector<Case>& cases) {
  std::vector<TableRow> rows{HeadRow("camera, noise")};
  for (int i = 1; i <= kParameters; ++i) rows[0][static_cast<std::size_t>(i)] = kColumns[i - 1];
  rows[0].push_back("95 % cover");
  double sum = 0, worst = 0, bias = 0, lowest = 1, highest = 0;
  int count = 0, failures = 0, trials = 0;
  for (const Case& c : cases) {
    const Errors& errors = c.errors[kLikelihood];
    const ParameterVector ratio = errors.Rmse().cwiseQuotient(BoundOf(*c.cuboid, c.noise));
    const ParameterVector cover = errors.Coverage();
    rows.push_back(RowOf(fmt::format("{} {}", c.cuboid->name, c.noise.name()), ratio, 3));
    rows.back().push_back(
        fmt::format("{:.1f}–{:.1f} %", 100 * cover.minCoeff(), 100 * cover.maxCoeff()));
    sum += ratio.sum(), count += kParameters, worst = std::max(worst, ratio.maxCoeff());
    bias = std::max(bias, errors.BiasInStandardErrors().maxCoeff());
    lowest = std::min(lowest, cover.minCoeff()), highest = std::max(highest, cover.maxCoeff());
    failures += errors.failures, trials += errors.trials;
  }
  return Table(rows) +
         fmt::format(
             "\nOf {} ratios the worst is {:.3f} and the mean {:.3f}; the largest mean error is "
             "{:.2f} of its standard errors; 95 % intervals cover {:.1f} to {:.1f} %. {} of {} "
             "calibrations failed.\n",
             count, worst, sum / count, bias, 100 * lowest, 100 * highest, failures, trials);
}

void AddSectionSix(const Settings& settings, Report& report) {
  std::vector<Case> cases;
  std::string tables;
  int chosen = 0;
  for (const char* name : {"B1", "B2", "B3", "B4"})
    for (const Noise& noise : kNoises)
      cases.push_back(Simulated(settings, CuboidOf(name), noise, ++chosen));
  for (const Case& c : cases)
    if (c.noise.name() == kPlainNoise.name()) tables += TableOfCase(c);
  std::vector<Case> literal;
  for (const char* name : {"L1", "L2", "L3"})
    for (const Noise& noise : kNoises)
      literal.push_back(Simulated(settings, CuboidOf(name), noise, ++chosen));
  report.Add("section-6", fmt::format("{} trials of each method.\n\n", settings.trials) + tables);
  report.Add("noises", TableOfNoises(cases));
  report.Add("literal", TableOfNoises(literal));
  report.Add("bounds", TableOfRatios(cases));
}

// ---- small angles

constexpr double kAngles[] = {10, 5, 2, 1, 0.3, 0.1, 0};
constexpr double kPlaceOfZero = 0.03;  // on a logarithmic axis
constexpr const char* kBound = "bound";

struct AngleCase {
  double degrees;
  std::array<Errors, kMethods> errors;
  ParameterVector bound;
};

Cuboid Turned(const char* name, Parameter parameter, double degrees) {
  Cuboid cuboid = CuboidOf(name);
  cuboid.truth[parameter] = std::copysign(degrees * kDegree, cuboid.truth[parameter]);
  return cuboid;
}

std::vector<AngleCase> AngleCases(const Settings& settings, const char* name, Parameter parameter,
                                  int& chosen) {
  std::vector<AngleCase> cases;
  for (const double degrees : kAngles) {
    const Cuboid cuboid = Turned(name, parameter, degrees);
    cases.push_back({degrees, Simulated(settings, cuboid, kPlainNoise, ++chosen).errors,
                     BoundOf(cuboid, kPlainNoise)});
  }
  return cases;
}

std::string TableOfAngles(const char* turn, const std::vector<AngleCase>& cases) {
  std::vector<TableRow> rows{{turn}};
  for (const char* method : kMethodNames) rows[0].push_back(method);
  rows[0].push_back("bound");
  for (const AngleCase& c : cases) {
    TableRow row{fmt::format("{:g}°", c.degrees)};
    for (const Errors& errors : c.errors) {
      if (AllFailed(errors)) {
        row.push_back("all failed");
        continue;
      }
      const ParameterVector rmse = errors.Rmse(), median = errors.Median();
      row.push_back(fmt::format("{:.2g} ({:.2g}) / {:.2g} ({:.2g}){}", rmse[kFocal], median[kFocal],
                                rmse[kSkew], median[kSkew], FailuresOf(errors)));
    }
    row.push_back(fmt::format("{:.2g} / {:.2g}", c.bound[kFocal], c.bound[kSkew]));
    rows.push_back(row);
  }
  return Table(rows) + "\n";
}

// RMSE over the angle, by method. A method that supposes a parameter has no error of it to plot.
Panel PanelOfAngles(const std::vector<AngleCase>& cases, const char* turn, const char* title,
                    const char* unit, Parameter parameter) {
  Panel panel;
  panel.title = title;
  panel.x = {
      fmt::format("{}, degrees", turn),
      kPlaceOfZero,
      12,
      true,
      {{kPlaceOfZero, "0"}, {0.1, "0.1"}, {0.3, "0.3"}, {1, "1"}, {2, "2"}, {5, "5"}, {10, "10"}}};
  double least = std::numeric_limits<double>::infinity(), most = 0;
  const auto add = [&](std::string name, std::string colour, bool is_dashed, const auto& value_of) {
    const bool has_markers = name != kBound;
    Series series{std::move(name), std::move(colour), {}, has_markers, is_dashed};
    for (const AngleCase& c : cases) {
      const double value = value_of(c);
      const bool is_plotted = std::isfinite(value) && value > 1e-9;
      series.points.push_back(
          {c.degrees > 0 ? c.degrees : kPlaceOfZero, is_plotted ? value : std::nan("")});
      if (is_plotted) least = std::min(least, value), most = std::max(most, value);
    }
    panel.series.push_back(std::move(series));
  };
  // Dashes over the line of `paper`, which has nearly the same errors.
  for (const Method method : {kPaper, kOrthocentre, kDlt, kSweep, kLikelihood})
    add(kMethodNames[method], kColours[method], method == kOrthocentre, [&](const AngleCase& c) {
      const Errors& errors = c.errors[static_cast<std::size_t>(method)];
      return AllFailed(errors) ? std::nan("") : errors.Rmse()[parameter];
    });
  add(kBound, "#000000", true, [&](const AngleCase& c) { return c.bound[parameter]; });
  panel.y = LogarithmicAxis(fmt::format("RMSE, {}", unit), least, most);
  return panel;
}

std::string PlotOfAngles(const std::vector<AngleCase>& cases, const char* turn) {
  return Svg({PanelOfAngles(cases, turn, "focal length f", "mm", kFocal),
              PanelOfAngles(cases, turn, "skew angle α", "degrees", kSkew)});
}

// `likelihood` on all four cameras.
std::string TableOfSmallAngles(const Settings& settings, int& chosen) {
  std::vector<TableRow> rows{{"camera", "angle", "RMSE/CRLB, worst of 11",
                              "CRLB / that at 10°, worst of 11", "failed", "warned"}};
  for (const char* name : {"B1", "B2", "B3", "B4"})
    for (const Parameter parameter : {kOmega, kPhi}) {
      const ParameterVector at_ten = BoundOf(Turned(name, parameter, 10), kPlainNoise);
      for (const double degrees : {1.0, 0.1, 0.0}) {
        const Cuboid cuboid = Turned(name, parameter, degrees);
        const Errors errors = Simulate(cuboid, kPlainNoise, kLikelihood, settings.trials, ++chosen);
        const ParameterVector bound = BoundOf(cuboid, kPlainNoise);
        rows.push_back({name,
                        fmt::format("{} {:g}°", parameter == kOmega ? "tilt" : "pan", degrees),
                        fmt::format("{:.3f}", errors.Rmse().cwiseQuotient(bound).maxCoeff()),
                        fmt::format("{:.3f}", bound.cwiseQuotient(at_ten).maxCoeff()),
                        fmt::format("{} of {}", errors.failures, errors.trials),
                        fmt::format("{} of {}", errors.warned, errors.trials)});
      }
    }
  return Table(rows);
}

void AddSmallAngles(const Settings& settings, Report& report) {
  int chosen = 100;
  const std::vector<AngleCase> tilts = AngleCases(settings, "B3", kOmega, chosen);
  const std::vector<AngleCase> pans = AngleCases(settings, "B3", kPhi, chosen);
  report.Add("angles", TableOfAngles("tilt", tilts) + TableOfAngles("pan", pans));
  report.plots["error_against_tilt.svg"] = PlotOfAngles(tilts, "tilt ω");
  report.plots["error_against_pan.svg"] = PlotOfAngles(pans, "pan φ");
  report.Add("small-angles", TableOfSmallAngles(settings, chosen));
}

// ---- what stays open

// The edges of the cuboid's front, nothing else.
TracedCuboid FacadeAlone(const Cuboid& cuboid, std::uint64_t seed) {
  TracedCuboid traced = TraceCuboid(cuboid, {.sigma_px = 0.5, .seed = seed});
  const auto is_in_front = [&](camera::NumberIndex first) {
    return traced.numbers.values[first + 1] == cuboid.offset_m.y();
  };
  std::erase_if(traced.photograph.traces, [&](const camera::Trace& trace) {
    const auto& edge = std::get<camera::EdgeTrace>(trace);
    return !is_in_front(edge.from) || !is_in_front(edge.to);
  });
  return traced;
}

// The directions of all edges, and how the front's width is to its height.
TracedCuboid SingleRatio(const Cuboid& cuboid, std::uint64_t seed) {
  TracedCuboid traced =
      TraceCuboid(cuboid, {.sigma_px = 0.5, .seed = seed, .edges = false, .directions = true});
  camera::RatioTrace ratio{{}, 0.5, static_cast<int>(traced.numbers.values.size()), 0};
  constexpr int dots[] = {0, 4, 0, 1};  // vertices: along X, and up Z
  camera::NormalNumbers noise(seed);
  for (std::size_t i = 0; i < 4; ++i) {
    const geom::Vec3 vertex =
        camera::benchmark::Vertex(dots[i], cuboid.dimensions_m, cuboid.offset_m);
    const double x_px = 0.5 * noise.Next(), y_px = 0.5 * noise.Next();
    ratio.dots_px[i] =
        traced.photograph.frame.DotFromPoint(Project(cuboid.truth, vertex).point_mm) +
        geom::Vec2(x_px, y_px);
  }
  traced.numbers.values.conservativeResize(ratio.ratio + 1);
  traced.numbers.values[ratio.ratio] = cuboid.dimensions_m.x() / cuboid.dimensions_m.z();
  traced.numbers.by_unknown.conservativeResize(ratio.ratio + 1, 0);
  traced.photograph.traces.push_back(ratio);
  return traced;
}

template <class Tracing>
TableRow RowOfOpen(const char* name, const char* what, Tracing&& tracing) {
  constexpr std::uint64_t seeds = 1000;
  int open = 0;
  std::string words;
  for (std::uint64_t i = 0; i < seeds; ++i) {
    const TracedCuboid traced = tracing(CuboidOf(name), 1 + i);
    const auto estimate = camera::Calibrate(traced.photograph, traced.numbers);
    if (!estimate) {
      if (words.empty()) words = estimate.error().detail;
      continue;
    }
    open += estimate->parameters[kSkew].free();
    if (words.empty() && !estimate->undetermined.empty()) words = estimate->undetermined[0];
  }
  return {name, what, fmt::format("{} of {}", open, seeds), words};
}

void AddOpen(Report& report) {
  std::vector<TableRow> rows{{"camera", "traced", "α not determined", "what is told"}};
  for (const char* name : {"B1", "B2", "B3", "B4"}) {
    rows.push_back(RowOfOpen(name, "a facade", FacadeAlone));
    rows.push_back(RowOfOpen(name, "directions, one ratio", SingleRatio));
  }
  report.Add("open", Table(rows));
}

// ---- metric data

// What a cuboid's camera becomes, on exact traces, when one dimension is believed 1 % too long.
void AddMetric(Report& report) {
  std::vector<TableRow> rows{
      {"camera", "1 % in", "f mm", "r", "skew °", "φ °", "X0 m", "Y0 m", "χ² left"}};
  for (const char* name : {"B1", "B2", "B3", "B4"})
    for (int axis = 0; axis < 3; ++axis) {
      const Cuboid& cuboid = CuboidOf(name);
      const TracedCuboid exact = TraceCuboid(cuboid, {});
      geom::Vec3 believed_m = cuboid.dimensions_m;
      believed_m[axis] *= 1.01;
      const camera::CameraFit fit =
          camera::FitCamera(exact.photograph, NumbersOf(cuboid, believed_m, 0), cuboid.truth);
      const ParameterVector moved = InTableUnits(fit.camera.parameters - cuboid.truth.parameters);
      TableRow row{name, fmt::format("{}", "XYZ"[axis])};
      for (const Parameter p : {kFocal, camera::kAspect, kSkew, kPhi, kX0, camera::kY0})
        row.push_back(std::abs(moved[p]) < 5e-5 ? "0" : fmt::format("{:+.4f}", moved[p]));
      // Zero but for rounding, which differs between machines.
      row.push_back(fit.chi2 < 1e-12 ? "0" : fmt::format("{:.2g}", fit.chi2));
      rows.push_back(row);
    }
  report.Add("metric", Table(rows));
}

// ---- the penalty

Panel PanelOfPenalty(const char* name) {
  const Cuboid& cuboid = CuboidOf(name);
  const TracedCuboid traced = TraceCuboid(cuboid, {.sigma_px = 0.5, .seed = 1});
  const double truth = cuboid.truth[kSkew] / kDegree;
  Panel panel;
  panel.title = fmt::format("{}, 0.5 px", name);
  panel.x = {"skew angle α, degrees", 88, 92, false, {}};
  for (int degrees = 88; degrees <= 92; ++degrees)
    panel.x.ticks.push_back({static_cast<double>(degrees), fmt::format("{}", degrees)});
  panel.mark = {truth, fmt::format("true α = {:g}°", truth)};
  double least = std::numeric_limits<double>::infinity(), most = 0;
  const auto add = [&](Method method, const std::vector<camera::ProfilePoint>& curve) {
    Series series{kMethodNames[method], kColours[method], {}};
    for (std::size_t i = 0; i < curve.size(); i += 2) {
      series.points.push_back({curve[i].alpha_rad / kDegree, curve[i].chi2});
      if (!std::isfinite(curve[i].chi2)) continue;
      least = std::min(least, curve[i].chi2), most = std::max(most, curve[i].chi2);
    }
    panel.series.push_back(std::move(series));
  };
  if (const auto found = camera::CalibratePaper(traced.photograph, traced.numbers))
    add(kPaper, found->curve);
  if (const auto found = camera::CalibrateSweep(traced.photograph, traced.numbers))
    add(kSweep, found->curve);
  camera::CalibrateOptions options;
  options.profile = camera::SkewRange{88 * kDegree, 0.01 * kDegree, 401};
  if (const auto found = camera::Calibrate(traced.photograph, traced.numbers, options))
    add(kLikelihood, found->profile);
  panel.y = LogarithmicAxis("penalty, χ²", least, most);
  return panel;
}

void AddPenalty(Report& report) {
  report.plots["penalty.svg"] = Svg({PanelOfPenalty("B1"), PanelOfPenalty("B4")});
}

// ---- speed

template <class Work>
double MedianSeconds(int runs, Work&& work) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> seconds;
  for (int i = 0; i < runs; ++i) {
    const Clock::time_point start = Clock::now();
    work();
    seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
  }
  std::ranges::nth_element(seconds, seconds.begin() + runs / 2);
  return seconds[static_cast<std::size_t>(runs / 2)];
}

// Seconds of what is timed for one cuboid, in the order of the table's rows.
std::array<double, 4> SpeedsFor(const char* name) {
  constexpr int runs = 1000;
  const TracedCuboid traced = TraceCuboid(CuboidOf(name), {.sigma_px = 0.5, .seed = 1});
  const camera::Photograph& photograph = traced.photograph;
  const camera::Numbers& numbers = traced.numbers;
  camera::CalibrateOptions with_trials;
  with_trials.trials = 100;
  double sum = 0;
  const std::array<double, 4> seconds{
      MedianSeconds(runs, [&] { sum += camera::CalibrateSweep(photograph, numbers)->penalty; }),
      MedianSeconds(runs,
                    [&] {
                      const auto found = camera::CalibrateSweep(photograph, numbers);
                      sum += camera::FitCamera(photograph, numbers, found->camera).chi2;
                    }),
      MedianSeconds(runs, [&] { sum += camera::Calibrate(photograph, numbers)->chi2; }),
      MedianSeconds(runs,
                    [&] { sum += camera::Calibrate(photograph, numbers, with_trials)->chi2; })};
  // The sum is used, so that no compiler leaves the work out.
  if (!std::isfinite(sum)) std::cerr << "not finite\n";
  return seconds;
}

void AddSpeed(Report& report) {
  const std::array<double, 4> nine = SpeedsFor("B1"), seven = SpeedsFor("B4");
  const char* rows[4][2] = {{"sweep of 401 angles", "–"},
                            {"sweep of 401 angles and refinement", "≤ 0.150 ms"},
                            {"calibrate, from traces to report", "–"},
                            {"calibrate trials=100", "≤ 15 ms"}};
  std::vector<TableRow> table{
      {"median of 1 000 runs, one core", "B1, 9 edges", "B4, 7 edges", "target"}};
  for (std::size_t i = 0; i < 4; ++i)
    table.push_back({rows[i][0], fmt::format("{:.3f} ms", 1000 * nine[i]),
                     fmt::format("{:.3f} ms", 1000 * seven[i]), rows[i][1]});
  report.Add("speed", Table(table));
}

// ---- circles

void AddCircles(Report& report) {
  constexpr int kSeeds = 10'000;
  std::vector<TableRow> table{{"half circle, shorter half axis", "dots", "radius within 1 %",
                               "within its 95 % interval", "root mean square error"}};
  for (const auto& [radius_px, dots] :
       {std::pair{200.0, 9}, {60.0, 15}, {60.0, 9}, {30.0, 9}, {15.0, 9}, {8.0, 9}}) {
    const camera::scenes::CircleTrials trials =
        camera::scenes::TrialsOf({.radius_px = radius_px, .dots = dots}, kSeeds);
    table.push_back({fmt::format("{:.0f} px", radius_px), fmt::format("{}", dots),
                     fmt::format("{:.1f} %", 100 * trials.within_one_per_cent),
                     fmt::format("{:.1f} %", 100 * trials.within_95),
                     fmt::format("{:.2f} %", 100 * trials.rms_share)});
  }
  report.Add("circles", Table(table));
}

// ---- files

std::optional<Settings> SettingsOf(const std::vector<std::string_view>& words) {
  Settings settings;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool has_value = i + 1 < words.size();
    if (words[i] == "--write-docs" && has_value) {
      settings.docs = words[++i];
    } else if (words[i] == "--trials" && has_value) {
      const std::string_view value = words[++i];
      const auto read = std::from_chars(value.data(), value.data() + value.size(), settings.trials);
      if (read.ec != std::errc() || settings.trials < 20) return {};
    } else if (std::ranges::find(kParts, words[i]) != std::end(kParts)) {
      settings.parts.emplace_back(words[i]);
    } else {
      return {};
    }
  }
  return settings;
}

int Main(const std::vector<std::string_view>& words) {
  const std::optional<Settings> settings = SettingsOf(words);
  if (!settings) {
    std::cerr << "usage: camera_benchmark [--trials N] [--write-docs DOCS] "
                 "[speed|penalty|open|metric|section-6|angles|circles...]; N from 20\n";
    return 2;
  }
  Report report;
  if (settings->Wants("speed")) AddSpeed(report);
  if (settings->Wants("penalty")) AddPenalty(report);
  if (settings->Wants("open")) AddOpen(report);
  if (settings->Wants("metric")) AddMetric(report);
  if (settings->Wants("section-6")) AddSectionSix(*settings, report);
  if (settings->Wants("angles")) AddSmallAngles(*settings, report);
  if (settings->Wants("circles")) AddCircles(report);
  return settings->docs.empty() || WriteDocs(settings->docs, report) ? 0 : 1;
}

}  // namespace
}  // namespace tranos::bench

int main(int argc, char** argv) { return tranos::bench::Main({argv + 1, argv + argc}); }
