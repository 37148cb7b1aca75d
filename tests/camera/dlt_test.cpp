// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/dlt.h"

#include <gtest/gtest.h>

#include "tests/camera/comparison.h"
#include "tests/camera/cuboid.h"

namespace tranos::camera {
namespace {

using namespace benchmark;

TEST(Dlt, ExactPointsOrEdgesGiveAllElevenParametersAndTheGoldenPixels) {
  for (const Cuboid& cuboid : Cuboids()) {
    std::vector<TracedCuboid> all = {TracePoints(cuboid, {0, 1, 4, 5, 6, 7, 2})};
    if (cuboid.determined()) all.push_back(TraceCuboid(cuboid, {}));
    for (const TracedCuboid& traced : all) {
      const auto camera = CalibrateDlt(traced.photograph, traced.numbers);
      ASSERT_TRUE(camera) << cuboid.name;
      EXPECT_LT(LargestDifference(*camera, cuboid.truth), 1e-8) << cuboid.name;
      for (int index = 0; index < 8; ++index) {
        const Vec3 vertex = Vertex(index, cuboid.dimensions_m, cuboid.offset_m);
        const Vec2 pixel = Project(*camera, vertex).point_mm / FrameOf(kHi).pitch_mm().x();
        EXPECT_LT((pixel - cuboid.golden[static_cast<size_t>(index)]).norm(), 1e-9);
      }
    }
  }
}

TEST(Dlt, PointsOfAPlaneOrTooFewLeaveItOpen) {
  const Cuboid& cuboid = CuboidOf("B1");
  const TracedCuboid few = TracePoints(cuboid, {0, 1, 4, 5, 6});
  EXPECT_FALSE(CalibrateDlt(few.photograph, few.numbers));
  const TracedCuboid facade = TraceCuboid(CuboidOf("L3"), {});
  EXPECT_FALSE(CalibrateDlt(facade.photograph, facade.numbers));
  TracedCuboid plane = TracePoints(cuboid, {0, 1, 2, 3, 0, 1, 2, 3});
  const auto camera = CalibrateDlt(plane.photograph, plane.numbers);
  ASSERT_FALSE(camera);
  EXPECT_NE(camera.error().detail.find("plane"), std::string::npos);
}

TEST(Dlt, AMirroredPictureIsAnError) {
  TracedCuboid traced = TracePoints(CuboidOf("B1"), {0, 1, 2, 4, 5, 6, 7});
  for (Trace& trace : traced.photograph.traces) {
    Vec2& dot = std::get<PointTrace>(trace).dot_px;
    dot.x() = 1599 - dot.x();
  }
  EXPECT_FALSE(CalibrateDlt(traced.photograph, traced.numbers));
}

TEST(Dlt, DecomposesAnyMultipleOfAProjection) {
  const Cuboid& cuboid = CuboidOf("B4");
  const Frame frame = FrameOf(kHi);
  const Mat3 to_conditioned = FrameFromConditioned(frame).inverse();
  const ProjectionMatrix p = to_conditioned * FrameFromWorld(cuboid.truth);
  for (const double scale : {1.0, -7.0, 1e-4}) {
    const auto camera = DecomposeProjection(scale * p);
    ASSERT_TRUE(camera);
    EXPECT_LT(LargestDifference(CameraOf(*camera, frame), cuboid.truth), 1e-10);
  }
  ProjectionMatrix flat = p;
  flat.row(0) = flat.row(2);
  EXPECT_FALSE(DecomposeProjection(flat));
}

// Edges weighted by their depths are close to the bound, so the weights are those of the noise.
TEST(Dlt, OfEdgesIsNearTheBound) {
  for (const char* name : {"B1", "B2", "B3", "B4"}) {
    const Cuboid& cuboid = CuboidOf(name);
    ParameterVector squares = ParameterVector::Zero();
    const int trials = 400;
    for (int seed = 0; seed < trials; ++seed) {
      const TracedCuboid traced =
          TraceCuboid(cuboid, {.sigma_px = 0.5, .seed = static_cast<std::uint64_t>(seed)});
      const auto camera = CalibrateDlt(traced.photograph, traced.numbers);
      ASSERT_TRUE(camera);
      squares += (camera->parameters - cuboid.truth.parameters).cwiseAbs2();
    }
    const ParameterVector rmse = (squares / trials).cwiseSqrt();
    const ParameterVector ratio = rmse.cwiseQuotient(0.5 * cuboid.bound[kHi]);
    EXPECT_LT(ratio.maxCoeff(), 1.15) << name;
    EXPECT_GT(ratio.minCoeff(), 0.85) << name;
  }
}

}  // namespace
}  // namespace tranos::camera
