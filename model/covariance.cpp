// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/covariance.h"

namespace tranos::model {

std::optional<Eigen::Matrix3d> CovarianceOf(const Element& element) {
  if (!element.moved || !std::holds_alternative<Point>(element.geometry)) return std::nullopt;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Moved& moved : *element.moved) {
    const geom::Vec3 for_a_deviation =
        (std::get<Point>(moved.forward).position - std::get<Point>(moved.back).position) /
        (2 * kMovedBy);
    covariance += for_a_deviation * for_a_deviation.transpose();
  }
  return covariance;
}

}  // namespace tranos::model
