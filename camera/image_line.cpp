// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/image_line.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace tranos::camera {

Vec3 ImageLine::coordinates() const {
  const Vec2 along = (b_px - a_px).normalized();
  const Vec2 normal(-along.y(), along.x());
  return {normal.x(), normal.y(), -normal.dot(centre_px())};
}

geom::Result<ImageLine> FitImageLine(const std::vector<Vec2>& dots_px, double sigma_px,
                                     double samples) {
  const auto degenerate = [](const char* detail) {
    return tl::unexpected(geom::Error{geom::ErrorCode::kDegenerate, detail});
  };
  if (!(sigma_px > 0) || !std::isfinite(sigma_px))
    return degenerate("the deviation of the dots of a line must be positive");
  Vec2 centre = Vec2::Zero();
  for (const Vec2& dot : dots_px) {
    if (!dot.allFinite()) return degenerate("a dot of a line is not a finite point");
    centre += dot / static_cast<double>(dots_px.size());
  }
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Vec2& dot : dots_px) scatter += (dot - centre) * (dot - centre).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(scatter);
  const double rounding = 1e-12 * (1 + centre.norm());
  if (dots_px.size() < 2 || !(eigen.eigenvalues()[1] > rounding * rounding))
    return degenerate("a line needs two different dots");
  if (eigen.eigenvalues()[0] > 0.9 * eigen.eigenvalues()[1])
    return degenerate("the dots of a line spread alike in all directions");

  Vec2 along = eigen.eigenvectors().col(1);
  if (along.dot(dots_px.back() - dots_px.front()) < 0) along = -along;
  const Vec2 across(-along.y(), along.x());
  double half = 0, misfit = 0;
  for (const Vec2& dot : dots_px) {
    half = std::max(half, std::abs(along.dot(dot - centre)));
    misfit += std::pow(across.dot(dot - centre) / sigma_px, 2);
  }
  const bool stated = samples > 0 && dots_px.size() == 2;
  const double count = stated ? samples : static_cast<double>(dots_px.size());
  // Across the line, the slope has deviation σ/√Σx²; N pixels spread evenly have Σx² = N L²/12.
  const double tilt = stated ? sigma_px * std::sqrt(12 / count)
                             : 2 * half * sigma_px / std::sqrt(eigen.eigenvalues()[1]);
  return ImageLine{centre - half * along,
                   centre + half * along,
                   sigma_px / std::sqrt(count),
                   tilt,
                   static_cast<int>(dots_px.size()),
                   dots_px.size() == 2 ? 0 : misfit};
}

int SamplesOf(const ImageLine& line, double sigma_px) {
  constexpr double kMost = 1e6;
  const double samples = 12 * std::pow(sigma_px / line.tilt_sigma_px, 2);
  return static_cast<int>(std::round(std::clamp(samples, 2.0, kMost)));
}

}  // namespace tranos::camera
