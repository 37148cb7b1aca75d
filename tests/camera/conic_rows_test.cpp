// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/conic_rows.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/camera/cuboid.h"

namespace tranos::camera {
namespace {

using namespace benchmark;

Conic TrueConic(const Cuboid& cuboid, const Frame& frame) {
  return ConicOf(ConditionedCameraOf(cuboid.truth, frame).inverse_calibration.inverse())
      .normalized();
}

void ExpectFulfilled(const ConicRows& rows, const Conic& conic) {
  for (const Conic& row : rows.all()) EXPECT_LT(std::abs(row.dot(conic)), 1e-11 * row.norm());
}

Vec2 DotAt(const Cuboid& cuboid, const Vec3& point_m) {
  return FrameOf(kHi).DotFromPoint(Project(cuboid.truth, point_m).point_mm);
}

TEST(ConicRows, OfEdgesAreThreeAnglesAndThreeRatiosOfRankFive) {
  for (const Cuboid& cuboid : Cuboids()) {
    if (!cuboid.determined()) continue;
    const TracedCuboid traced = TraceCuboid(cuboid, {});
    const ConicRows rows = ConicRowsOf(traced.photograph, traced.numbers);
    EXPECT_EQ(rows.orthogonal.size(), 3u);
    EXPECT_EQ(rows.metric.size(), 3u);
    EXPECT_EQ(RankOfRows(IndependentRows(rows.all(), 6)), 5);
    ExpectFulfilled(rows, TrueConic(cuboid, traced.photograph.frame));
  }
}

TEST(ConicRows, OfDirectionsAloneAreTheAngles) {
  const Cuboid& cuboid = CuboidOf("B4");
  const TracedCuboid traced = TraceCuboid(cuboid, {.edges = false, .directions = true});
  const ConicRows rows = ConicRowsOf(traced.photograph, traced.numbers);
  EXPECT_EQ(RankOfRows(rows.all()), 3);
  EXPECT_TRUE(rows.metric.empty());
  ExpectFulfilled(rows, TrueConic(cuboid, traced.photograph.frame));
}

TEST(ConicRows, ACircleOnTheMainFacadeIsASquareWhateverItsSize) {
  const Cuboid& cuboid = CuboidOf("B1");
  TracedCuboid traced = TraceCuboid(cuboid, {.edges = false, .directions = true});
  const int of_directions = RankOfRows(ConicRowsOf(traced.photograph, traced.numbers).all());
  CircleTrace circle{{}, 0.5, 0};
  for (int i = 0; i < 7; ++i) {
    const Vec3 out(std::cos(0.9 * i), 0, std::sin(0.9 * i));
    circle.dots_px.push_back(DotAt(cuboid, cuboid.offset_m + Vec3(5, 0, 3) + 1.5 * out));
  }
  traced.photograph.traces.emplace_back(circle);
  const ConicRows rows = ConicRowsOf(traced.photograph, traced.numbers);
  EXPECT_EQ(rows.metric.size(), 2u);
  EXPECT_EQ(RankOfRows(rows.all()), of_directions + 1);
  const Conic conic = TrueConic(cuboid, traced.photograph.frame);
  for (const Conic& row : rows.all()) EXPECT_LT(std::abs(row.dot(conic)), 1e-9 * row.norm());
}

TEST(ConicRows, ARatioOnTheMainFacadeIsLinearAndTheFourthConstraint) {
  const Cuboid& cuboid = CuboidOf("B1");
  TracedCuboid traced = TraceCuboid(cuboid, {.edges = false, .directions = true});
  RatioTrace ratio{};
  ratio.sigma_px = 0.5;
  ratio.facade = 0;
  ratio.ratio = 0;
  traced.numbers = {Eigen::VectorXd::Constant(1, 2.5 / 1.25), {}};
  // Two edges in the facade, aslant to it, apart from one another.
  const Vec3 along = Vec3(3, 0, 4) / 5, up = Vec3(-4, 0, 3) / 5, origin = cuboid.offset_m;
  const Vec3 ends[4] = {origin + Vec3(4, 0, 1), origin + Vec3(4, 0, 1) + 2.5 * along,
                        origin + Vec3(8, 0, 2), origin + Vec3(8, 0, 2) + 1.25 * up};
  for (int i = 0; i < 4; ++i) ratio.dots_px[i] = DotAt(cuboid, ends[i]);
  traced.photograph.traces.push_back(ratio);
  const ConicRows rows = ConicRowsOf(traced.photograph, traced.numbers);
  const Conic conic = TrueConic(cuboid, traced.photograph.frame);
  ExpectFulfilled(rows, conic);
  EXPECT_EQ(RankOfRows(IndependentRows(rows.all(), 6)), 4);
  // Another ratio is another constraint, that the camera does not fulfil.
  traced.numbers.values[0] = 2.2;
  const ConicRows wrong = ConicRowsOf(traced.photograph, traced.numbers);
  ASSERT_FALSE(wrong.metric.empty());
  EXPECT_GT(std::abs(wrong.metric[0].dot(conic)), 1e-4 * wrong.metric[0].norm());
}

TEST(ConicRows, ARectangleOfAnyFacadeGivesTwo) {
  const Cuboid& cuboid = CuboidOf("B2");
  TracedCuboid traced;
  traced.photograph.frame = FrameOf(kHi);
  traced.numbers = {Eigen::Vector2d(14, 6), {}};
  RectangleTrace rectangle{};  // of the facade X = const
  rectangle.sigma_px = 0.5;
  rectangle.a = 0, rectangle.b = 1, rectangle.facade = 3;
  const int corners[4] = {4, 6, 7, 5};
  for (int i = 0; i < 4; ++i)
    rectangle.dots_px[i] = DotAt(cuboid, Vertex(corners[i], cuboid.dimensions_m, cuboid.offset_m));
  traced.photograph.traces.push_back(rectangle);
  const ConicRows rows = ConicRowsOf(traced.photograph, traced.numbers);
  EXPECT_EQ(RankOfRows(rows.all()), 2);
  ExpectFulfilled(rows, TrueConic(cuboid, traced.photograph.frame));
}

// Distances from the image of an edge, taken without the lines' algebra.
TEST(SpaceTraces, ThePenaltyIsThatOfTheOffsetsOfTheTracedEnds) {
  const Cuboid& cuboid = CuboidOf("B3");
  const TracedCuboid traced = TraceCuboid(cuboid, {.sigma_px = 1});
  const Frame frame = FrameOf(kHi);
  double expected = 0;
  for (const Trace& trace : traced.photograph.traces) {
    const EdgeTrace& edge = std::get<EdgeTrace>(trace);
    const auto vertex = [&](NumberIndex at) -> Vec3 {
      return traced.numbers.values.segment<3>(at);
    };
    const Vec2 p = DotAt(cuboid, vertex(edge.from)), q = DotAt(cuboid, vertex(edge.to));
    const Vec2 along = (q - p).normalized();
    const auto offset = [&](const Vec2& dot) {
      return along.x() * (dot - p).y() - along.y() * (dot - p).x();
    };
    const double a = offset(edge.line.a_px), b = offset(edge.line.b_px);
    expected += std::pow((a + b) / 2 / edge.line.centre_sigma_px, 2) +
                std::pow((b - a) / edge.line.tilt_sigma_px, 2);
  }
  const SpaceTraces traces = SpaceTracesOf(traced.photograph, traced.numbers);
  const ConditionedCamera camera = ConditionedCameraOf(cuboid.truth, frame);
  EXPECT_NEAR(PenaltyOf(traces, camera) / expected, 1, 1e-9);
  // Linear rows about the camera itself: the same to first order in the noise.
  ProjectionMatrix p;
  p.leftCols<3>() = camera.inverse_calibration.inverse() * camera.camera_from_world;
  p.col(3) = -p.leftCols<3>() * camera.position_m;
  const Eigen::VectorXd residuals = ProjectionRowsOf(traces, &p) * p.reshaped();
  EXPECT_NEAR(residuals.squaredNorm() / expected, 1, 0.02);
}

}  // namespace
}  // namespace tranos::camera
