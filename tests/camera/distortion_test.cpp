// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/distortion.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

namespace tranos::camera {
namespace {

using geom::ErrorCode;

const Frame kFrame{{36, 24}, {3600, 2400}};
const Vec2 kCentre{0.7, -0.4};

Distortion Barrel(double k1 = -0.06, double k2 = 0.015) {
  return {kCentre, Vec2::Constant(0.5 * kFrame.size_mm.norm()), k1, k2};
}

double Normal(std::mt19937_64& random) {
  const auto uniform = [&] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53; };
  const double radius = std::sqrt(-2 * std::log(uniform()));
  return radius * std::cos(2 * kPi * uniform());
}

// Dots evenly along the picture of a straight line, each coordinate with noise.
PlumbLine Seen(const Distortion& d, const Vec2& a, const Vec2& b, int dots, double sigma,
               std::mt19937_64* random = nullptr) {
  PlumbLine line{{}, sigma};
  for (int i = 0; i < dots; ++i) {
    Vec2 dot = DistortDot(d, kFrame, a + (b - a) * i / (dots - 1));
    if (random) {
      dot.x() += sigma * Normal(*random);
      dot.y() += sigma * Normal(*random);
    }
    line.dots_px.push_back(dot);
  }
  return line;
}

// Level and upright lines all over the picture.
std::vector<PlumbLine> Facade(const Distortion& d, double sigma,
                              std::mt19937_64* random = nullptr) {
  std::vector<PlumbLine> lines;
  for (const double at : {0.03, 0.2, 0.6, 0.95}) {
    lines.push_back(Seen(d, {100, 2400 * at}, {3500, 2400 * at + 60}, 40, sigma, random));
    lines.push_back(Seen(d, {3600 * at, 80}, {3600 * at - 50, 2300}, 30, sigma, random));
  }
  return lines;
}

TEST(Distorted, ADotMovesAlongItsRadiusByThePolynomial) {
  const Distortion d = Barrel();
  const Vec2 centre = kFrame.DotFromPoint(kCentre);
  const double unit = 0.5 * kFrame.size_mm.norm() / 0.01;  // in dots
  for (const Vec2& dot : {Vec2(10, 20), Vec2(3000, 100), Vec2(1800, 2399)}) {
    const Vec2 off = dot - centre;
    const double s = off.squaredNorm() / (unit * unit);
    const Vec2 expected = centre + off * (1 - 0.06 * s + 0.015 * s * s);
    EXPECT_LT((DistortDot(d, kFrame, dot) - expected).norm(), 1e-9);
  }
}

TEST(Undistorted, IsTheInverseForBarrelPincushionAndUnequalUnits) {
  Distortion unequal = Barrel(0.08, -0.004);
  unequal.unit_mm = {17.1, 18.3};
  for (const Distortion& d : {Barrel(), Barrel(0.1, 0.05), Barrel(-0.1, 0), unequal}) {
    for (double x = 0; x < 3600; x += 171) {
      for (double y = 0; y < 2400; y += 113) {
        const auto back = UndistortDot(d, kFrame, DistortDot(d, kFrame, {x, y}));
        ASSERT_TRUE(back.has_value());
        EXPECT_LT((*back - Vec2(x, y)).norm(), 1e-12 * 3000);
      }
    }
  }
  const Vec2 centre = kFrame.DotFromPoint(kCentre);
  EXPECT_LT((*UndistortDot(Barrel(), kFrame, centre) - centre).norm(), 1e-12);
}

TEST(Undistorted, BeyondTheFoldThereIsNoDot) {
  // r (1 − r² / 3) is largest at r = 1, where it is 2/3 of the unit.
  const Distortion d = Barrel(-1. / 3, 0);
  const Vec2 centre = kFrame.DotFromPoint(kCentre);
  const double unit = 0.5 * kFrame.size_mm.norm() / 0.01;
  const auto inside = UndistortDot(d, kFrame, centre + Vec2(0.66 * unit, 0));
  ASSERT_TRUE(inside.has_value());
  EXPECT_LT(inside->x(), centre.x() + unit);
  EXPECT_EQ(UndistortDot(d, kFrame, centre + Vec2(0.67 * unit, 0)).error().code,
            ErrorCode::kOutOfRange);
}

TEST(PlumbLines, WithoutNoiseBothTermsAreFound) {
  const auto fit = FitDistortion(Facade(Barrel(), 0.5), kFrame, kCentre, 2);
  ASSERT_TRUE(fit.has_value()) << fit.error().detail;
  EXPECT_NEAR(fit->distortion.k1, -0.06, 1e-8 * 0.06);
  EXPECT_NEAR(fit->distortion.k2, 0.015, 1e-8 * 0.015);
  EXPECT_LT(fit->misfit, 1e-12);
  EXPECT_EQ(fit->degrees_of_freedom, 4 * 40 + 4 * 30 - 8 * 2 - 2);
}

TEST(PlumbLines, WithoutNoiseTheOneTermIsFoundForPixelsThatAreNotSquare) {
  const Frame tall{{36, 24}, {3600, 2000}};
  const Distortion d{kCentre, Vec2::Constant(0.5 * tall.size_mm.norm()), 0.04, 0};
  std::vector<PlumbLine> lines;
  for (const double y : {50., 400., 1700.}) {
    PlumbLine line{{}, 1};
    for (int i = 0; i < 20; ++i) {
      line.dots_px.push_back(DistortDot(d, tall, {100 + 170. * i, y + 5. * i}));
    }
    lines.push_back(line);
  }
  const auto fit = FitDistortion(lines, tall, kCentre, 1);
  ASSERT_TRUE(fit.has_value()) << fit.error().detail;
  EXPECT_NEAR(fit->distortion.k1, 0.04, 1e-8 * 0.04);
  EXPECT_EQ(fit->distortion.k2, 0);
  EXPECT_EQ(fit->covariance(1, 1), 0);
}

TEST(PlumbLines, AreStraightOnceTheDistortionIsTakenAway) {
  const std::vector<PlumbLine> lines = Facade(Barrel(0.05, 0.02), 0.5);
  const auto fit = FitDistortion(lines, kFrame, kCentre, 2);
  ASSERT_TRUE(fit.has_value());
  for (const PlumbLine& line : lines) {
    std::vector<Vec2> dots;
    for (const Vec2& dot : line.dots_px) {
      dots.push_back(*UndistortDot(fit->distortion, kFrame, dot));
    }
    const Vec2 along = (dots.back() - dots.front()).normalized();
    for (const Vec2& dot : dots) {
      const Vec2 off = dot - dots.front();
      EXPECT_LT(std::abs(along.x() * off.y() - along.y() * off.x()), 1e-5);
    }
  }
}

// (k̂ − k)ᵀ C⁻¹ (k̂ − k) is χ² with two degrees of freedom, the misfit with its own number.
TEST(PlumbLines, WithNoiseTheCovarianceIsThatOfTheErrors) {
  std::mt19937_64 random(1871);
  constexpr int kTrials = 200;
  double sum = 0, misfit = 0;
  int degrees = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto fit = FitDistortion(Facade(Barrel(), 0.5, &random), kFrame, kCentre, 2);
    ASSERT_TRUE(fit.has_value()) << fit.error().detail;
    const Vec2 off(fit->distortion.k1 + 0.06, fit->distortion.k2 - 0.015);
    EXPECT_LT(std::abs(off.x()), 4 * std::sqrt(fit->covariance(0, 0)));
    EXPECT_LT(std::abs(off.y()), 4 * std::sqrt(fit->covariance(1, 1)));
    sum += off.dot(fit->covariance.inverse() * off);
    misfit += fit->misfit;
    degrees = fit->degrees_of_freedom;
  }
  EXPECT_NEAR(sum / kTrials, 2, 4 * 2 / std::sqrt(kTrials));
  EXPECT_NEAR(misfit / kTrials, degrees, 4 * std::sqrt(2. * degrees / kTrials));
}

