// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/absolute_conic.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace tranos::camera {
namespace {

Mat3 Calibration(double f, double r, double alpha, double u, double v) {
  Mat3 k;
  k << f, f * std::cos(alpha) / std::sin(alpha), u, 0, r * f, v, 0, 0, 1;
  return k;
}

const double kAlpha = 88.7 * kPi / 180;
const Mat3 kCalibration = Calibration(1.9, 1.04, kAlpha, 0.07, -0.11);
const Mat3 kRotation =
    (Eigen::AngleAxisd(0.4, Vec3::UnitX()) * Eigen::AngleAxisd(0.6, Vec3::UnitY()) *
     Eigen::AngleAxisd(0.1, Vec3::UnitZ()))
        .toRotationMatrix();
const Mat3 kAxes = kCalibration * kRotation;  // vanishing points with the lengths' scale

double Difference(const Mat3& a, const Mat3& b) { return (a - b).cwiseAbs().maxCoeff(); }

TEST(AbsoluteConic, DependsOnTheCalibrationAloneAndGivesItBack) {
  const Conic conic = ConicOf(kCalibration);
  for (const double scale : {1.0, -3.0, 1e-6}) {
    const auto inverse = InverseCalibration(scale * conic);
    ASSERT_TRUE(inverse);
    EXPECT_LT(Difference(inverse->inverse(), kCalibration), 1e-12);
  }
  // Rows vanish for what is orthogonal and for equal lengths in space, in any rotation.
  EXPECT_NEAR(OrthogonalRow(kAxes.col(0), kAxes.col(2)).dot(conic), 0, 1e-14);
  EXPECT_NEAR(EqualLengthRow(kAxes.col(1), kAxes.col(2)).dot(conic), 0, 1e-14);
  EXPECT_NEAR(EqualLengthRow(2 * kAxes.col(1), kAxes.col(2)).dot(conic), 3, 1e-13);
  EXPECT_NEAR(SkewRow(kAlpha, 1.04).dot(conic), 0, 1e-14);
  for (const Conic& row : PrincipalPointRows({0.07, -0.11})) EXPECT_NEAR(row.dot(conic), 0, 1e-14);
  const Conic square = ConicOf(Calibration(1.9, 1.04, kPi / 2, 0.07, -0.11));
  EXPECT_NEAR(AspectRow(1.04).dot(square), 0, 1e-14);
  EXPECT_NEAR(ZeroSkewRow().dot(square), 0, 1e-14);
}

TEST(AbsoluteConic, EqualOrthogonalEdgesAreThoseWithOrthogonalDiagonals) {
  const Vec3 u = kAxes.col(0), v = kAxes.col(2);
  EXPECT_EQ(EqualLengthRow(u, v), OrthogonalRow(u + v, u - v));
}

TEST(AbsoluteConic, FiveConstraintsGiveTheCamera) {
  const std::vector<Conic> axes = {OrthogonalRow(kAxes.col(0), kAxes.col(1)),
                                   OrthogonalRow(kAxes.col(1), kAxes.col(2)),
                                   OrthogonalRow(kAxes.col(0), kAxes.col(2))};
  std::vector<Conic> rows = axes;
  rows.push_back(EqualLengthRow(kAxes.col(0), kAxes.col(2)));
  rows.push_back(EqualLengthRow(kAxes.col(1), kAxes.col(2)));
  const auto by_ratios = CalibrationFromRows(rows);
  ASSERT_TRUE(by_ratios);
  EXPECT_LT(Difference(*by_ratios, kCalibration), 1e-12);

  rows = axes;
  for (const Conic& row : PrincipalPointRows({0.07, -0.11})) rows.push_back(row);
  const auto by_principal_point = CalibrationFromRows(rows);
  ASSERT_TRUE(by_principal_point);
  EXPECT_LT(Difference(*by_principal_point, kCalibration), 1e-12);
}

TEST(AbsoluteConic, TellsTheRankOfTheConstraints) {
  std::vector<Conic> rows = {OrthogonalRow(kAxes.col(0), kAxes.col(1)),
                             OrthogonalRow(kAxes.col(1), kAxes.col(2)),
                             OrthogonalRow(kAxes.col(0), kAxes.col(2))};
  rows.push_back(2 * rows[0]);  // says nothing new
  rows.push_back(Conic::Zero());
  EXPECT_EQ(RankOfRows(rows), 3);
  const auto k = CalibrationFromRows(rows);
  ASSERT_FALSE(k);
  EXPECT_NE(k.error().detail.find("3 of the 5"), std::string::npos);
  EXPECT_EQ(RankOfRows({}), 0);
  EXPECT_FALSE(SkewFamilyOf(rows));
}

TEST(AbsoluteConic, OfNoRealCameraIsAnError) {
  Conic hyperbolic;
  hyperbolic << 1, 0, 1, 0, 0, -1;
  EXPECT_FALSE(InverseCalibration(hyperbolic));
  EXPECT_FALSE(InverseCalibration(Conic::Zero()));
  // Vanishing points at an obtuse angle's triangle with a square, unskewed camera.
  const std::vector<Conic> rows = {OrthogonalRow({1, 0, 1}, {2, 0.1, 1}), ZeroSkewRow(),
                                   AspectRow(1), PrincipalPointRows({0, 0})[0],
                                   PrincipalPointRows({0, 0})[1]};
  const auto k = CalibrationFromRows(rows);
  ASSERT_FALSE(k);
  EXPECT_NE(k.error().detail.find("no real camera"), std::string::npos);
}

TEST(AbsoluteConic, TheSkewOfAFamilyIsARootAtItsAngle) {
  for (const double degrees : {88.0, 89.99, 90.0, 90.01, 92.0, 70.0}) {
    const double alpha = degrees * kPi / 180;
    const Mat3 k = Calibration(1.9, 1.04, alpha, 0.07, -0.11);
    const Mat3 axes = k * kRotation;
    const std::vector<Conic> rows = {
        OrthogonalRow(axes.col(0), axes.col(1)), OrthogonalRow(axes.col(1), axes.col(2)),
        OrthogonalRow(axes.col(0), axes.col(2)), EqualLengthRow(axes.col(0), axes.col(2))};
    const auto family = SkewFamilyOf(rows);
    ASSERT_TRUE(family);
    const SkewRoots roots = CalibrationsAtSkew(*family, alpha);
    double nearest = 1;
    for (int i = 0; i < roots.count; ++i) {
      const Mat3 root = roots.inverse[static_cast<size_t>(i)].inverse();
      nearest = std::min(nearest, Difference(root, k));
      EXPECT_NEAR(std::atan2(root(0, 0), root(0, 1)), alpha, 1e-9);  // every root has that skew
    }
    EXPECT_LT(nearest, 1e-10) << degrees;
  }
}

}  // namespace
}  // namespace tranos::camera
