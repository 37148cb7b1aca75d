// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/vanishing_directions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace tranos::camera {
namespace {

constexpr double kDegree = kPi / 180;
const Frame kFrame{{36, 27}, {640, 480}};

// A camera that looks at the corner of a building, 38 mm, turned and tilted.
Camera CornerView() {
  Camera camera;
  camera[kFocal] = 38;
  camera[kPhi] = 35 * kDegree, camera[kOmega] = 9 * kDegree, camera[kKappa] = 2 * kDegree;
  return camera;
}

struct Scene {
  std::vector<ImageLine> lines;
  std::vector<int> axis;
};

// So many edges of each axis and others of any angle, 20 to 120 px long, each seen to so many px
// and not quite parallel.
Scene SceneOf(const Camera& camera, const std::array<int, 3>& counts, int others,
              std::uint64_t seed, double sigma_px = 0.1, double parallel_rad = 0.2 * kDegree) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  const Mat3 points = kFrame.DotFromFrame() * FrameFromCamera(camera.parameters) *
                      CameraFromWorld(camera.parameters);
  Scene scene;
  const auto add = [&](const Vec2& centre, double angle, int axis) {
    const double length = 20 + 100 * uniform(random);
    const double tilt_sigma = sigma_px * std::sqrt(12 / length);
    angle += parallel_rad * normal(random) + tilt_sigma / length * normal(random);
    const Vec2 half = 0.5 * length * Vec2(std::cos(angle), std::sin(angle));
    scene.lines.push_back({centre - half, centre + half, sigma_px / std::sqrt(length), tilt_sigma});
    scene.axis.push_back(axis);
  };
  const auto place = [&] { return Vec2(640 * uniform(random), 480 * uniform(random)); };
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < counts[k]; ++i) {
      const Vec2 centre = place();
      const Vec2 to = points.col(k).head<2>() - points(2, k) * centre;
      add(centre, std::atan2(to.y(), to.x()), k);
    }
  }
  for (int i = 0; i < others; ++i) add(place(), kPi * uniform(random), kNoAxis);
  return scene;
}

// Degrees: the largest of the three.
double DirectionError(const Camera& found, const Camera& truth) {
  const Mat3 cosines =
      CameraFromWorld(found.parameters).transpose() * CameraFromWorld(truth.parameters);
  double worst = 0;
  for (int k = 0; k < 3; ++k)
    worst = std::max(worst, std::acos(std::min(1.0, std::abs(cosines(k, k)))) / kDegree);
  return worst;
}

TEST(VanishingDirections, AreFoundAmongAsManyLinesOfNone) {
  const Camera camera = CornerView();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scene scene = SceneOf(camera, {30, 25, 30}, 80, seed);
    const auto found = FindVanishingDirections(scene.lines, kFrame);
    ASSERT_TRUE(found) << seed;
    EXPECT_EQ(found->directions(), 3);
    EXPECT_LT(DirectionError(found->camera, camera), 0.6) << seed;
    EXPECT_NEAR(found->camera[kFocal] / camera[kFocal], 1, 0.05) << seed;
    int wrong = 0, missed = 0;
    for (std::size_t i = 0; i < scene.axis.size(); ++i) {
      if (scene.axis[i] == kNoAxis) continue;
      missed += found->axis[i] == kNoAxis;
      wrong += found->axis[i] != kNoAxis && found->axis[i] != scene.axis[i];
    }
    EXPECT_LE(wrong, 3) << seed;  // lines that point at two vanishing points at once
    EXPECT_LE(missed, 3) << seed;
  }
}

// Of an upright direction and one other, the focal length hangs on how high the principal point is,
// which is only assumed.
TEST(VanishingDirections, GiveTheThirdWhereOnlyTwoAreSeen) {
  const Camera camera = CornerView();
  for (const std::array<int, 3> counts : {std::array{0, 30, 30}, {30, 0, 30}, {30, 30, 0}}) {
    const Scene scene = SceneOf(camera, counts, 20, 3);
    const auto found = FindVanishingDirections(scene.lines, kFrame);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->directions(), 2);
    EXPECT_LT(DirectionError(found->camera, camera), counts[2] == 0 ? 1.5 : 8);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(found->is_seen[k], counts[k] > 0) << k;
    for (std::size_t i = 0; i < found->axis.size(); ++i) {
      if (found->axis[i] == kNoAxis) continue;
      EXPECT_GT(counts[found->axis[i]], 0);
    }
  }
}

