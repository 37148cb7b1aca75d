// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/facade_view.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tranos::camera {
namespace {

Camera Straight(double distance_m) {
  Camera camera;
  camera.parameters << 36, 1, 0, 0, kPi / 2, 0, 0, 0, 0, -distance_m, 0;
  return camera;
}
const Frame kFrame{{36, 24}, {3600, 2400}};
const geom::Frame kFacade{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitZ()};

TEST(FacadeView, PutsAPlaceWhereTheCameraProjectsThePoint) {
  Camera camera;
  camera.parameters << 33, 1.03, 0.4, -0.3, 1.55, 0.1, 0.4, 0.02, 12, -14, 2;
  const geom::Frame plane{{1, 2, 3}, Vec3(1, 1, 0).normalized(), Vec3::UnitZ()};
  const Vec2 place(2.5, 1.25);
  const Image image = Project(camera, plane.ToWorld({place.x(), place.y(), 0}));
  const Vec3 dot = DotFromPlane(camera, kFrame, plane) * place.homogeneous();
  EXPECT_NEAR(dot.z(), image.depth_m, 1e-12);
  EXPECT_NEAR((dot.hnormalized() - kFrame.DotFromPoint(image.point_mm)).norm(), 0, 1e-9);
}

TEST(FacadeView, GroundSamplingIsDistanceByFocalLength) {
  // 10 m away a pixel of 0.01 mm at f = 36 mm covers 10 m · 0.01 / 36.
  const Mat3 dot_from_plane = DotFromPlane(Straight(10), kFrame, kFacade);
  for (const Vec2& place : {Vec2(0, 0), Vec2(3, -2)}) {
    EXPECT_NEAR(GroundSampling_m(dot_from_plane, place), 10 * 0.01 / 36, 1e-12);
  }
}

TEST(FacadeView, GroundSamplingGrowsByTheSquareOfDistanceOnWhatIsSeenAslant) {
  // Of a floor, h below the camera, a pixel at distance d covers d²/(h f) of its pitch.
  const geom::Frame floor{{0, 0, -2}, Vec3::UnitX(), Vec3::UnitY()};
  const Mat3 dot_from_plane = DotFromPlane(Straight(0), kFrame, floor);
  for (const double d : {5.0, 20.0}) {
    EXPECT_NEAR(GroundSampling_m(dot_from_plane, {0, d}), d * d / 2 * 0.01 / 36, 1e-9);
  }
  EXPECT_TRUE(std::isinf(GroundSampling_m(dot_from_plane, {0, -5})));  // behind the camera
}

}  // namespace
}  // namespace tranos::camera
