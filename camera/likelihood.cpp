// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/likelihood.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace tranos::camera {

namespace {

// JᵀJ (lower half), Jᵀr and rᵀr.
struct NormalEquations {
  ParameterMatrix information = ParameterMatrix::Zero();
  ParameterVector gradient = ParameterVector::Zero();
  double chi2 = 0;
  int residuals = 0;

  void Add(const Residual& r) {
    for (int j = 0; j < kParameters; ++j) {
      information.col(j).tail(kParameters - j) +=
          r.by_camera[j] * r.by_camera.tail(kParameters - j).transpose();
    }
    gradient += r.value * r.by_camera.transpose();
    chi2 += r.value * r.value;
    ++residuals;
  }
};

Vec3 PointOf(const Numbers& numbers, NumberIndex first) { return numbers.values.segment<3>(first); }

void AddCurve(const View& view, const Numbers& numbers, const CurveTrace& trace,
              NormalEquations& sum) {
  std::vector<Seen> polyline;
  polyline.reserve(static_cast<std::size_t>(trace.points));
  for (int i = 0; i < trace.points; ++i) {
    polyline.push_back(See(view, PointOf(numbers, trace.first + 3 * i)));
  }
  for (const Vec2& dot : trace.dots_px) {
    const CurveResidual r = ResidualOfCurve(view, dot, trace.sigma_px, polyline);
    sum.Add(r.residual);
    if (r.segment < 0) sum.chi2 = std::numeric_limits<double>::infinity();
  }
}

NormalEquations Linearise(const Photograph& photograph, const Numbers& numbers,
                          const ParameterVector& parameters) {
  const View view = ViewOf(parameters, photograph.frame);
  NormalEquations sum;
  for (const Trace& trace : photograph.traces) {
    if (const auto* edge = std::get_if<EdgeTrace>(&trace)) {
      for (const Residual& r : EdgeResiduals(view, edge->line, PointOf(numbers, edge->from),
                                             PointOf(numbers, edge->to))) {
        sum.Add(r);
      }
    } else if (const auto* direction = std::get_if<DirectionTrace>(&trace)) {
      sum.Add(DirectionResidual(view, direction->line, Vec3::Unit(direction->axis)));
    } else if (const auto* point = std::get_if<PointTrace>(&trace)) {
      for (const Residual& r :
           PointResiduals(view, point->dot_px, point->sigma_px, PointOf(numbers, point->at))) {
        sum.Add(r);
      }
    } else if (const auto* curve = std::get_if<CurveTrace>(&trace)) {
      AddCurve(view, numbers, *curve, sum);
    }
  }
  for (int i = 0; i < kIntrinsics; ++i) {
    const Prior& prior = photograph.priors[i];
    if (!(prior.sigma > 0)) continue;
    const double r = (parameters[i] - prior.value) / prior.sigma;
    sum.information(i, i) += 1 / (prior.sigma * prior.sigma);
    sum.gradient[i] += r / prior.sigma;
    sum.chi2 += r * r;
  }
  return sum;
}

// Holds a parameter where it is.
void Hold(NormalEquations& sum, Parameter p) {
  const double diagonal = std::max(sum.information(p, p), 1.0);
  sum.information.row(p).setZero();
  sum.information.col(p).setZero();
  sum.information(p, p) = diagonal;
  sum.gradient[p] = 0;
}

// A little damping is always there, so that a direction that nothing determines is not moved by
// rounding; it slows nothing, as it is far below the smallest curvature of what is determined.
constexpr double kLeastDamping = 1e-13;
constexpr int kMostIterations = 100;

// A step in its own deviations: √(δᵀ H δ).
double Deviations(const ParameterVector& step, const ParameterMatrix& information) {
  return std::sqrt(std::max(0.0, step.dot(information.selfadjointView<Eigen::Lower>() * step)));
}

bool IsWithinRounding(const ParameterVector& step, const ParameterVector& at) {
  return (step.array().abs() <= 1e-12 * (at.array().abs() + 1e-3)).all();
}

}  // namespace

bool NeedsCameraAlone(const Photograph& photograph) {
  return std::ranges::all_of(photograph.traces, [](const Trace& trace) {
    return std::holds_alternative<EdgeTrace>(trace) ||
           std::holds_alternative<DirectionTrace>(trace) ||
           std::holds_alternative<PointTrace>(trace) || std::holds_alternative<CurveTrace>(trace);
  });
}

CameraFit FitCamera(const Photograph& photograph, const Numbers& numbers, const Camera& start,
                    std::optional<double> skew_rad) {
  CameraFit fit;
  fit.camera = start;
  if (skew_rad) fit.camera[kSkew] = *skew_rad;
  ParameterVector& x = fit.camera.parameters;
  NormalEquations sum = Linearise(photograph, numbers, x);
  double damping = 1e-6, last = std::numeric_limits<double>::infinity();
  while (std::isfinite(sum.chi2) && fit.iterations < kMostIterations) {
    ++fit.iterations;
    if (skew_rad) Hold(sum, kSkew);
    ParameterMatrix damped = sum.information;
    // A parameter that no residual sees has nothing to be damped in proportion to.
    damped.diagonal() += damping * sum.information.diagonal().cwiseMax(1e-30);
    const Eigen::LDLT<ParameterMatrix> factors(damped);
    const ParameterVector step = -factors.solve(sum.gradient);
    if (!step.allFinite()) break;
    // So near, χ² itself changes by less than its rounding, and each step is much smaller than the
    // one before until it is rounding, too.
    const double deviations = Deviations(step, sum.information);
    const bool is_near = deviations < 1e-4, is_free = damping <= kLeastDamping;
    fit.converged =
        is_near && (deviations <= 1e-8 || deviations > 0.5 * last || IsWithinRounding(step, x));
    last = is_near && is_free ? deviations : last;
    const NormalEquations there = Linearise(photograph, numbers, x + step);
    if (is_near || there.chi2 <= sum.chi2) {
      x += step;
      sum = there;
      damping = std::max(damping * 1e-4, kLeastDamping);
    } else {
      damping = std::max(damping * 10, 1e-6);
      if (damping > 1e12) break;
    }
    if (fit.converged) break;
  }
  fit.chi2 = sum.chi2;
  fit.residuals = sum.residuals;
  fit.information = sum.information.selfadjointView<Eigen::Lower>();
  return fit;
}

bool SeesTraces(const Photograph& photograph, const Numbers& numbers, const Camera& camera) {
  const View view = ViewOf(camera.parameters, photograph.frame);
  if (!(camera[kFocal] > 0 && camera[kAspect] > 0)) return false;
  const auto depth = [&](NumberIndex first) { return See(view, PointOf(numbers, first)).dot.z(); };
  return std::ranges::all_of(photograph.traces, [&](const Trace& trace) {
    if (const auto* edge = std::get_if<EdgeTrace>(&trace))
      return depth(edge->from) > 0 || depth(edge->to) > 0;
    if (const auto* point = std::get_if<PointTrace>(&trace)) return depth(point->at) > 0;
    const auto* curve = std::get_if<CurveTrace>(&trace);
    for (int i = 0; curve && i < curve->points; ++i) {
      if (depth(curve->first + 3 * i) > 0) return true;
    }
    return !curve;
  });
}

}  // namespace tranos::camera
