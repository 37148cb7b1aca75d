// SPDX-License-Identifier: GPL-3.0-or-later
// What the program's report and the files of cameras say alike in JSON.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <nlohmann/json_fwd.hpp>

#include "camera/camera.h"

namespace tranos::output {

using PerParameter = std::function<nlohmann::ordered_json(camera::Parameter)>;

// f_mm, aspect, principal_mm, skew_deg, omega_deg, phi_deg and kappa_deg, as `of` tells them.
nlohmann::ordered_json IntrinsicsJson(const PerParameter& of);
// The same, and position_m.
nlohmann::ordered_json PoseJson(const PerParameter& of);
// A matrix as a list of its rows.
nlohmann::ordered_json RowsJson(const Eigen::MatrixXd& m);

}  // namespace tranos::output
