// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/orthocentre.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/camera/comparison.h"
#include "tests/camera/cuboid.h"

namespace tranos::camera {
namespace {

using namespace benchmark;

Mat3 Square(double f, double u, double v) {
  Mat3 k;
  k << f, 0, u, 0, f, v, 0, 0, 1;
  return k;
}

std::array<Vec3, 3> VanishingPoints(const Mat3& k, double tilt, double pan) {
  Camera camera;
  camera[kOmega] = tilt, camera[kPhi] = pan, camera[kKappa] = 0.05;
  const Mat3 axes = k * CameraFromWorld(camera.parameters);
  return {axes.col(0), -axes.col(1), axes.col(2).normalized()};
}

TEST(Orthocentre, IsThePrincipalPointOfASquareCamera) {
  const Mat3 k = Square(1.8, 0.1, -0.2);
  const auto found = CalibrationFromTriangle(VanishingPoints(k, 0.3, 0.5));
  ASSERT_TRUE(found);
  EXPECT_LT((*found - k).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Orthocentre, AgreesWithTheLinearConstraintsOfASquareCamera) {
  const std::array<Vec3, 3> points = {Vec3(2, 0.1, 1), Vec3(-1.5, 0.2, 1), Vec3(0.1, -3, 1)};
  const auto found = CalibrationFromTriangle(points);
  const auto linear = CalibrationFromRows(
      std::vector<Conic>{OrthogonalRow(points[0], points[1]), OrthogonalRow(points[1], points[2]),
                         OrthogonalRow(points[0], points[2]), ZeroSkewRow(), AspectRow(1)});
  ASSERT_TRUE(found && linear);
  EXPECT_LT((*found - *linear).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Orthocentre, IsLeftOpenByAPointAtInfinityAndRefusesObtuseTriangles) {
  EXPECT_FALSE(CalibrationFromTriangle(VanishingPoints(Square(1.8, 0.1, -0.2), 0, 0.5)));
  EXPECT_FALSE(CalibrationFromTriangle(VanishingPoints(Square(1.8, 0.1, -0.2), 0, 0)));
  const auto obtuse = CalibrationFromTriangle({Vec3(0, 0, 1), Vec3(2, 0.3, 1), Vec3(-2, 0.3, 1)});
  ASSERT_FALSE(obtuse);
  EXPECT_NE(obtuse.error().detail.find("obtuse"), std::string::npos);
}

TEST(Orthocentre, FindsTheOneCameraOfTheBenchmarkThatIsSquare) {
  const Cuboid& cuboid = CuboidOf("B3");
  const TracedCuboid traced = TraceCuboid(cuboid, {});
  const auto camera = CalibrateOrthocentre(traced.photograph, traced.numbers);
  ASSERT_TRUE(camera);
  EXPECT_LT(LargestDifference(*camera, cuboid.truth), 1e-8);
}

// What a skew of one degree that is denied does to f: 1.4 and 11.6 mm.
TEST(Orthocentre, ErrsWhereThereIsSkew) {
  for (const auto& [name, error_mm] : {std::pair{"B1", -1.4}, {"B2", -11.6}}) {
    const Cuboid& cuboid = CuboidOf(name);
    const TracedCuboid traced = TraceCuboid(cuboid, {.picture = kLo});
    const auto camera = CalibrateOrthocentre(traced.photograph, traced.numbers);
    ASSERT_TRUE(camera);
    EXPECT_NEAR((*camera)[kFocal] - cuboid.truth[kFocal], error_mm, 0.05);
    EXPECT_NEAR((*camera)[kSkew], kPi / 2, 1e-12);
    EXPECT_NEAR((*camera)[kAspect], 1, 1e-12);
  }
}

TEST(Orthocentre, NeedsLinesOfAllAxes) {
  const TracedCuboid traced = TraceCuboid(CuboidOf("L3"), {});
  EXPECT_FALSE(CalibrateOrthocentre(traced.photograph, traced.numbers));
}

// Pixels that are not square: the picture squeezed in x, with a frame that says so.
TEST(Orthocentre, AspectIsThatOfTheFilmNotOfThePixels) {
  const Cuboid& cuboid = CuboidOf("B3");
  TracedCuboid traced = TraceCuboid(cuboid, {});
  traced.photograph.frame.size_px.x() = 800;
  const Frame square = FrameOf(kHi), squeezed = traced.photograph.frame;
  for (Trace& trace : traced.photograph.traces) {
    ImageLine& line = std::get<EdgeTrace>(trace).line;
    for (Vec2* dot : {&line.a_px, &line.b_px})
      *dot = squeezed.DotFromPoint(square.PointFromDot(*dot));
  }
  const auto camera = CalibrateOrthocentre(traced.photograph, traced.numbers);
  ASSERT_TRUE(camera);
  EXPECT_LT(LargestDifference(*camera, cuboid.truth), 1e-8);
}

}  // namespace
}  // namespace tranos::camera
