// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/test_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tranos::camera {
namespace {

using geom::ErrorCode;

const Frame kFrame{{36, 24}, {3600, 2400}};

double Normal(std::mt19937_64& random) {
  const auto uniform = [&] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53; };
  const double radius = std::sqrt(-2 * std::log(uniform()));
  return radius * std::cos(2 * kPi * uniform());
}

// Before the target, which is 2 m by 1.4 m from its origin, looking at its middle from about 2 m.
Camera View(double omega, double phi, double kappa, double f = 28, double r = 1.01) {
  Camera c;
  c.parameters << f, r, 0.31, -0.22, kPi / 2, omega, phi, kappa, 0, 0, 0;
  const Vec3 axis = CameraFromWorld(c.parameters).transpose() * Vec3::UnitZ();
  c.parameters.tail<3>() = Vec3(1, 0, 0.7) - 2.4 * axis;
  return c;
}

std::vector<Camera> Views() {
  return {View(0.3, 0.1, 0), View(-0.35, 0.2, 0.1), View(0.05, 0.5, -0.2), View(0.1, -0.5, 1.5),
          View(-0.2, -0.3, 0.05)};
}

Distortion LensOf(const Camera& c, double k1, double k2) {
  return {{c[kPrincipalX], c[kPrincipalY]}, {c[kFocal], c[kAspect] * c[kFocal]}, k1, k2};
}

std::vector<TargetView> Photographed(const std::vector<Camera>& cameras, double k1, double k2,
                                     double sigma, std::mt19937_64* random = nullptr) {
  std::vector<TargetView> views;
  for (const Camera& c : cameras) {
    TargetView view{{}, {}, sigma};
    for (int i = 0; i <= 8; ++i) {
      for (int j = 0; j <= 6; ++j) {
        const Vec2 on_target(0.25 * i, 1.4 / 6 * j);
        const Vec2 pinhole =
            kFrame.DotFromPoint(Project(c, {on_target.x(), 0, on_target.y()}).point_mm);
        Vec2 dot = DistortDot(LensOf(c, k1, k2), kFrame, pinhole);
        if (random) {
          dot.x() += sigma * Normal(*random);
          dot.y() += sigma * Normal(*random);
        }
        view.points_m.push_back(on_target);
        view.dots_px.push_back(dot);
      }
    }
    views.push_back(view);
  }
  return views;
}

TEST(TestField, WithoutNoiseCamerasPosesAndDistortionAreFound) {
  const std::vector<Camera> truth = Views();
  for (const int terms : {0, 1, 2}) {
    const double k1 = terms > 0 ? -0.11 : 0, k2 = terms > 1 ? 0.07 : 0;
    const auto field = CalibrateByTestField(Photographed(truth, k1, k2, 0.2), kFrame, terms);
    ASSERT_TRUE(field.has_value()) << field.error().detail;
    ASSERT_EQ(field->cameras.size(), truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
      EXPECT_LT((field->cameras[i].parameters - truth[i].parameters).cwiseAbs().maxCoeff(), 1e-8);
    }
    EXPECT_NEAR(field->distortion.k1, k1, 1e-8);
    EXPECT_NEAR(field->distortion.k2, k2, 1e-8);
    EXPECT_EQ(field->degrees_of_freedom, 5 * 63 * 2 - 5 * 6 - 4 - terms);
    EXPECT_EQ(field->distortion_deviation.x() > 0, terms > 0);
    EXPECT_EQ(field->distortion_deviation.y() > 0, terms > 1);
    EXPECT_EQ(field->deviations[0][kSkew], 0);
  }
}

// Errors over their deviations have variance 1, and the misfit is as large as it has degrees.
TEST(TestField, WithNoiseErrorsAreAsLargeAsTheirDeviations) {
  std::mt19937_64 random(1910);
  const std::vector<Camera> truth = Views();
  constexpr int kTrials = 30;
  double sum = 0, misfit = 0;
  int count = 0, degrees = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto field =
        CalibrateByTestField(Photographed(truth, -0.11, 0.07, 0.5, &random), kFrame, 2);
    ASSERT_TRUE(field.has_value()) << field.error().detail;
    for (const Parameter p : {kFocal, kAspect, kPrincipalX, kPrincipalY, kOmega, kY0}) {
      const double off = (field->cameras[0][p] - truth[0][p]) / field->deviations[0][p];
      EXPECT_LT(std::abs(off), 4) << kParameterNames[p];
      sum += off * off;
      ++count;
    }
    const Vec2 off = Vec2(field->distortion.k1 + 0.11, field->distortion.k2 - 0.07)
                         .cwiseQuotient(field->distortion_deviation);
    EXPECT_LT(off.cwiseAbs().maxCoeff(), 4);
    misfit += field->misfit;
    degrees = field->degrees_of_freedom;
  }
  EXPECT_NEAR(sum / count, 1, 0.4);
  EXPECT_NEAR(misfit / kTrials, degrees, 4 * std::sqrt(2. * degrees / kTrials));
}

TEST(TestField, ATargetNeverTurnedDoesNotDetermineTheCamera) {
  std::vector<Camera> level;
  for (const double distance : {2., 2.5, 3.}) {
    level.push_back(View(0, 0, 0));
    level.back()[kY0] = -distance;
  }
  const auto field = CalibrateByTestField(Photographed(level, 0, 0, 0.5), kFrame, 0);
  ASSERT_FALSE(field.has_value());
  EXPECT_EQ(field.error().code, ErrorCode::kDegenerate);
}

TEST(TestField, BadInputIsSaidWithItsView) {
  const auto views = Photographed(Views(), 0, 0, 0.5);
  EXPECT_EQ(CalibrateByTestField(views, kFrame, 3).error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(CalibrateByTestField(std::span(views).first(1), kFrame, 0).error().code,
            ErrorCode::kDegenerate);
  auto bad = views;
  bad[2].dots_px.pop_back();
  EXPECT_EQ(CalibrateByTestField(bad, kFrame, 0).error().part, 2);
  bad = views;
  for (Vec2& p : bad[1].points_m) p.y() = 0;
  EXPECT_EQ(CalibrateByTestField(bad, kFrame, 0).error().part, 1);
  bad = views;
  bad[3].dots_px[0].x() = std::nan("");
  EXPECT_EQ(CalibrateByTestField(bad, kFrame, 0).error().part, 3);
}

}  // namespace
}  // namespace tranos::camera
