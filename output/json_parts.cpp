// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/json_parts.h"

#include <nlohmann/json.hpp>

namespace tranos::output {

using nlohmann::ordered_json;

ordered_json IntrinsicsJson(const PerParameter& of) {
  return {{"f_mm", of(camera::kFocal)},
          {"aspect", of(camera::kAspect)},
          {"principal_mm", {of(camera::kPrincipalX), of(camera::kPrincipalY)}},
          {"skew_deg", of(camera::kSkew)},
          {"omega_deg", of(camera::kOmega)},
          {"phi_deg", of(camera::kPhi)},
          {"kappa_deg", of(camera::kKappa)}};
}

ordered_json PoseJson(const PerParameter& of) {
  ordered_json pose = IntrinsicsJson(of);
  pose["position_m"] = {of(camera::kX0), of(camera::kY0), of(camera::kZ0)};
  return pose;
}

ordered_json RowsJson(const Eigen::MatrixXd& m) {
  ordered_json rows = ordered_json::array();
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    ordered_json row = ordered_json::array();
    for (Eigen::Index j = 0; j < m.cols(); ++j) row.push_back(m(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace tranos::output
