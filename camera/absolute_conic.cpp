// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/absolute_conic.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace tranos::camera {
namespace {

// Singular values below this part of the largest are zero.
constexpr double kRank = 1e-9;

tl::unexpected<geom::Error> Degenerate(std::string detail) {
  return tl::unexpected(geom::Error{geom::ErrorCode::kDegenerate, std::move(detail)});
}

struct Decomposed {
  Eigen::Matrix<double, 6, 6> v;  // the weakest direction last
  int rank;
};

Decomposed Decompose(std::span<const Conic> rows) {
  // Rows that are no constraint at all stay out; the others are compared by their size.
  double largest = 0;
  for (const Conic& row : rows) largest = std::max(largest, row.norm());
  Eigen::Matrix<double, Eigen::Dynamic, 6> a(std::max<Eigen::Index>(6, std::ssize(rows)), 6);
  a.setZero();
  for (size_t i = 0; i < rows.size(); ++i)
    if (largest > 0) a.row(static_cast<Eigen::Index>(i)) = rows[i] / largest;
  using Square = Eigen::Matrix<double, 6, 6>;
  const Square square =
      rows.size() <= 6
          ? Square(a)
          : Square(a.householderQr().matrixQR().topRows<6>().triangularView<Eigen::Upper>());
  const Eigen::JacobiSVD<Square> svd(square, Eigen::ComputeFullV);
  int rank = 0;
  while (rank < 6 && svd.singularValues()[rank] > kRank * svd.singularValues()[0]) ++rank;
  return {svd.matrixV(), rank};
}

}  // namespace

Conic OrthogonalRow(const Vec3& u, const Vec3& v) {
  Conic row;
  row << u.x() * v.x(), u.x() * v.y() + u.y() * v.x(), u.y() * v.y(), u.x() * v.z() + u.z() * v.x(),
      u.y() * v.z() + u.z() * v.y(), u.z() * v.z();
  return row;
}

Conic EqualLengthRow(const Vec3& u, const Vec3& v) { return OrthogonalRow(u + v, u - v); }

Conic ZeroSkewRow() { return Conic::Unit(1); }

Conic AspectRow(double aspect) { return Conic::Unit(0) - aspect * aspect * Conic::Unit(2); }

std::array<Conic, 2> PrincipalPointRows(const Vec2& principal) {
  const Vec3 point = principal.homogeneous();
  return {OrthogonalRow(Vec3::UnitX(), point), OrthogonalRow(Vec3::UnitY(), point)};
}

Conic SkewRow(double alpha, double aspect) {
  return Conic::Unit(1) + std::cos(alpha) / std::sin(alpha) / aspect * Conic::Unit(0);
}

Conic ConicOf(const Mat3& k) {
  const Mat3 inverse = k.inverse();
  const Mat3 w = inverse.transpose() * inverse;
  Conic conic;
  conic << w(0, 0), w(0, 1), w(1, 1), w(0, 2), w(1, 2), w(2, 2);
  return conic;
}

std::optional<Mat3> InverseCalibration(const Conic& conic) {
  const double sign = conic[0] < 0 ? -1 : 1;
  const double w11 = sign * conic[0], w12 = sign * conic[1], w22 = sign * conic[2];
  const double w13 = sign * conic[3], w23 = sign * conic[4], w33 = sign * conic[5];
  if (!(w11 > 0)) return std::nullopt;
  const double a = std::sqrt(w11), b = w12 / a, c = w13 / a;
  const double left = w22 - b * b;
  if (!(left > 0)) return std::nullopt;
  const double d = std::sqrt(left), e = (w23 - b * c) / d;
  const double last = w33 - c * c - e * e;
  if (!(last > 0)) return std::nullopt;
  const double g = std::sqrt(last);
  Mat3 inverse;
  inverse << a / g, b / g, c / g, 0, d / g, e / g, 0, 0, 1;
  return inverse;
}

geom::Result<Mat3> CalibrationFromRows(std::span<const Conic> rows) {
  const Decomposed decomposed = Decompose(rows);
  if (decomposed.rank < 5)
    return Degenerate("the constraints fix " + std::to_string(decomposed.rank) +
                      " of the 5 numbers of the camera");
  const std::optional<Mat3> inverse = InverseCalibration(decomposed.v.col(5));
  if (!inverse)
    return Degenerate("the conic that fulfils the constraints is that of no real camera");
  return inverse->inverse().eval();
}

int RankOfRows(std::span<const Conic> rows) { return std::min(Decompose(rows).rank, 5); }

geom::Result<SkewFamily> SkewFamilyOf(std::span<const Conic> rows) {
  const Decomposed decomposed = Decompose(rows);
  if (decomposed.rank < 4)
    return Degenerate("the constraints fix " + std::to_string(decomposed.rank) +
                      " of the 5 numbers of the camera, 4 are needed");
  const Conic a = decomposed.v.col(5), b = decomposed.v.col(4);
  const double skew = std::hypot(a[1], b[1]);
  if (!(skew > 1e-12)) return Degenerate("the constraints already fix the skew");
  SkewFamily family{(a * b[1] - b * a[1]) / skew, (a * a[1] + b * b[1]) / skew};
  family.without_skew[1] = 0;
  if (family.without_skew[0] < 0) family.without_skew = -family.without_skew;
  return family;
}

SkewRoots CalibrationsAtSkew(const SkewFamily& family, double alpha) {
  const Conic &a = family.without_skew, &b = family.other;
  const double c = std::cos(alpha), c2 = c * c;
  // ω = a + t b with a₁₂ = 0, so that t = O(c) and nothing cancels near 90°:
  // t² (b₁₂² − c² b₁₁ b₂₂) − c² t (a₁₁ b₂₂ + a₂₂ b₁₁) − c² a₁₁ a₂₂ = 0, with t = c τ.
  const double square = b[1] * b[1] - c2 * b[0] * b[2], linear = a[0] * b[2] + a[2] * b[0];
  const double discriminant = c2 * linear * linear + 4 * square * a[0] * a[2];
  SkewRoots roots;
  if (!(discriminant >= 0) || square == 0) return roots;
  const double root = std::sqrt(discriminant);
  double tau[2] = {(c * linear - root) / (2 * square), (c * linear + root) / (2 * square)};
  if (std::abs(tau[1]) < std::abs(tau[0])) std::swap(tau[0], tau[1]);
  for (const double t : {c * tau[0], c * tau[1]}) {
    const Conic conic = a + t * b;
    // ω₁₂ / ω₁₁ has the sign of −cot α in a real camera.
    if (conic[1] * conic[0] * c > 0) continue;
    if (const std::optional<Mat3> inverse = InverseCalibration(conic)) {
      roots.inverse[static_cast<size_t>(roots.count++)] = *inverse;
      if (c == 0) break;
    }
  }
  return roots;
}

}  // namespace tranos::camera
