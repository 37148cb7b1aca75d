// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/vanishing_point.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace tranos::camera {
namespace {

// A line, and how far along it a point is, as forms of homogeneous points.
struct Pencil {
  Vec3 line, along;
  double centre_sigma, tilt_sigma;
};

Pencil PencilOf(const ImageLine& line, const Conditioning& conditioning) {
  const Vec2 a = conditioning.PointFromDot(line.a_px), b = conditioning.PointFromDot(line.b_px);
  const double length = (b - a).norm();
  const Vec2 direction = (b - a) / length, centre = 0.5 * (a + b);
  const Vec2 normal(-direction.y(), direction.x());
  return {{normal.x(), normal.y(), -normal.dot(centre)},
          Vec3(direction.x(), direction.y(), -direction.dot(centre)) / length,
          line.centre_sigma_px / conditioning.scale_px,
          line.tilt_sigma_px / conditioning.scale_px};
}

double Sigma(const Pencil& p, const Vec3& v) {
  return std::hypot(p.centre_sigma * v.z(), p.tilt_sigma * p.along.dot(v));
}

struct Normal {
  Mat3 information = Mat3::Zero();
  Vec3 gradient = Vec3::Zero();
  double misfit = 0;
};

void Add(const Pencil& p, const Vec3& v, Normal* normal) {
  const double sigma = Sigma(p, v), residual = p.line.dot(v) / sigma;
  const Vec3 slope = (p.centre_sigma * p.centre_sigma * v.z() * Vec3::UnitZ() +
                      p.tilt_sigma * p.tilt_sigma * p.along.dot(v) * p.along) /
                     sigma;
  const Vec3 row = (p.line - residual * slope) / sigma;
  normal->information += row * row.transpose();
  normal->gradient += row * residual;
  normal->misfit += residual * residual;
}

Normal NormalAt(std::span<const ImageLine> lines, const Conditioning& conditioning, const Vec3& v) {
  Normal normal;
  for (const ImageLine& line : lines) Add(PencilOf(line, conditioning), v, &normal);
  return normal;
}

// The pair that meets at the largest angle on the sphere, for its size known best.
Vec3 Meet(std::span<const ImageLine> lines, const Conditioning& conditioning) {
  Vec3 best = Vec3::Zero();
  for (size_t i = 0; i < lines.size(); ++i)
    for (size_t j = i + 1; j < lines.size() && j < i + 16; ++j) {
      const Vec3 meet =
          PencilOf(lines[i], conditioning).line.cross(PencilOf(lines[j], conditioning).line);
      if (meet.squaredNorm() > best.squaredNorm()) best = meet;
    }
  return best;
}

Eigen::Matrix<double, 3, 2> TangentBasis(const Vec3& v) {
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = v.unitOrthogonal();
  basis.col(1) = v.cross(basis.col(0));
  return basis;
}

tl::unexpected<geom::Error> Degenerate(const char* detail) {
  return tl::unexpected(geom::Error{geom::ErrorCode::kDegenerate, detail});
}

}  // namespace

double VanishingPoint::FromInfinity() const {
  return std::abs(point.z()) / std::sqrt(std::max(covariance(2, 2), 1e-300));
}

double PencilMisfit(std::span<const ImageLine> lines, const Conditioning& conditioning,
                    const Vec3& v) {
  return NormalAt(lines, conditioning, v).misfit;
}

geom::Result<VanishingPoint> FitVanishingPoint(std::span<const ImageLine> lines,
                                               const Conditioning& conditioning) {
  if (lines.size() < 2) return Degenerate("a vanishing point needs two lines");
  for (const ImageLine& line : lines)
    if (!(line.length_px() > 0) || !(line.centre_sigma_px > 0) || !(line.tilt_sigma_px > 0))
      return Degenerate("a line has no length or no deviation");
  Vec3 v = Meet(lines, conditioning);
  if (!(v.norm() > 1e-12)) return Degenerate("the lines are all the same line");
  v.normalize();
  for (int i = 0; lines.size() > 2 && i < 2; ++i) {
    Mat3 scatter = Mat3::Zero();
    for (const ImageLine& line : lines) {
      const Pencil p = PencilOf(line, conditioning);
      scatter += p.line * p.line.transpose() / std::pow(Sigma(p, v), 2);
    }
    Eigen::SelfAdjointEigenSolver<Mat3> eigen;
    eigen.computeDirect(scatter);
    v = eigen.eigenvectors().col(0);
  }

  Normal normal = NormalAt(lines, conditioning, v);
  for (int i = 0; i < 20; ++i) {
    const auto basis = TangentBasis(v);
    const Eigen::Matrix2d information = basis.transpose() * normal.information * basis;
    if (!(information.determinant() > 0)) break;
    Vec2 step = -information.inverse() * (basis.transpose() * normal.gradient);
    bool better = false;
    for (int halving = 0; halving < 8 && !better; ++halving, step *= 0.5) {
      const Vec3 next = (v + basis * step).normalized();
      const Normal at = NormalAt(lines, conditioning, next);
      better = at.misfit < normal.misfit;
      if (better) v = next, normal = at;
    }
    if (!better || step.norm() < 1e-14) break;
  }

  const auto basis = TangentBasis(v);
  const Eigen::Matrix2d information = basis.transpose() * normal.information * basis;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(information);
  // A deviation of a radian: the direction between the lines is not known at all.
  if (!(eigen.eigenvalues()[0] > 1))
    return Degenerate("the lines are the same line within their noise");
  const Eigen::Matrix2d covariance = information.inverse();
  return VanishingPoint{v, basis * covariance * basis.transpose(), normal.misfit,
                        1 / std::sqrt(eigen.eigenvalues()[0])};
}

}  // namespace tranos::camera
