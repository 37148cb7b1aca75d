// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/drawing.h"

#include <gtest/gtest.h>

#include "tests/camera/scenes.h"

namespace tranos::camera {
namespace {

// A camera with everything that a camera can have, before an upright wall and a sloping roof.
Camera Skewed() {
  Camera camera;
  camera.parameters << 34, 1.02, 0.4, -0.7, 1.55, 0.15, 0.4, 0.02, 16, -24, 1.7;
  return camera;
}

const geom::Frame kFront{Vec3(1, 0, 0), Vec3::UnitX(), Vec3::UnitZ()};
const geom::Frame kRoof{Vec3(0, 0, 6), Vec3::UnitX(), Vec3(0, 0.8, 0.6)};

TEST(Drawing, GoesBackToThePointThatWasSeen) {
  const Frame frame;
  for (const geom::Frame& plane : {kFront, kRoof}) {
    for (const Vec2& p : {Vec2(0, 0), Vec2(7, 4), Vec2(-3, 1.5)}) {
      const Vec3 point_m = plane.ToWorld({p.x(), p.y(), 0});
      const auto drawn = DrawOnto(Skewed(), frame, plane, scenes::DotOf(Skewed(), frame, point_m));
      ASSERT_TRUE(drawn);
      EXPECT_LT((drawn->point_m - point_m).norm(), 1e-9);
    }
  }
}

// Where the dot is drawn when something is a little aside.
Vec3 Aside(const ParameterVector& camera_by, const Vec2& dot_by, double offset_m) {
  Camera camera = Skewed();
  camera.parameters += camera_by;
  geom::Frame plane = kRoof;
  plane.origin += offset_m * plane.z();
  return DrawOnto(camera, Frame(), plane, Vec2(1200, 500) + dot_by)->point_m;
}

TEST(Drawing, DerivativesAreThoseOfDifferences) {
  constexpr double kStep = 1e-5, kNear = 1e-6;
  const auto drawn = DrawOnto(Skewed(), Frame(), kRoof, {1200, 500});
  ASSERT_TRUE(drawn);
  for (int i = 0; i < kParameters; ++i) {
    const ParameterVector by = kStep * ParameterVector::Unit(i);
    const Vec3 slope = (Aside(by, Vec2::Zero(), 0) - Aside(-by, Vec2::Zero(), 0)) / (2 * kStep);
    EXPECT_LT((drawn->by_camera.col(i) - slope).norm(), kNear * (1 + slope.norm()))
        << kParameterNames[i];
  }
  for (int i = 0; i < 2; ++i) {
    const Vec2 by = kStep * Vec2::Unit(i);
    const Vec3 slope =
        (Aside(ParameterVector::Zero(), by, 0) - Aside(ParameterVector::Zero(), -by, 0)) /
        (2 * kStep);
    EXPECT_LT((drawn->by_dot.col(i) - slope).norm(), kNear);
  }
  const Vec3 slope = (Aside(ParameterVector::Zero(), Vec2::Zero(), kStep) -
                      Aside(ParameterVector::Zero(), Vec2::Zero(), -kStep)) /
                     (2 * kStep);
  EXPECT_LT((drawn->by_offset - slope).norm(), kNear);
}

TEST(Drawing, RefusesWhatLiesBeyondTheHorizon) {
  // The ground below an upright camera that looks levelly: above the middle there is sky.
  Camera camera;
  camera.parameters.tail<3>() = Vec3(0, 0, 1.7);
  const geom::Frame ground{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()};
  const Vec2 middle = Frame().centre_px();
  EXPECT_TRUE(DrawOnto(camera, Frame(), ground, middle + Vec2(0, 300)));
  const auto sky = DrawOnto(camera, Frame(), ground, middle - Vec2(0, 300));
  ASSERT_FALSE(sky);
  EXPECT_EQ(sky.error().code, geom::ErrorCode::kOutOfRange);
  const auto horizon = DrawOnto(camera, Frame(), ground, middle);
  ASSERT_FALSE(horizon);
  EXPECT_EQ(horizon.error().code, geom::ErrorCode::kDegenerate);
}

TEST(Drawing, RefusesAPlaneThatTheCameraStandsIn) {
  Camera camera;
  camera.parameters.tail<3>() = Vec3(0, -10, 0);
  const geom::Frame side{Vec3::Zero(), Vec3::UnitY(), Vec3::UnitZ()};
  const auto drawn = DrawOnto(camera, Frame(), side, {900, 700});
  ASSERT_FALSE(drawn);
  EXPECT_EQ(drawn.error().code, geom::ErrorCode::kDegenerate);
}

}  // namespace
}  // namespace tranos::camera
