// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/camera.h"

#include <gtest/gtest.h>

namespace tranos::camera {
namespace {

Camera Benchmark1() {
  Camera camera;
  const double d = kPi / 180;
  camera.parameters << 17.1, 1, 0, 0, 89 * d, -20 * d, 15 * d, 0, 12, -23, 7;
  return camera;
}

TEST(Camera, WithoutAnglesLooksAlongYWithZUp) {
  Camera camera;
  EXPECT_TRUE(CameraFromWorld(camera.parameters) * Vec3::UnitX() == Vec3(1, 0, 0));
  EXPECT_TRUE(CameraFromWorld(camera.parameters) * Vec3::UnitY() == Vec3(0, 0, 1));
  EXPECT_TRUE(CameraFromWorld(camera.parameters) * Vec3::UnitZ() == Vec3(0, -1, 0));
}

TEST(Camera, PositiveTiltLooksUpAndPositivePanLeft) {
  Camera camera;
  camera[kOmega] = 0.3;
  camera[kPhi] = 0.4;
  const Vec3 axis = CameraFromWorld(camera.parameters).transpose() * Vec3::UnitZ();
  const Vec3 expected(-std::sin(0.4) * std::cos(0.3), std::cos(0.4) * std::cos(0.3), std::sin(0.3));
  EXPECT_LT((axis - expected).norm(), 1e-15);
}

TEST(Camera, SkewedCameraOfTheBenchmarkGivesItsGoldenPixel) {
  const Vec2 mm = Project(Benchmark1(), {-4, -14, -2.5}).point_mm;
  EXPECT_LT((mm / 0.0225 - Vec2(-647.6414511123365, 225.24778234938913)).norm(), 1e-9);
}

TEST(Camera, IsFoundAgainFromItsMatrices) {
  Camera camera = Benchmark1();
  camera[kKappa] = 2.5;
  const Camera again = CameraOf(FrameFromCamera(camera.parameters),
                                CameraFromWorld(camera.parameters), camera.position_m());
  EXPECT_LT((again.parameters - camera.parameters).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Camera, IsFoundAgainWhereItLooksStraightUpOrDown) {
  for (const double omega : {kPi / 2, -kPi / 2, kPi / 2 - 1e-9}) {
    Camera camera = Benchmark1();
    camera[kOmega] = omega;
    camera[kKappa] = 2.5;
    const Mat3 rotation = CameraFromWorld(camera.parameters);
    const Camera again = CameraOf(FrameFromCamera(camera.parameters), rotation, Vec3::Zero());
    EXPECT_LT((CameraFromWorld(again.parameters) - rotation).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(Frame, TheMiddleOfThePictureIsTheOriginInMillimetres) {
  const Frame frame{{40.5, 26.7}, {484, 319}};
  EXPECT_LT(frame.PointFromDot({241.5, 159}).norm(), 1e-12);
  EXPECT_LT((frame.PointFromDot({-0.5, -0.5}) - Vec2(-20.25, -13.35)).norm(), 1e-12);
  EXPECT_LT((frame.DotFromPoint(frame.PointFromDot({12, 34})) - Vec2(12, 34)).norm(), 1e-12);
  const Vec3 dot = frame.DotFromFrame() * Vec3(1, 2, 1);
  EXPECT_LT((dot.hnormalized() - frame.DotFromPoint({1, 2})).norm(), 1e-12);
}

}  // namespace
}  // namespace tranos::camera
