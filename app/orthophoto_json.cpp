// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/orthophoto_json.h"

#include <nlohmann/json.hpp>

#include "model/element.h"

namespace tranos::app {

using nlohmann::ordered_json;

namespace {

ordered_json ListOf(const geom::Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

std::string OrthophotoJson(const model::Orthophoto& made, const output::SeenPixels& seen,
                           const std::string& picture) {
  const auto all = static_cast<double>(seen.why.size());
  const ordered_json json = {{"picture", picture},
                             {"facade", made.facade},
                             {"photograph", std::string(made.photograph->name_or_empty())},
                             {"pixel_m", made.pixel_m},
                             {"size_px", {made.size_px.x(), made.size_px.y()}},
                             {"ground_sampling_m", made.sampling_m},
                             {"lower_left_m", ListOf(made.plane.origin)},
                             {"right", ListOf(made.plane.x)},
                             {"up", ListOf(made.plane.y)},
                             {"hidden", static_cast<double>(seen.hidden) / all},
                             {"outside", static_cast<double>(seen.outside) / all}};
  return json.dump(2) + "\n";
}

}  // namespace tranos::app
