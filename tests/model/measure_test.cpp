// SPDX-License-Identifier: GPL-3.0-or-later
// Measures through groups and instances, against closed forms.
#include <gtest/gtest.h>

#include "tests/model/shapes.h"

namespace tranos::model {
namespace {

using geom::kPi;
using geom::Vec3;

ElementPtr MakeSurface(geom::Surface surface) {
  return MakeElement(kNoElement, std::make_shared<const geom::Surface>(std::move(surface)),
                     PlainAttributes(), nullptr, {1e-4, 0});
}

geom::Affine Linear(const Eigen::Matrix3d& linear, const Vec3& translation = Vec3::Zero()) {
  geom::Affine affine = Translation(translation.x(), translation.y(), translation.z());
  affine.linear() = linear;
  return affine;
}

const Eigen::Matrix3d kTurnedAndDoubled =
    2 * Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
const Eigen::Matrix3d kStretched = Vec3(2, 1, 1).asDiagonal();

TEST(Measure, ElementsHaveOnlyTheirOwnKind) {
  const ElementPtr point = MakePoint(1);
  EXPECT_EQ(Length(*point), std::nullopt);
  EXPECT_EQ(Area(*point), std::nullopt);
  const ElementPtr line = MakeCurve(geom::Line{{0, 0, 0}, {3, 4, 0}});
  EXPECT_NEAR(*Length(*line), 5, 1e-12);
  EXPECT_EQ(Area(*line), std::nullopt);
  const ElementPtr circle = MakeCurve(geom::Circle{{}, 2});
  EXPECT_NEAR(*Length(*circle), 4 * kPi, 1e-9);
  EXPECT_NEAR(*Area(*circle), 4 * kPi, 1e-9);
  const ElementPtr wall =
      MakeSurface(*geom::Extrusion(geom::Line{{0, 0, 0}, {3, 4, 0}}, {0, 0, 2}));
  EXPECT_EQ(Length(*wall), std::nullopt);
  EXPECT_NEAR(*Area(*wall), 10, 1e-9);
  EXPECT_EQ(Volume(*wall), std::nullopt);
}

TEST(Measure, GroupsSumTheirMembers) {
  const ElementPtr group = MakeGroupOf(
      {MakeCurve(geom::Circle{{}, 1}), MakePoint(5), MakeCurve(geom::Line{{0, 0, 0}, {0, 0, 7}})});
  EXPECT_NEAR(*Length(*group), 2 * kPi + 7, 1e-9);
  EXPECT_NEAR(*Area(*group), kPi, 1e-9);
  const geom::Box box = BoundingBox(*group);
  EXPECT_LT((box.max - Vec3(5, 1, 7)).norm(), 1e-9);
  EXPECT_LT((box.min - Vec3(-1, -1, 0)).norm(), 1e-9);
}

TEST(Measure, SimilarityScalesTheMeasures) {
  const ElementPtr placed =
      MakeInstance({MakeCurve(geom::Circle{{}, 1})}, Linear(kTurnedAndDoubled, {10, 0, 0}));
  EXPECT_NEAR(*Length(*placed), 4 * kPi, 1e-9);
  EXPECT_NEAR(*Area(*placed), 4 * kPi, 1e-9);
  // The box of a disc with the unit normal n reaches r√(1 − nᵢ²) along axis i.
  const Vec3 normal = kTurnedAndDoubled.col(2) / 2;
  const geom::Box box = BoundingBox(*placed);
  for (int i = 0; i < 3; ++i) {
    const double reach = 2 * std::sqrt(1 - normal[i] * normal[i]);
    EXPECT_NEAR(box.max[i] - box.min[i], 2 * reach, 1e-8);
  }
}

TEST(Measure, StretchIsNoSimilarity) {
  const ElementPtr ellipse = MakeInstance({MakeCurve(geom::Circle{{}, 1})}, Linear(kStretched));
  EXPECT_NEAR(*Area(*ellipse), 2 * kPi, 1e-8);
  EXPECT_NEAR(*Length(*ellipse), 9.688448220547675, 1e-8);  // 4·a·E(√(1 − b²/a²)), a=2, b=1
  EXPECT_NEAR(BoundingBox(*ellipse).max.x(), 2, 1e-12);
}

TEST(Measure, NearestPointGoesThroughTheTransform) {
  for (const Eigen::Matrix3d& linear : {kTurnedAndDoubled, kStretched}) {
    const geom::Affine world = Linear(linear, {1, 2, 3});
    const geom::Line line{{0, 0, 0}, {1, 0, 0}};
    const ElementPtr placed = MakeInstance({MakePoint(50), MakeCurve(line)}, world);
    const Vec3 on_line = world * Vec3(0.25, 0, 0);
    const Vec3 along = linear.col(0).normalized();
    const Vec3 p = on_line + 0.5 * along.unitOrthogonal();
    const geom::Nearest nearest = NearestPoint(*placed, p);
    EXPECT_LT((nearest.point - on_line).norm(), 1e-12);
    EXPECT_NEAR(nearest.distance_m, 0.5, 1e-12);
  }
}

TEST(Measure, ClosedSurfacesHaveTheVolumeOfTheirFacets) {
  geom::Frame upright;
  upright.origin = {3, 0, 0};
  upright.y = Vec3::UnitZ();
  const ElementPtr torus = MakeSurface(
      *geom::Revolution(geom::Circle{upright, 1}, Vec3::Zero(), Vec3::UnitZ(), 2 * kPi));
  ASSERT_TRUE(Volume(*torus).has_value());
  EXPECT_NEAR(*Volume(*torus), 6 * kPi * kPi, 0.01);
  const ElementPtr placed = MakeInstance({torus}, Linear(kStretched));
  EXPECT_NEAR(*Volume(*placed), 2 * *Volume(*torus), 1e-9);
}

TEST(Measure, TextIsAsNearAsItsStrokes) {
  const ElementPtr text =
      MakeElement(kNoElement, std::make_shared<const geom::Text>(geom::Text{"I", {}, 2}),
                  PlainAttributes(), nullptr, {});
  const geom::Box box = BoundingBox(*text);
  const Vec3 above = {box.centre().x(), box.max.y() + 1, 0};
  EXPECT_NEAR(NearestPoint(*text, above).distance_m, 1, 1e-6);
}

}  // namespace
}  // namespace tranos::model
