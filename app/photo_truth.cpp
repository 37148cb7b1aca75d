// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/photo_truth.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/camera_json.h"
#include "model/element.h"

namespace tranos::app {

using nlohmann::ordered_json;

namespace {

constexpr double kDegree = geom::kPi / 180;

ordered_json EffectsJson(const model::PrintEffects& effects) {
  return {{"grain", effects.grain},         {"vignette", effects.vignette},
          {"fade", effects.fade},           {"dust", effects.dust},
          {"scratches", effects.scratches}, {"stains", effects.stains},
          {"paper", effects.paper},         {"scan", effects.scan}};
}

}  // namespace

std::string PhotoTruthJson(const model::PhotoRequest& request, const std::string& picture) {
  model::Photograph photograph = *std::get<model::PhotographPtr>(request.taken->geometry);
  photograph.file = picture;
  photograph.frame = request.frame;
  const geom::Vec3& sun = request.towards_sun;
  const ordered_json json = {
      {"camera", CameraJson(*request.taken, photograph)},
      {"distortion",
       {{"k1", request.distortion.k1},
        {"k2", request.distortion.k2},
        {"centre_mm", {request.distortion.centre_mm.x(), request.distortion.centre_mm.y()}},
        {"unit_mm", request.distortion.unit_mm.x()}}},
      {"sun",
       {{"azimuth_deg", std::atan2(sun.y(), sun.x()) / kDegree},
        {"height_deg", std::asin(sun.z()) / kDegree}}},
      {"effects", EffectsJson(request.effects)},
      {"tone", request.tone == model::PrintTone::kGrey ? "grey" : "sepia"},
      {"seed", request.seed}};
  return json.dump(2) + "\n";
}

}  // namespace tranos::app
