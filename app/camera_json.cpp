// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/camera_json.h"

#include <functional>
#include <nlohmann/json.hpp>

#include "camera/parameter_table.h"

namespace tranos::app {

using camera::Estimate;
using camera::Parameter;
using nlohmann::ordered_json;

namespace {

using PerParameter = std::function<ordered_json(Parameter)>;

ordered_json Intrinsics(const PerParameter& of) {
  return {{"f_mm", of(camera::kFocal)},
          {"aspect", of(camera::kAspect)},
          {"principal_mm", {of(camera::kPrincipalX), of(camera::kPrincipalY)}},
          {"skew_deg", of(camera::kSkew)},
          {"omega_deg", of(camera::kOmega)},
          {"phi_deg", of(camera::kPhi)},
          {"kappa_deg", of(camera::kKappa)}};
}

ordered_json WithPositions(const PerParameter& of) {
  ordered_json all = Intrinsics(of);
  all["x_m"] = of(camera::kX0);
  all["y_m"] = of(camera::kY0);
  all["z_m"] = of(camera::kZ0);
  return all;
}

ordered_json PoseJson(const PerParameter& of) {
  ordered_json pose = Intrinsics(of);
  pose["position_m"] = {of(camera::kX0), of(camera::kY0), of(camera::kZ0)};
  return pose;
}

ordered_json CovarianceJson(const Estimate& estimate) {
  if (estimate.covariance.size() == 0) return nullptr;
  ordered_json rows = ordered_json::array();
  for (int i = 0; i < camera::kParameters; ++i) {
    ordered_json row = ordered_json::array();
    for (int j = 0; j < camera::kParameters; ++j) {
      const bool free = estimate.parameters[i].free() || estimate.parameters[j].free();
      const double unit = camera::kParameterRows[i].per_unit * camera::kParameterRows[j].per_unit;
      row.push_back(free ? ordered_json(nullptr) : ordered_json(estimate.covariance(i, j) / unit));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

// How much of each parameter's information came from where.
ordered_json SharesJson(const Estimate& estimate) {
  if (estimate.covariance.size() == 0) return nullptr;
  return WithPositions([&](Parameter p) -> ordered_json {
    if (estimate.parameters[p].free()) return nullptr;
    const camera::Shares& shares = estimate.parameters[p].shares;
    return {{"pixels", shares.pixels}, {"metric", shares.metric}, {"priors", shares.priors}};
  });
}

// What was assumed, by the parameters' symbols.
ordered_json PriorsJson(const model::Photograph& photograph) {
  ordered_json priors = ordered_json::object();
  for (int i = 0; i < camera::kIntrinsics; ++i) {
    const camera::Prior& prior = photograph.priors[i];
    const double unit = camera::kParameterRows[i].per_unit;
    if (!(prior.sigma > 0)) continue;
    priors[camera::kParameterNames[i]] = {{"value", prior.value / unit},
                                          {"sigma", prior.sigma / unit}};
  }
  return priors;
}

// Mean and deviation over resamplings, in the covariance's order.
ordered_json TrialsJson(const camera::TrialSpread& trials) {
  ordered_json mean = ordered_json::array(), deviation = ordered_json::array();
  for (int i = 0; i < camera::kParameters; ++i) {
    const double unit = camera::kParameterRows[i].per_unit;
    mean.push_back(trials.mean[i] / unit);
    deviation.push_back(trials.deviation[i] / unit);
  }
  return {{"trials", trials.trials}, {"mean", mean}, {"deviation", deviation}};
}

// SI, and degrees for angles.
ordered_json UnknownsJson(const model::Photograph& photograph) {
  ordered_json unknowns = ordered_json::object();
  const Estimate& estimate = *photograph.estimate;
  for (std::size_t i = 0; i < estimate.unknowns.size(); ++i) {
    const camera::UnknownEstimate& unknown = estimate.unknowns[i];
    if (unknown.name.empty()) continue;
    const bool is_angle = i < photograph.unknown_dimensions.size() &&
                          photograph.unknown_dimensions[i] == model::kAngle;
    const double unit = is_angle ? geom::kPi / 180 : 1;
    unknowns[unknown.name] = {
        {"value", unknown.value / unit},
        {"sigma", unknown.determined ? ordered_json(unknown.sigma / unit) : nullptr},
        {"determined", unknown.determined},
        {"at_bound", unknown.at_bound}};
  }
  return unknowns;
}

// Traces count from 1, as in messages.
ordered_json RectanglesJson(const Estimate& estimate) {
  ordered_json rectangles = ordered_json::array();
  for (const camera::RectangleView& rectangle : estimate.rectangles) {
    ordered_json homography = ordered_json::array();
    for (int i = 0; i < 3; ++i) {
      const auto row = rectangle.dot_from_metres.row(i);
      homography.push_back({row[0], row[1], row[2]});
    }
    rectangles.push_back({{"trace", rectangle.trace + 1}, {"homography", std::move(homography)}});
  }
  return rectangles;
}

}  // namespace

ordered_json CameraJson(const model::Element& element, const model::Photograph& photograph) {
  const Estimate& estimate = *photograph.estimate;
  const auto value_of = [&](const camera::Camera& camera) -> PerParameter {
    return [&](Parameter p) -> ordered_json {
      if (estimate.parameters[p].free()) return nullptr;
      return camera[p] / camera::kParameterRows[p].per_unit;
    };
  };
  const bool has_deviations = estimate.covariance.size() > 0;
  ordered_json json = {{"name", element.name ? ordered_json(*element.name) : nullptr},
                       {"photograph", photograph.file},
                       {"size_px", {photograph.frame.size_px.x(), photograph.frame.size_px.y()}},
                       {"format_mm", {photograph.frame.size_mm.x(), photograph.frame.size_mm.y()}}};
  json.update(PoseJson(value_of(estimate.camera)));
  json["sigma"] = WithPositions([&](Parameter p) -> ordered_json {
    if (estimate.parameters[p].free() || !has_deviations) return nullptr;
    return estimate.parameters[p].sigma / camera::kParameterRows[p].per_unit;
  });
  json["determined"] =
      WithPositions([&](Parameter p) -> ordered_json { return estimate.parameters[p].determined; });
  json["from_prior"] =
      WithPositions([&](Parameter p) -> ordered_json { return estimate.parameters[p].from_prior; });
  json["covariance"] = CovarianceJson(estimate);
  json["chi2"] = estimate.chi2;
  json["dof"] = estimate.dof;
  json["noise_px"] = estimate.noise_px;
  json["noise_is_estimated"] = estimate.noise_is_estimated;
  json["shares"] = SharesJson(estimate);
  json["priors"] = PriorsJson(photograph);
  if (estimate.trials.trials > 0) json["trials"] = TrialsJson(estimate.trials);
  json["alternatives"] = ordered_json::array();
  for (const camera::Estimate& other : estimate.alternatives) {
    ordered_json alternative = PoseJson(value_of(other.camera));
    alternative["chi2"] = other.chi2;
    json["alternatives"].push_back(std::move(alternative));
  }
  json["unknowns"] = UnknownsJson(photograph);
  if (!estimate.profile.empty()) {
    json["profile"] = ordered_json::array();
    for (const camera::ProfilePoint& point : estimate.profile) {
      json["profile"].push_back({point.alpha_rad * 180 / geom::kPi, point.chi2});
    }
  }
  json["undetermined"] = estimate.undetermined;
  json["warnings"] = ordered_json::array();
  if (estimate.disagreement) json["warnings"].push_back(estimate.disagreement->text);
  for (const std::string& warning : estimate.warnings) json["warnings"].push_back(warning);
  if (!estimate.rectangles.empty()) json["rectangles"] = RectanglesJson(estimate);
  return json;
}

}  // namespace tranos::app
