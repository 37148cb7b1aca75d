// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/start.h"

#include <gtest/gtest.h>

#include "tests/camera/comparison.h"
#include "tests/camera/cuboid.h"

namespace tranos::camera {
namespace {

using namespace benchmark;

// A camera before a corner of a cuboid from which three faces are seen.
Cuboid AtAngles(double tilt_deg, double pan_deg) {
  Cuboid cuboid = CuboidOf("B3");
  cuboid.offset_m = {-4, 0, -2.5};
  cuboid.truth.parameters << 35, 1, 0, 0, kPi / 2, tilt_deg * kPi / 180, pan_deg * kPi / 180, 0, 9,
      -25, 6;
  return cuboid;
}

double Nearest(const std::vector<Camera>& starts, const Camera& truth) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Camera& start : starts) nearest = std::min(nearest, LargestDifference(start, truth));
  return nearest;
}

TEST(Starts, OnExactTracesThatDetermineItTheFirstIsTheCamera) {
  for (const Cuboid& cuboid : Cuboids()) {
    if (!cuboid.determined()) continue;
    const TracedCuboid traced = TraceCuboid(cuboid, {});
    const std::vector<Camera> starts = Starts(traced.photograph, traced.numbers);
    ASSERT_FALSE(starts.empty());
    EXPECT_LT(LargestDifference(starts[0], cuboid.truth), 1e-8) << cuboid.name;
  }
}

TEST(Starts, TiltAndPanMayBeZero) {
  for (const double tilt : {0.0, -0.1, -1.0, -20.0})
    for (const double pan : {0.0, 0.1, -1.0, 20.0}) {
      const Cuboid cuboid = AtAngles(tilt, pan);
      const TracedCuboid traced = TraceCuboid(cuboid, {});
      const std::vector<Camera> starts = Starts(traced.photograph, traced.numbers);
      ASSERT_FALSE(starts.empty());
      EXPECT_LT(LargestDifference(starts[0], cuboid.truth), 1e-7) << tilt << ' ' << pan;
    }
}

// With the assumptions true, what the traces leave to them comes out right.
TEST(Starts, OfOneFacadeAloneAreTheCameraIfTheAssumptionsHold) {
  const Cuboid& cuboid = CuboidOf("L3");
  const TracedCuboid traced = TraceCuboid(cuboid, {});
  const std::vector<Camera> starts = Starts(traced.photograph, traced.numbers);
  EXPECT_LT(Nearest(starts, cuboid.truth), 1e-6);
}

TEST(Starts, TwoVanishingPointsGiveTheRotationAndTheFocalLength) {
  for (const auto& [tilt, pan] : {std::pair{-20.0, 20.0}, {-8.0, 30.0}}) {
    const Cuboid cuboid = AtAngles(tilt, pan);
    TracedCuboid traced = TraceCuboid(cuboid, {.edges = false, .directions = true});
    std::erase_if(traced.photograph.traces,
                  [](const Trace& trace) { return std::get<DirectionTrace>(trace).axis == 1; });
    const std::vector<Camera> starts = Starts(traced.photograph, traced.numbers);
    ASSERT_FALSE(starts.empty());
    EXPECT_LT(Difference(starts[0], cuboid.truth).head<8>().cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(Starts, OneVanishingPointOrASingleLineGivesAnUprightCameraAtLeast) {
  TracedCuboid traced = TraceCuboid(CuboidOf("B3"), {.edges = false, .directions = true});
  std::erase_if(traced.photograph.traces,
                [](const Trace& trace) { return std::get<DirectionTrace>(trace).axis != 2; });
  for (const size_t count : {3, 1}) {
    traced.photograph.traces.resize(count, traced.photograph.traces[0]);
    const std::vector<Camera> starts = Starts(traced.photograph, traced.numbers);
    ASSERT_FALSE(starts.empty());
    EXPECT_TRUE(starts[0].parameters.allFinite());
    EXPECT_GT(starts[0][kFocal], 0);
  }
  EXPECT_TRUE(Starts({}, {}).empty());
}

TEST(Starts, FromControlPoints) {
  const Cuboid& cuboid = CuboidOf("B3");
  for (const std::vector<int>& vertices : {std::vector<int>{0, 1, 4, 5},
                                           {0, 4, 6, 2},
                                           {1, 0, 5, 6, 7},
                                           {0, 1, 4, 6, 7},
                                           {0, 1, 2, 4, 5, 6},
                                           {0, 1, 2, 3, 4, 5, 6, 7}}) {
    const TracedCuboid traced = TracePoints(cuboid, vertices);
    const std::vector<Camera> starts = Starts(traced.photograph, traced.numbers);
    EXPECT_LT(Nearest(starts, cuboid.truth), 1e-5) << vertices.size();
  }
}

TEST(Starts, OfOneWindowHaveThePoseOfItsMirroredNormalToo) {
  Camera truth;
  truth.parameters << 35, 1, 0, 0, kPi / 2, 0.1, 0.5, 0, 15, -35, -0.4;
  Photograph photograph;
  photograph.frame = FrameOf(kHi);
  const Numbers numbers{Eigen::Vector2d(0.8, 1.2), {}};
  RectangleTrace window{};
  window.sigma_px = 0.5;
  window.a = 0, window.b = 1, window.facade = 0;
  const Vec3 corners[4] = {{0, 0, 0}, {0.8, 0, 0}, {0.8, 0, 1.2}, {0, 0, 1.2}};
  for (int i = 0; i < 4; ++i)
    window.dots_px[i] = photograph.frame.DotFromPoint(Project(truth, corners[i]).point_mm);
  photograph.traces.push_back(window);
  const std::vector<Camera> starts = Starts(photograph, numbers);
  EXPECT_LT(Nearest(starts, truth), 1e-5);
  const auto turned = [&](const Camera& camera) {
    return (CameraFromWorld(camera.parameters) - CameraFromWorld(truth.parameters)).norm();
  };
  EXPECT_TRUE(std::any_of(starts.begin(), starts.end(),
                          [&](const Camera& camera) { return turned(camera) > 0.5; }));
}

TEST(Starts, PriorsStandForTheAssumptions) {
  Cuboid cuboid = CuboidOf("L3");
  cuboid.truth[kPrincipalX] = 2.5, cuboid.truth[kPrincipalY] = -3;
  cuboid.truth[kAspect] = 1.05, cuboid.truth[kSkew] = 89 * kPi / 180;
  TracedCuboid traced = TraceCuboid(cuboid, {});
  for (const Parameter p : {kPrincipalX, kPrincipalY, kAspect, kSkew})
    traced.photograph.priors[p] = {cuboid.truth[p], 0.01};
  const std::vector<Camera> starts = Starts(traced.photograph, traced.numbers);
  EXPECT_LT(Nearest(starts, cuboid.truth), 1e-6);
}

// Far outside of the noise, so that nothing linear is near by luck.
TEST(Starts, UnderNoiseThereIsOneNearTheCamera) {
  for (const char* name : {"B1", "B2", "B3", "B4"}) {
    const Cuboid& cuboid = CuboidOf(name);
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const TracedCuboid traced =
          TraceCuboid(cuboid, {.sigma_px = 1, .seed = seed, .dimension_sigma = 0.005});
      const std::vector<Camera> starts = Starts(traced.photograph, traced.numbers);
      ASSERT_FALSE(starts.empty());
      EXPECT_LT(Nearest(starts, cuboid.truth), 6) << name << seed;
    }
  }
}

}  // namespace
}  // namespace tranos::camera
