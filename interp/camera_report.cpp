// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/camera_report.h"

#include <fmt/format.h>

#include <cmath>

#include "camera/parameter_table.h"
#include "interp/failure.h"

namespace tranos::interp {

using camera::Parameter;
using model::Photograph;
using model::Value;

namespace {

constexpr double kDegree = geom::kPi / 180;

// A parameter as a member of its camera.
struct Row {
  Parameter parameter;
  std::string_view member;
  double in_si;  // of the language's value, for one of the parameter
  model::Dimension dimension;
};
constexpr Row kRows[] = {{camera::kFocal, "focal", 1e-3, model::kLength},
                         {camera::kAspect, "aspect", 1, model::kPlain},
                         {camera::kPrincipalX, "u", 1e-3, model::kLength},
                         {camera::kPrincipalY, "v", 1e-3, model::kLength},
                         {camera::kSkew, "skew", 1, model::kAngle},
                         {camera::kOmega, "omega", 1, model::kAngle},
                         {camera::kPhi, "phi", 1, model::kAngle},
                         {camera::kKappa, "kappa", 1, model::kAngle},
                         {camera::kX0, "x", 1, model::kLength},
                         {camera::kY0, "y", 1, model::kLength},
                         {camera::kZ0, "z", 1, model::kLength}};

Value MemberValue(const Photograph& photograph, const Row& row) {
  const camera::Estimate& estimate = *photograph.estimate;
  if (estimate.parameters[row.parameter].free()) {
    throw OpFailure{Code::kNotDetermined,
                    fmt::format("the camera's `{}` is not determined", row.member),
                    estimate.undetermined.empty() ? "" : estimate.undetermined.front()};
  }
  const double value = estimate.camera[row.parameter] * row.in_si;
  const Eigen::MatrixXd& deviations = estimate.deviations;
  model::Derivatives derivatives;
  for (Eigen::Index j = 0; j < deviations.cols(); ++j) {
    const double slope = deviations(row.parameter, j) * row.in_si;
    if (slope != 0) derivatives.terms.emplace_back(static_cast<model::SourceId>(j), slope);
  }
  if (derivatives.terms.empty()) return Value::Number(value, row.dimension);
  return Value::Uncertain({value, std::move(derivatives)}, row.dimension);
}

const Row* FindRow(std::string_view name) {
  for (const Row& row : kRows) {
    if (row.member == name) return &row;
  }
  return nullptr;
}

Value Together(const Photograph& photograph, std::initializer_list<Parameter> parameters) {
  std::vector<Value> items;
  for (const Parameter p : parameters) items.push_back(MemberValue(photograph, kRows[p]));
  return Value::List(std::move(items));
}

std::string ShareText(const camera::Shares& shares) {
  return fmt::format("pixels {:.0f} %, metric data {:.0f} %, priors {:.0f} %", 100 * shares.pixels,
                     100 * shares.metric, 100 * shares.priors);
}

std::string ParameterLine(const camera::Estimate& estimate, Parameter parameter, bool stated) {
  const camera::ParameterRow& row = camera::kParameterRows[parameter];
  const camera::ParameterEstimate& known = estimate.parameters[parameter];
  if (known.free()) return fmt::format("{:>3}  not determined", row.symbol);
  const std::string unit =
      row.unit.empty() || row.unit == "°" ? std::string(row.unit) : " " + std::string(row.unit);
  std::string line =
      fmt::format("{:>3} {:12.5f}{}", row.symbol, estimate.camera[parameter] / row.per_unit, unit);
  if (stated || estimate.covariance.size() == 0) return line;
  line += fmt::format(" ± {:.5f}{}  {}", known.sigma / row.per_unit, unit, ShareText(known.shares));
  if (known.from_prior) line += ", not determined without priors";
  return line;
}

// What was assumed, and what came of it.
void AddPriors(const Photograph& photograph, std::vector<std::string>* lines) {
  for (int p = 0; p < camera::kIntrinsics; ++p) {
    const camera::Prior& prior = photograph.priors[p];
    if (!(prior.sigma > 0)) continue;
    const camera::ParameterRow& row = camera::kParameterRows[p];
    const camera::ParameterEstimate& known = photograph.estimate->parameters[p];
    std::string line = fmt::format("prior {} {:g} ± {:g}{}{}", row.symbol,
                                   prior.value / row.per_unit, prior.sigma / row.per_unit,
                                   row.unit.empty() || row.unit == "°" ? "" : " ", row.unit);
    if (photograph.estimate->covariance.size() > 0) {
      line += fmt::format(", priors are {:.0f} % of the result", 100 * known.shares.priors);
    }
    lines->push_back(std::move(line));
  }
}

// From the camera to dots, a line each row.
void AddCalibrationMatrix(const camera::Camera& camera, const camera::Frame& frame,
                          std::vector<std::string>* lines) {
  const camera::Mat3 k = frame.DotFromFrame() * camera::FrameFromCamera(camera.parameters);
  for (int row = 0; row < 3; ++row) {
    lines->push_back(fmt::format("{} [{:11.3f} {:11.3f} {:11.3f}]{}", row == 1 ? "K =" : "   ",
                                 k(row, 0), k(row, 1), k(row, 2), row == 1 ? " px" : ""));
  }
}

// What remains of the traces, in deviations.
std::string ResidualLine(const camera::Estimate& estimate) {
  double sum = 0, largest = 0;
  std::size_t count = 0;
  int worst = 0;
  for (const camera::TraceResidual& trace : estimate.residuals) {
    for (const double residual : trace.whitened) {
      sum += residual * residual;
      ++count;
      if (std::abs(residual) <= largest) continue;
      largest = std::abs(residual);
      worst = trace.trace;
    }
  }
  return fmt::format("residuals of {} traces, in deviations: rms {:.2f}, largest {:.2f} (trace {})",
                     estimate.residuals.size(), std::sqrt(sum / static_cast<double>(count)),
                     largest, worst + 1);
}

}  // namespace

std::optional<Value> PhotographMember(const Photograph& photograph, std::string_view name) {
  if (name == "width") return Value::Number(photograph.frame.size_px.x(), model::kPixel);
  if (name == "height") return Value::Number(photograph.frame.size_px.y(), model::kPixel);
  if (name == "file") return Value::String(photograph.file);
  const Row* row = FindRow(name);
  const bool of_camera = row || name == "principal" || name == "position" || name == "determined";
  if (!of_camera) return std::nullopt;
  if (!photograph.estimate) {
    throw OpFailure{Code::kNotDetermined, "the photograph has no camera yet", "",
                    "`calibrate` finds it"};
  }
  if (name == "determined") return Value::Boolean(photograph.estimate->determined());
  if (name == "principal") return Together(photograph, {camera::kPrincipalX, camera::kPrincipalY});
  if (name == "position") return Together(photograph, {camera::kX0, camera::kY0, camera::kZ0});
  return MemberValue(photograph, *row);
}

std::vector<std::string> PhotographMembers() {
  std::vector<std::string> names = {"width",      "height",    "file",
                                    "determined", "principal", "position"};
  for (const Row& row : kRows) names.emplace_back(row.member);
  return names;
}

std::string UnknownText(const Photograph& photograph, const camera::Estimate& estimate,
                        std::size_t unknown) {
  const auto& [name, value, sigma, determined, at_bound] = estimate.unknowns[unknown];
  const model::Dimension dimension = unknown < photograph.unknown_dimensions.size()
                                         ? photograph.unknown_dimensions[unknown]
                                         : model::kPlain;
  const double unit = dimension == model::kAngle ? kDegree : 1;
  const char* const symbol = dimension == model::kAngle    ? "°"
                             : dimension == model::kLength ? " m"
                                                           : "";
  return fmt::format("{:.6g}{} ± {:.2g}{}", value / unit, symbol, sigma / unit, symbol);
}

std::vector<std::string> CameraReport(const model::Element& element, const Photograph& photograph) {
  const camera::Estimate& estimate = *photograph.estimate;
  const bool stated = !photograph.attached || !photograph.camera_file.empty();
  std::vector<std::string> lines;
  lines.push_back(fmt::format("camera {}: {} × {} px, {:g} mm × {:g} mm{}", element.name_or_empty(),
                              photograph.frame.size_px.x(), photograph.frame.size_px.y(),
                              photograph.frame.size_mm.x(), photograph.frame.size_mm.y(),
                              photograph.format_is_stated ? ""
                              : photograph.camera_file.empty()
                                  ? " (no format given: 36 mm along the longer side)"
                                  : " (no format given: that of the camera's file)"));
  for (int p = 0; p < camera::kParameters; ++p) {
    lines.push_back(ParameterLine(estimate, static_cast<Parameter>(p), stated));
  }
  AddPriors(photograph, &lines);
  if (estimate.complete()) {
    AddCalibrationMatrix(estimate.camera, photograph.frame, &lines);
  }
  if (stated) return lines;
  if (estimate.covariance.size() > 0) {
    const std::string of = estimate.photographs > 1
                               ? fmt::format(" of {} photographs together", estimate.photographs)
                               : "";
    lines.push_back(fmt::format("χ² {:.3f}, {} degrees of freedom{}, noise {:.3f} px{}",
                                estimate.chi2, estimate.dof, of, estimate.noise_px,
                                estimate.noise_is_estimated ? " (estimated; Student's t)" : ""));
  }
  if (!estimate.residuals.empty()) lines.push_back(ResidualLine(estimate));
  for (std::size_t i = 0; i < estimate.unknowns.size(); ++i) {
    const camera::UnknownEstimate& unknown = estimate.unknowns[i];
    if (unknown.name.empty()) continue;
    lines.push_back(unknown.name + " = " + UnknownText(photograph, estimate, i) +
                    (unknown.at_bound ? ", at its bound" : ""));
  }
  if (estimate.trials.trials > 0) {
    std::string line = fmt::format("{} trials:", estimate.trials.trials);
    for (int p = 0; p < camera::kParameters; ++p) {
      const camera::ParameterRow& row = camera::kParameterRows[p];
      line += fmt::format(" {} {:.5f} ± {:.5f}", row.symbol, estimate.trials.mean[p] / row.per_unit,
                          estimate.trials.deviation[p] / row.per_unit);
    }
    lines.push_back(std::move(line));
  }
  for (const std::string& open : estimate.undetermined) lines.push_back("open: " + open);
  if (estimate.disagreement) lines.push_back("warning: " + estimate.disagreement->text);
  for (const std::string& warning : estimate.warnings) lines.push_back("warning: " + warning);
  for (const camera::Estimate& other : estimate.alternatives) {
    lines.push_back(fmt::format(
        "a second pose fits as well (χ² {:.3f}): X0 {:.3f} m, Y0 {:.3f} m, Z0 {:.3f} m, φ {:.3f}°",
        other.chi2, other.camera[camera::kX0], other.camera[camera::kY0], other.camera[camera::kZ0],
        other.camera[camera::kPhi] / kDegree));
  }
  return lines;
}

}  // namespace tranos::interp
