// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/photograph_difference.h"

#include <fmt/format.h>

#include <cmath>

#include "camera/parameter_table.h"
#include "model/element.h"

namespace tranos::session {

namespace {

using camera::ParameterRow;
using model::Photograph;
using model::Trace;

// What rounding leaves of a parameter that is the same, in units of its report.
constexpr double kRounding = 1e-6;

class Comparison {
 public:
  std::vector<ParameterChange> Take() { return std::move(out_); }

  void Compare(const Photograph& before, const Photograph& after) {
    Note("file", before.file, after.file);
    if (before.file == after.file && !(before.content == after.content)) {
      Note("content", model::Hex(before.content), model::Hex(after.content));
    }
    Note("size", Size(before.frame), Size(after.frame));
    Note("format", Format(before), Format(after));
    for (int i = 0; i < camera::kIntrinsics; ++i) {
      const ParameterRow& row = camera::kParameterRows[i];
      Note("prior " + std::string(row.words), Prior(before.priors[i], row),
           Prior(after.priors[i], row));
    }
    if (!before.estimate || !after.estimate) {
      return Note("camera", before.estimate ? "found" : "", after.estimate ? "found" : "");
    }
    for (int i = 0; i < camera::kParameters; ++i) Compare(*before.estimate, *after.estimate, i);
  }

  void Compare(const Trace& before, const Trace& after) {
    Note("noise", Noise(before), Noise(after));
    Note("samples", Count(before.samples), Count(after.samples));
    Note("facade", before.facade, after.facade);
  }

 private:
  void Note(std::string name, std::string before, std::string after) {
    if (before != after) out_.push_back({std::move(name), std::move(before), std::move(after)});
  }

  // The number with its unit, as reports write it.
  static std::string InUnit(double number, std::string_view unit, const char* form = "{:.6g}") {
    std::string text = fmt::format(fmt::runtime(form), number);
    if (!unit.empty()) text += (unit == "°" ? "" : " ") + std::string(unit);
    return text;
  }
  static std::string Size(const camera::Frame& frame) {
    return fmt::format("{} × {} px", frame.size_px.x(), frame.size_px.y());
  }
  static std::string Format(const Photograph& photograph) {
    if (!photograph.format_is_stated) return "";
    const geom::Vec2& size_mm = photograph.frame.size_mm;
    return fmt::format("{:g} × {:g} mm", size_mm.x(), size_mm.y());
  }
  static std::string Prior(const camera::Prior& prior, const ParameterRow& row) {
    if (!(prior.sigma > 0)) return "";
    const double value = prior.value / row.per_unit, sigma = prior.sigma / row.per_unit;
    return row.unit.empty() ? fmt::format("{:.6g} +- {:.3g} %", value, 100 * sigma / value)
                            : fmt::format("{:.6g} +- {}", value, InUnit(sigma, row.unit, "{:.3g}"));
  }
  static std::string Noise(const Trace& trace) {
    return trace.noise_px > 0 ? fmt::format("{:g} px", trace.noise_px) : "estimated";
  }
  static std::string Count(double samples) {
    return samples > 0 ? fmt::format("{:g}", samples) : "";
  }

  void Compare(const camera::Estimate& before, const camera::Estimate& after, int i) {
    const ParameterRow& row = camera::kParameterRows[i];
    const bool was_free = before.parameters[i].free(), is_free = after.parameters[i].free();
    const double by = (after.camera.parameters[i] - before.camera.parameters[i]) / row.per_unit;
    if (was_free == is_free && (was_free || std::abs(by) < kRounding)) return;
    const auto text = [&](const camera::Estimate& estimate, bool free) {
      return free ? std::string("not determined")
                  : InUnit(estimate.camera.parameters[i] / row.per_unit, row.unit);
    };
    std::string is = text(after, is_free);
    if (!was_free && !is_free) {
      is += " (" + InUnit(by, row.unit, "{:+.3g}");
      const double sigma = before.covariance.size() ? before.parameters[i].sigma / row.per_unit : 0;
      if (sigma > 0) is += fmt::format(", {:.1f} of its deviations", std::abs(by) / sigma);
      is += ")";
    }
    out_.push_back({std::string(row.words), text(before, was_free), std::move(is)});
  }

  std::vector<ParameterChange> out_;
};

}  // namespace

std::vector<ParameterChange> PhotographChanges(const model::Element& before,
                                               const model::Element& after) {
  Comparison comparison;
  const auto compare = [&]<class Pointer>() {
    const auto *x = std::get_if<Pointer>(&before.geometry),
               *y = std::get_if<Pointer>(&after.geometry);
    if (x && y) comparison.Compare(**x, **y);
  };
  compare.template operator()<model::PhotographPtr>();
  compare.template operator()<model::TracePtr>();
  return comparison.Take();
}

}  // namespace tranos::session
