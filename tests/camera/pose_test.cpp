// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/pose.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace tranos::camera {
namespace {

const Frame kFrame{{36, 24}, {3600, 2400}};

// A facade's window as points (X, Z), and where a camera sees it.
struct Window {
  std::vector<Vec2> points, dots;
  Mat3 h;
};
Window Look(const ConditionedCamera& camera, double width, double height) {
  Window window;
  const Mat3 m = camera.inverse_calibration.inverse() * camera.camera_from_world;
  window.h << m.col(0), m.col(2), -m * camera.position_m;
  for (const Vec2& point : {Vec2(0, 0), Vec2(width, 0), Vec2(width, height), Vec2(0, height)}) {
    window.points.push_back(point);
    window.dots.push_back((window.h * point.homogeneous()).hnormalized());
  }
  return window;
}

ConditionedCamera Oblique(double distance) {
  Camera camera;
  camera[kSkew] = 89 * kPi / 180;
  camera[kOmega] = 0.2;
  camera[kPhi] = 0.4;
  ConditionedCamera result = ConditionedCameraOf(camera, kFrame);
  result.position_m = result.camera_from_world.transpose() * Vec3(0, 0, -distance);
  return result;
}

TEST(Pose, NearestRotationIsOneAndKeepsRotations) {
  const Mat3 r = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  EXPECT_LT((NearestRotation(2 * r) - r).norm(), 1e-14);
  Mat3 off = r;
  off(0, 1) += 0.01, off(2, 2) -= 0.02;
  const Mat3 nearest = NearestRotation(off);
  EXPECT_LT((nearest * nearest.transpose() - Mat3::Identity()).norm(), 1e-14);
  // The nearest one: turning it a little in any way takes it farther off.
  for (int axis = 0; axis < 3; ++axis)
    for (const double angle : {-1e-3, 1e-3}) {
      const Mat3 turned = Eigen::AngleAxisd(angle, Vec3::Unit(axis)).toRotationMatrix() * nearest;
      EXPECT_GT((turned - off).norm(), (nearest - off).norm());
    }
  EXPECT_NEAR(NearestRotation(-r).determinant(), 1, 1e-14);
}

TEST(Pose, OfMinusHPutsTheFacadeBehindTheCameraWithTheSamePicture) {
  const ConditionedCamera camera = Oblique(12);
  const Window window = Look(camera, 2, 3);
  for (const double sign : {1.0, -5.0}) {
    const auto poses = PosesFromHomography(camera.inverse_calibration, sign * window.h,
                                           window.points, window.dots, 1800);
    ASSERT_TRUE(poses);
    const PoseCandidate &front = poses->front(), &behind = poses->back();
    EXPECT_TRUE(front.in_front);
    EXPECT_FALSE(behind.in_front);
    EXPECT_LT((front.camera.camera_from_world - camera.camera_from_world).norm(), 1e-12);
    EXPECT_LT((front.camera.position_m - camera.position_m).norm(), 1e-11);
    EXPECT_LT(behind.rms_px, 1e-8);
    // (−r_X, −r_Z, normal, −t)
    const Mat3 product = behind.camera.camera_from_world * camera.camera_from_world.transpose();
    const Vec3 normal = camera.camera_from_world.col(1);
    EXPECT_LT((product - (2 * normal * normal.transpose() - Mat3::Identity())).norm(), 1e-11);
    EXPECT_LT((behind.camera.position_m - camera.position_m.cwiseProduct(Vec3(1, -1, 1))).norm(),
              1e-10);
  }
}

TEST(Pose, ASmallWindowIsAmbiguousAndALargeOneIsNot) {
  const auto flipped = [](double distance) {
    const ConditionedCamera camera = Oblique(distance);
    const Window window = Look(camera, 2, 3);
    const auto poses =
        PosesFromHomography(camera.inverse_calibration, window.h, window.points, window.dots, 1800);
    for (const PoseCandidate& pose : *poses)
      if (pose.kind == PoseKind::kFlipped) {
        // Another pose altogether, whose error is a local minimum.
        EXPECT_GT((pose.camera.camera_from_world - camera.camera_from_world).norm(), 0.3);
        return pose.rms_px;
      }
    return -1.0;
  };
  EXPECT_GT(flipped(200), 0);
  EXPECT_LT(flipped(200), 0.5);
  EXPECT_GT(flipped(10), 10);
}

TEST(Pose, IsFoundFromVanishingPointsOfAnySign) {
  const ConditionedCamera camera = Oblique(15);
  const Mat3 axes = camera.inverse_calibration.inverse() * camera.camera_from_world;
  SpaceTraces traces;
  for (const Vec3& point : {Vec3(0, 0, 0), Vec3(2, 0, 1), Vec3(0.5, 1, 3), Vec3(-1, 0.3, 0.2)})
    traces.points.push_back({(axes * (point - camera.position_m)).hnormalized(), point, 1000});
  for (int signs = 0; signs < 8; ++signs)
    for (int missing = 0; missing < 4; ++missing) {
      AxisPoints points;
      for (int i = 0; i < 3; ++i)
        if (i != missing)
          points[static_cast<size_t>(i)] = axes.col(i).normalized() * (signs >> i & 1 ? -1 : 1);
      const auto found = PoseFromDirections(camera.inverse_calibration, points, traces);
      ASSERT_TRUE(found);
      EXPECT_LT((found->camera_from_world - camera.camera_from_world).norm(), 1e-12);
      EXPECT_LT((found->position_m - camera.position_m).norm(), 1e-10);
    }
  EXPECT_FALSE(PoseFromDirections(camera.inverse_calibration, {axes.col(0)}, traces));
  traces.points.resize(1);
  EXPECT_FALSE(PositionFromTraces(traces, camera.inverse_calibration, camera.camera_from_world));
}

TEST(Pose, WithoutAnythingInSpaceHasTheWorldUpright) {
  const ConditionedCamera camera = Oblique(15);
  const Mat3 axes = camera.inverse_calibration.inverse() * camera.camera_from_world;
  const auto found =
      PoseFromDirections(camera.inverse_calibration, {-axes.col(0), axes.col(1), -axes.col(2)}, {});
  ASSERT_TRUE(found);
  EXPECT_LT((found->camera_from_world - camera.camera_from_world).norm(), 1e-12);
}

TEST(Pose, IsRefinedToTheExactOneWithTheFocalLength) {
  const ConditionedCamera camera = Oblique(15);
  const Mat3 m = camera.inverse_calibration.inverse() * camera.camera_from_world;
  SpaceTraces traces;
  for (int i = 0; i < 8; ++i) {
    const Vec3 point(3 * (i & 1), 4 * (i >> 1 & 1), 2 * (i >> 2));
    traces.points.push_back({(m * (point - camera.position_m)).hnormalized(), point, 1800});
  }
  ConditionedCamera start = camera;
  start.camera_from_world = Eigen::AngleAxisd(0.2, Vec3(1, -1, 2).normalized()).toRotationMatrix() *
                            camera.camera_from_world;
  start.position_m += Vec3(1, -2, 0.5);
  start.inverse_calibration.topRows<2>() *= 1.3;
  const ConditionedCamera refined = RefinePose(traces, start, true);
  EXPECT_LT((refined.camera_from_world - camera.camera_from_world).norm(), 1e-8);
  EXPECT_LT((refined.position_m - camera.position_m).norm(), 1e-7);
  EXPECT_LT((refined.inverse_calibration - camera.inverse_calibration).norm(), 1e-8);
}

}  // namespace
}  // namespace tranos::camera