// A wide lens near the building, a long one far away, and a facade from the front, whose vanishing
// points are far off and tell nothing of the focal length.
TEST(VanishingDirections, NeedNoGuessOfTheFocalLength) {
  for (const double focal_mm : {18.0, 28.0, 60.0, 120.0}) {
    Camera camera = CornerView();
    camera[kFocal] = focal_mm;
    const Scene scene = SceneOf(camera, {40, 40, 40}, 30, 5);
    const auto found = FindVanishingDirections(scene.lines, kFrame);
    ASSERT_TRUE(found) << focal_mm;
    EXPECT_LT(DirectionError(found->camera, camera), 1.5) << focal_mm;
  }
  Camera frontal = CornerView();
  frontal[kPhi] = frontal[kOmega] = 0;
  const Scene scene = SceneOf(frontal, {40, 0, 40}, 20, 5);
  const auto found = FindVanishingDirections(scene.lines, kFrame);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->is_seen[0] && found->is_seen[2]);
}

TEST(VanishingDirections, AreTheSameForTheSameSeedAndAlikeForAnother) {
  const Scene scene = SceneOf(CornerView(), {30, 25, 30}, 60, 4);
  const auto first = FindVanishingDirections(scene.lines, kFrame);
  const auto again = FindVanishingDirections(scene.lines, kFrame);
  const auto other = FindVanishingDirections(scene.lines, kFrame, {.seed = 2});
  ASSERT_TRUE(first && again && other);
  EXPECT_EQ(first->camera.parameters, again->camera.parameters);
  EXPECT_EQ(first->axis, again->axis);
  EXPECT_LT(DirectionError(first->camera, other->camera), 0.05);
}

TEST(VanishingDirections, AreRefusedWhereThereAreNotTwo) {
  const Camera camera = CornerView();
  const auto refused = [](const Scene& scene) {
    const auto found = FindVanishingDirections(scene.lines, kFrame);
    return !found && found.error().code == geom::ErrorCode::kDegenerate;
  };
  EXPECT_TRUE(refused({}));
  EXPECT_TRUE(refused(SceneOf(camera, {1, 1, 1}, 0, 1)));
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_TRUE(refused(SceneOf(camera, {0, 0, 0}, 60, seed))) << seed;
    EXPECT_TRUE(refused(SceneOf(camera, {0, 0, 40}, 30, seed))) << seed;
  }
}

TEST(VanishingDirections, NameTheUprightZAndTheWidestX) {
  const Scene scene = SceneOf(CornerView(), {30, 30, 30}, 0, 2);
  const auto found = FindVanishingDirections(scene.lines, kFrame);
  ASSERT_TRUE(found);
  const Mat3 r = CameraFromWorld(found->camera.parameters);
  EXPECT_LT(r(1, 2), -0.9);                         // up
  EXPECT_GT(r(0, 0), 0);                            // to the right
  EXPECT_LT(std::abs(r(2, 0)), std::abs(r(2, 1)));  // across the line of sight
  EXPECT_GT(r(2, 1), 0);                            // into the scene
  EXPECT_NEAR(r.determinant(), 1, 1e-12);
}

TEST(AsParallel, IsAsSureAsSoManyPixels) {
  const ImageLine line = FitImageLine({{10, 20}, {110, 25}}, 0.5, 64).value();
  EXPECT_EQ(SamplesOf(line, 0.5), 64);
  const ImageLine wider = AsParallel(line, 0.01);
  EXPECT_NEAR(wider.tilt_sigma_px, std::hypot(line.tilt_sigma_px, 0.01 * line.length_px()), 1e-12);
  EXPECT_EQ(SamplesOf(AsParallel(line, 1), 0.5), 2);
}

}  // namespace
}  // namespace tranos::camera
