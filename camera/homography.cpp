// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/homography.h"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace tranos::camera {
namespace {

tl::unexpected<geom::Error> Degenerate(const char* detail) {
  return tl::unexpected(geom::Error{geom::ErrorCode::kDegenerate, detail});
}

// Takes points to their centre, with mean square distance 2.
Mat3 Normalization(std::span<const Vec2> points) {
  Vec2 centre = Vec2::Zero();
  for (const Vec2& p : points) centre += p / static_cast<double>(points.size());
  double square = 0;
  for (const Vec2& p : points) square += (p - centre).squaredNorm();
  const double scale = std::sqrt(2 * static_cast<double>(points.size()) / square);
  Mat3 m = Mat3::Identity();
  m.topLeftCorner<2, 2>() *= scale;
  m.topRightCorner<2, 1>() = -scale * centre;
  return m;
}

}  // namespace

geom::Result<Mat3> HomographyOfRectangle(std::span<const Vec2, 4> dots, double a, double b) {
  if (!(a > 0) || !(b > 0))
    return tl::unexpected(
        geom::Error{geom::ErrorCode::kOutOfRange, "the sides of a rectangle must be positive"});
  // Around the centre and by the size of the quadrangle, for the test of what is degenerate.
  const Vec2 centre = 0.25 * (dots[0] + dots[1] + dots[2] + dots[3]);
  double size = 0;
  for (const Vec2& dot : dots) size = std::max(size, (dot - centre).norm());
  if (!(size > 0) || !std::isfinite(size)) return Degenerate("the dots of a rectangle are one dot");
  const auto point = [&](int i) -> Vec3 {
    return ((dots[static_cast<size_t>(i)] - centre) / size).homogeneous();
  };
  Mat3 corners;
  corners << point(1), point(3), point(0);
  if (std::abs(corners.determinant()) < 1e-9)
    return Degenerate("three dots of a rectangle are on a line");
  // The third corner is the first displaced by both sides: d₂ = k₁ d₁ + k₃ d₃ − k₀ d₀.
  const Vec3 k = corners.inverse() * point(2);
  if (!(k[0] > 1e-9 && k[1] > 1e-9 && k[2] < -1e-9))
    return Degenerate("the dots of a rectangle are not in order around a convex quadrangle");
  Mat3 h;
  h.col(2) = -k[2] * point(0);
  h.col(0) = (k[0] * point(1) - h.col(2)) / a;
  h.col(1) = (k[1] * point(3) - h.col(2)) / b;
  Mat3 back = Mat3::Identity();
  back.topLeftCorner<2, 2>() *= size;
  back.topRightCorner<2, 1>() = centre;
  return Mat3(back * h / h(2, 2));
}

geom::Result<Mat3> FitHomography(std::span<const Vec2> points, std::span<const Vec2> dots) {
  const size_t count = std::min(points.size(), dots.size());
  if (count < 4) return Degenerate("a homography needs four points");
  const Mat3 source = Normalization(points.first(count)), target = Normalization(dots.first(count));
  if (!source.allFinite() || !target.allFinite()) return Degenerate("all points are one point");
  Eigen::MatrixXd rows =
      Eigen::MatrixXd::Zero(std::max<Eigen::Index>(9, 2 * std::ssize(points)), 9);
  for (size_t i = 0; i < count; ++i) {
    const Vec3 p = source * points[i].homogeneous(), d = target * dots[i].homogeneous();
    const auto at = static_cast<Eigen::Index>(2 * i);
    rows.block<1, 3>(at, 0) = -p.transpose();
    rows.block<1, 3>(at, 6) = d.x() * p.transpose();
    rows.block<1, 3>(at + 1, 3) = -p.transpose();
    rows.block<1, 3>(at + 1, 6) = d.y() * p.transpose();
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeFullV);
  if (!(svd.singularValues()[7] > 1e-9 * svd.singularValues()[0]))
    return Degenerate("the points of a homography are on a line, or all but one are");
  const Eigen::Matrix<double, 9, 1> v = svd.matrixV().col(8);
  Mat3 h;
  h << v.head<3>().transpose(), v.segment<3>(3).transpose(), v.tail<3>().transpose();
  Vec2 centre = Vec2::Zero();
  for (size_t i = 0; i < count; ++i) centre += points[i] / static_cast<double>(count);
  h = (target.inverse() * h * source).eval();
  const double sign = (h * centre.homogeneous()).z() < 0 ? -1 : 1;
  return Mat3(sign * h / h.norm());
}

}  // namespace tranos::camera
