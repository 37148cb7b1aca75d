// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/factors.h"

#include <Eigen/SVD>
#include <cmath>

namespace tranos::output {

Factors FactorsOf(const Eigen::Matrix3d& linear) {
  Factors factors;
  const Eigen::Matrix3d gram = linear.transpose() * linear;
  const double off_diagonal = std::abs(gram(0, 1)) + std::abs(gram(0, 2)) + std::abs(gram(1, 2));
  if (off_diagonal <= 1e-12 * gram.trace()) {
    factors.scale = linear.colwise().norm().transpose();
    factors.rotation = linear * factors.scale.cwiseInverse().asDiagonal();
    factors.before.setIdentity();
  } else {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
    factors.rotation = svd.matrixU();
    factors.scale = svd.singularValues();
    factors.before = svd.matrixV().transpose();
  }
  if (factors.rotation.determinant() < 0) {
    factors.rotation.col(0) *= -1;
    factors.scale.x() *= -1;
  }
  if (factors.before.determinant() < 0) {
    factors.before.row(0) *= -1;
    factors.scale.x() *= -1;
  }
  return factors;
}

}  // namespace tranos::output
