// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/virtual_camera.h"

#include <gtest/gtest.h>

namespace tranos::camera {
namespace {

using geom::ErrorCode;

// 10 mm of focal length at 0.01 mm a dot: 1000 dots for each metre at a depth of 1 m.
const Frame kFrame{{36, 24}, {3600, 2400}};

Camera Simple() {
  Camera camera;
  camera[kFocal] = 10;
  return camera;
}

Camera Skewed() {
  Camera camera;
  camera.parameters << 17.1, 1.02, 0.3, -0.2, 1.53, -0.3, 0.4, 0.05, 12, -23, 7;
  return camera;
}

ImageLine LineBetween(const Vec2& a, const Vec2& b, double centre_sigma, double tilt_sigma) {
  return {a, b, centre_sigma, tilt_sigma};
}

Vec2 Dot(const Camera& camera, const Vec3& point) {
  return kFrame.DotFromPoint(Project(camera, point).point_mm);
}

// Edges of a box before the skewed camera, traced without error.
std::vector<TracedEdge> Box(const Camera& camera) {
  const Vec3 corner(-4, -14, -2.5), size(10, 14, 6);
  std::vector<TracedEdge> edges;
  for (int axis = 0; axis < 3; ++axis) {
    for (int which = 0; which < 4; ++which) {
      Vec3 from = corner;
      if (which & 1) from[(axis + 1) % 3] += size[(axis + 1) % 3];
      if (which & 2) from[(axis + 2) % 3] += size[(axis + 2) % 3];
      Vec3 to = from;
      to[axis] += size[axis];
      edges.push_back({LineBetween(Dot(camera, from), Dot(camera, to), 0.1, 0.3), from, to});
    }
  }
  return edges;
}

TEST(Virtual, AnEdgeBeforeTheCameraIsItsEndsProjected) {
  const std::vector<Vec3> edge{{-4, -14, -2.5}, {6, -14, -2.5}, {6, 0, -2.5}};
  const auto parts = ProjectPolyline(Skewed(), kFrame, edge);
  ASSERT_EQ(parts.size(), 1u);
  ASSERT_EQ(parts[0].size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_LT((parts[0][i] - Dot(Skewed(), edge[i])).norm(), 1e-9);
}

TEST(Virtual, AnEdgeThroughTheNearPlaneEndsOnIt) {
  // From depth −1 m to 3 m at x = 1: at depth 0.5 m it is 2 / m · 1000 dots right of the centre.
  const std::vector<Vec3> edge{{1, -1, 0}, {1, 3, 0}};
  const auto parts = ProjectPolyline(Simple(), kFrame, edge, 0.5);
  ASSERT_EQ(parts.size(), 1u);
  ASSERT_EQ(parts[0].size(), 2u);
  EXPECT_LT((parts[0][0] - (kFrame.centre_px() + Vec2(2000, 0))).norm(), 1e-9);
  EXPECT_LT((parts[0][1] - (kFrame.centre_px() + Vec2(1000. / 3, 0))).norm(), 1e-9);
}

TEST(Virtual, APolylineThatGoesBehindAndComesBackIsTwoParts) {
  const std::vector<Vec3> line{{0, 2, 0}, {1, -2, 0}, {3, -2, 0}, {4, 2, 0}};
  const auto parts = ProjectPolyline(Simple(), kFrame, line, 1);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_LT((parts[0][1] - (kFrame.centre_px() + Vec2(250, 0))).norm(), 1e-9);
  EXPECT_LT((parts[1][0] - (kFrame.centre_px() + Vec2(3750, 0))).norm(), 1e-9);
  EXPECT_TRUE(ProjectPolyline(Simple(), kFrame, std::vector<Vec3>{{0, -1, 0}, {1, -1, 0}}).empty());
}

TEST(Virtual, WhatIsClippedStaysOnTheLineOfTheWhole) {
  const std::vector<Vec3> edge{{12.5, -30, 6}, {6, 0, -2.5}};
  const auto parts = ProjectPolyline(Skewed(), kFrame, edge, 0.2);
  ASSERT_EQ(parts.size(), 1u);
  const Vec2 middle = Dot(Skewed(), 0.2 * edge[0] + 0.8 * edge[1]);
  const Vec2 along = (parts[0][1] - parts[0][0]).normalized(), to = middle - parts[0][0];
  EXPECT_LT(std::abs(along.x() * to.y() - along.y() * to.x()), 1e-8 * to.norm());
}

TEST(Discrepancies, RunFromTheTracedEndsSquareAcrossToTheEdge) {
  // The edge is seen level, 100 dots below the centre; it was traced 3 dots too high on the left
  // and 1 too low on the right.
  const Vec2 c = kFrame.centre_px();
  const TracedEdge edge{
      LineBetween(c + Vec2(-50, 97), c + Vec2(60, 101), 2, 4), {-1, 10, -1}, {1, 10, -1}};
  const auto d = DiscrepancyOf(Simple(), kFrame, edge);
  ASSERT_TRUE(d.has_value());
  EXPECT_LT((d->at_a_px - Vec2(0, 3)).norm(), 1e-9);
  EXPECT_LT((d->at_b_px - Vec2(0, -1)).norm(), 1e-9);
  // Centre 1 dot off with deviation 2, tilt 4 with deviation 4.
  EXPECT_NEAR(*Penalty(Simple(), kFrame, std::vector{edge}), 0.25 + 1, 1e-9);
}

TEST(Discrepancies, DoNotDependOnHowFarAlongTheEdgeItWasTraced) {
  const Vec2 c = kFrame.centre_px();
  TracedEdge edge{LineBetween(c + Vec2(5, 102), c + Vec2(8, 102), 1, 1), {-1, 10, -1}, {1, 10, -1}};
  const auto d = DiscrepancyOf(Simple(), kFrame, edge);
  // Another part of the same edge.
  edge.from_in_world_m = {1, 10, -1};
  edge.to_in_world_m = {9, 10, -1};
  const auto e = DiscrepancyOf(Simple(), kFrame, edge);
  ASSERT_TRUE(d && e);
  EXPECT_LT((d->at_a_px - e->at_a_px).norm(), 1e-9);
  EXPECT_LT((d->at_b_px - e->at_b_px).norm(), 1e-9);
}

TEST(Discrepancies, OfAnEdgeSeenAsADotOrBehindAreErrors) {
  const ImageLine line = LineBetween({0, 0}, {1, 0}, 1, 1);
  const std::vector<TracedEdge> edges{{line, {-1, 5, 0}, {1, 5, 0}},
                                      {line, {0.1, 1, 0}, {0.5, 5, 0}}};
  const auto penalty = Penalty(Simple(), kFrame, edges);
  ASSERT_FALSE(penalty.has_value());
  EXPECT_EQ(penalty.error().code, ErrorCode::kDegenerate);
  EXPECT_EQ(penalty.error().part, 1);
  EXPECT_EQ(DiscrepancyOf(Simple(), kFrame, {line, {0, -1, 0}, {1, -1, 0}}).error().code,
            ErrorCode::kDegenerate);
}

TEST(Penalty, IsNoneAtTheTrueCameraAndGrowsAsTheSquareOfASmallStep) {
  const std::vector<TracedEdge> edges = Box(Skewed());
  EXPECT_LT(*Penalty(Skewed(), kFrame, edges), 1e-12);
  for (int p = 0; p < kParameters; ++p) {
    const Parameter parameter = static_cast<Parameter>(p);
    const auto one = StepCamera(Skewed(), kFrame, edges, parameter, 1e-6);
    const auto two = StepCamera(Skewed(), kFrame, edges, parameter, 2e-6);
    ASSERT_TRUE(one && two);
    EXPECT_NEAR(two->penalty_after / one->penalty_after, 4, 1e-3) << kParameterNames[p];
  }
}

TEST(StepCamera, MovesOneParameterAndTellsThePenaltyBeforeAndAfter) {
  const std::vector<TracedEdge> edges = Box(Skewed());
  Camera off = Skewed();
  off[kOmega] -= 0.01;
  const auto step = StepCamera(off, kFrame, edges, kOmega, 0.01);
  ASSERT_TRUE(step.has_value());
  EXPECT_LT((step->camera.parameters - Skewed().parameters).norm(), 1e-15);
  EXPECT_EQ(step->penalty_before, *Penalty(off, kFrame, edges));
  EXPECT_LT(step->penalty_after, 1e-12);
  EXPECT_GT(step->penalty_before, 1e3);
  EXPECT_EQ(StepCamera(off, kFrame, edges, kFocal, -20).error().code, ErrorCode::kOutOfRange);
}

TEST(Penalty, OfNoiseIsOneForEachNumberObserved) {
  std::vector<TracedEdge> edges = Box(Skewed());
  for (TracedEdge& edge : edges) {
    const Vec2 along = (edge.line.b_px - edge.line.a_px).normalized(),
               across(-along.y(), along.x());
    // The centre one deviation off, and the ends one deviation apart.
    edge.line.a_px += (0.1 - 0.15) * across;
    edge.line.b_px += (0.1 + 0.15) * across;
  }
  EXPECT_NEAR(*Penalty(Skewed(), kFrame, edges), 24, 1e-3);
}

}  // namespace
}  // namespace tranos::camera
