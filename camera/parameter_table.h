// SPDX-License-Identifier: GPL-3.0-or-later
// The eleven parameters as reports name them.
#pragma once

#include <string_view>

#include "camera/camera.h"

namespace tranos::camera {

struct ParameterRow {
  std::string_view symbol;
  std::string_view words;
  std::string_view unit;  // of reports
  double per_unit;        // of the parameter's own unit, for one of `unit`
};
inline constexpr ParameterRow kParameterRows[kParameters] = {
    {"f", "focal length", "mm", 1},      {"r", "aspect", "", 1},
    {"u", "principal point x", "mm", 1}, {"v", "principal point y", "mm", 1},
    {"α", "skew", "°", kPi / 180},       {"ω", "tilt", "°", kPi / 180},
    {"φ", "pan", "°", kPi / 180},        {"κ", "swing", "°", kPi / 180},
    {"X0", "position x", "m", 1},        {"Y0", "position y", "m", 1},
    {"Z0", "position z", "m", 1}};

}  // namespace tranos::camera