TEST(PlumbLines, OneTermOfTwoIsTheBestThatOneCanDo) {
  std::mt19937_64 random(7);
  const auto lines = Facade(Barrel(-0.05, 0), 0.5, &random);
  const auto one = FitDistortion(lines, kFrame, kCentre, 1);
  const auto two = FitDistortion(lines, kFrame, kCentre, 2);
  ASSERT_TRUE(one && two);
  EXPECT_NEAR(one->distortion.k1, -0.05, 4 * std::sqrt(one->covariance(0, 0)));
  EXPECT_LT(one->covariance(0, 0), two->covariance(0, 0));
  EXPECT_GE(one->misfit, two->misfit);
}

TEST(PlumbLines, ThroughTheCentreTellNothing) {
  const Vec2 c = kFrame.DotFromPoint(kCentre);
  for (const bool noisy : {false, true}) {
    std::mt19937_64 random(3);
    std::vector<PlumbLine> lines;
    for (const Vec2& along : {Vec2(1500, 100), Vec2(-200, 1000), Vec2(1100, -900)}) {
      lines.push_back(Seen(Barrel(), c - along, c + along, 60, 0.5, noisy ? &random : nullptr));
    }
    for (const int terms : {1, 2}) {
      const auto fit = FitDistortion(lines, kFrame, kCentre, terms);
      ASSERT_FALSE(fit.has_value());
      EXPECT_EQ(fit.error().code, ErrorCode::kDegenerate);
    }
    // One line beside them is enough.
    lines.push_back(Seen(Barrel(), {50, 100}, {3500, 80}, 60, 0.5));
    EXPECT_TRUE(FitDistortion(lines, kFrame, kCentre, 1).has_value());
  }
}

// On three dots a line has one residual, so a single such line cannot tell two terms.
TEST(PlumbLines, TooFewDistancesDoNotTellTwoTerms) {
  const std::vector<PlumbLine> lines{Seen(Barrel(), {50, 100}, {3500, 80}, 3, 0.5)};
  EXPECT_TRUE(FitDistortion(lines, kFrame, kCentre, 1).has_value());
  EXPECT_EQ(FitDistortion(lines, kFrame, kCentre, 2).error().code, ErrorCode::kDegenerate);
}

TEST(PlumbLines, BadInputIsSaidWithItsLine) {
  auto lines = Facade(Barrel(), 0.5);
  EXPECT_EQ(FitDistortion(lines, kFrame, kCentre, 3).error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(FitDistortion({}, kFrame, kCentre, 1).error().code, ErrorCode::kDegenerate);
  lines[2].dots_px.resize(2);
  EXPECT_EQ(FitDistortion(lines, kFrame, kCentre, 1).error().part, 2);
  lines = Facade(Barrel(), 0.5);
  lines[1].sigma_px = 0;
  EXPECT_EQ(FitDistortion(lines, kFrame, kCentre, 1).error().part, 1);
  lines = Facade(Barrel(), 0.5);
  lines[3].dots_px.assign(5, Vec2(1, 1));
  EXPECT_EQ(FitDistortion(lines, kFrame, kCentre, 1).error().part, 3);
}

}  // namespace
}  // namespace tranos::camera
