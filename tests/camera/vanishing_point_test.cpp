// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/vanishing_point.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tranos::camera {
namespace {

const Conditioning kConditioning{{799.5, 533}, 800};

// A line of the pencil through v (conditioned, homogeneous), `length` long about `centre`, both in
// conditioned units, with the deviations of one fitted to so many pixels; its centre and tilt off
// by so many deviations.
ImageLine LineThrough(const Vec3& v, const Vec2& centre, double length, double sigma_px,
                      double centre_error = 0, double tilt_error = 0) {
  const Vec2 along = (v.head<2>() - v.z() * centre).normalized();
  const Vec2 across(-along.y(), along.x());
  const double samples = length * kConditioning.scale_px;
  const double centre_sigma = sigma_px / std::sqrt(samples);
  const double tilt_sigma = sigma_px * std::sqrt(12 / samples);
  const Vec2 middle = kConditioning.DotFromPoint(centre) + centre_error * centre_sigma * across;
  const Vec2 half = 0.5 * samples * along + 0.5 * tilt_error * tilt_sigma * across;
  return {middle - half, middle + half, centre_sigma, tilt_sigma};
}

const std::vector<Vec2> kCentres = {{-0.6, -0.3}, {-0.2, 0.4}, {0.3, -0.5}, {0.5, 0.2}, {0.1, 0}};

double Angle(const Vec3& u, const Vec3& v) { return u.normalized().cross(v.normalized()).norm(); }

TEST(VanishingPoint, IsWhereExactLinesMeetNearFarAndAtInfinity) {
  for (const Vec3& v : {Vec3(3, 1, 1), Vec3(0.2, 0.1, 1), Vec3(1000, 3, 1), Vec3(-2e7, 1e7, 1),
                        Vec3(1, 0.1, 0), Vec3(0, 1, 0)}) {
    for (const size_t count : {2, 5}) {
      std::vector<ImageLine> lines;
      for (size_t i = 0; i < count; ++i) lines.push_back(LineThrough(v, kCentres[i], 0.5, 0.5));
      const auto point = FitVanishingPoint(lines, kConditioning);
      ASSERT_TRUE(point);
      EXPECT_LT(Angle(point->point, v), 1e-12);
      EXPECT_LT(point->misfit, 1e-15);
      EXPECT_LT((point->covariance * point->point).norm(), 1e-12 * point->covariance.norm());
    }
  }
}

// Errors in units of the stated deviation over many draws, and χ²: 2 + lines − 2 per draw.
TEST(VanishingPoint, HasTheStatedCovarianceNearAndAtInfinity) {
  for (const Vec3& v : {Vec3(3, 1, 1), Vec3(60, 3, 1), Vec3(1, 0.1, 0)}) {
    std::mt19937_64 random(7);
    const auto normal = [&] {
      const auto uniform = [&] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53; };
      const double radius = std::sqrt(-2 * std::log(uniform()));
      return radius * std::cos(2 * kPi * uniform());
    };
    const int trials = 2000;
    double distance = 0, misfit = 0;
    for (int trial = 0; trial < trials; ++trial) {
      std::vector<ImageLine> lines;
      for (const Vec2& centre : kCentres) {
        const double length = centre.x() > 0 ? 0.2 : 0.7;
        const double first = normal(), second = normal();
        lines.push_back(LineThrough(v, centre, length, 0.5, first, second));
      }
      const auto point = FitVanishingPoint(lines, kConditioning);
      ASSERT_TRUE(point);
      Eigen::Matrix<double, 3, 2> basis;
      basis.col(0) = point->point.unitOrthogonal();
      basis.col(1) = point->point.cross(basis.col(0));
      const Vec2 error = basis.transpose() * v.normalized() / v.normalized().dot(point->point);
      const Eigen::Matrix2d covariance = basis.transpose() * point->covariance * basis;
      distance += error.dot(covariance.inverse() * error);
      misfit += point->misfit;
    }
    EXPECT_NEAR(distance / trials, 2, 4 * std::sqrt(4.0 / trials) + 0.02);
    EXPECT_NEAR(misfit / trials, 3, 4 * std::sqrt(6.0 / trials) + 0.02);
  }
}

TEST(VanishingPoint, LongCertainLinesCountMore) {
  const Vec3 v(3, 1, 1);
  std::vector<ImageLine> lines = {LineThrough(v, kCentres[0], 0.9, 0.1),
                                  LineThrough(v, kCentres[1], 0.9, 0.1),
                                  LineThrough(v, kCentres[2], 0.1, 5, 1, 1)};
  const auto with_doubtful = FitVanishingPoint(lines, kConditioning);
  lines[2] = LineThrough(v, kCentres[2], 0.1, 0.05, 20, 20);  // the same line, believed
  const auto with_believed = FitVanishingPoint(lines, kConditioning);
  ASSERT_TRUE(with_doubtful && with_believed);
  EXPECT_LT(10 * Angle(with_doubtful->point, v), Angle(with_believed->point, v));
}

TEST(VanishingPoint, TellsThatItIsNearlyDegenerateAndFailsOnOneLine) {
  const Vec3 v(3, 0, 1);
  const std::vector<ImageLine> close = {LineThrough(v, {0, 0}, 0.2, 1),
                                        LineThrough(v, {0, 0.02}, 0.2, 1)};
  const auto weak = FitVanishingPoint(close, kConditioning);
  ASSERT_TRUE(weak);
  EXPECT_TRUE(weak->nearly_degenerate());
  const std::vector<ImageLine> apart = {LineThrough(v, {0, -0.5}, 0.8, 0.2),
                                        LineThrough(v, {0, 0.5}, 0.8, 0.2)};
  EXPECT_FALSE(FitVanishingPoint(apart, kConditioning)->nearly_degenerate());

  const std::vector<ImageLine> same = {apart[0], apart[0]};
  EXPECT_FALSE(FitVanishingPoint(same, kConditioning));
  const std::vector<ImageLine> collinear = {LineThrough(v, {0, 0}, 0.1, 1),
                                            LineThrough(v, {0.5, 0}, 0.1, 1, 0.1)};
  EXPECT_FALSE(FitVanishingPoint(collinear, kConditioning));
  EXPECT_FALSE(FitVanishingPoint(std::span(apart).first(1), kConditioning));
}

TEST(VanishingPoint, KnowsHowFarItIsFromInfinity) {
  const auto at = [&](const Vec3& v) {
    std::vector<ImageLine> lines;
    for (const Vec2& centre : kCentres) lines.push_back(LineThrough(v, centre, 0.6, 0.5));
    return FitVanishingPoint(lines, kConditioning)->FromInfinity();
  };
  EXPECT_LT(at({1, 0.2, 0}), 1e-6);
  EXPECT_GT(at({3, 1, 1}), 50);
  EXPECT_LT(at({1e4, 1, 1}), 1);
}

}  // namespace
}  // namespace tranos::camera
