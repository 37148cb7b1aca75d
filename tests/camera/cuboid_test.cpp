// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/camera/cuboid.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace tranos::camera::benchmark {
namespace {

using Long = long double;
using LongParameters = Eigen::Matrix<Long, kParameters, 1>;

// Offsets, in pixels, of the ends of the exact segment from the image of its edge for a camera.
Eigen::Matrix<Long, 2, 1> Offsets(const LongParameters& p, const Cuboid& cuboid,
                                  const CuboidEdge& edge, const Frame& frame) {
  using Point = Eigen::Matrix<Long, 3, 1>;
  const auto image = [&](int index) -> Point {
    const Point vertex = Vertex(index, cuboid.dimensions_m, cuboid.offset_m).cast<Long>();
    const Point x = FrameFromCamera<Long>(p) * (CameraFromWorld<Long>(p) * (vertex - p.tail<3>()));
    return x / x.z();
  };
  const Point line = image(edge.from).cross(image(edge.to));
  const Segment traced = ExactSegment(cuboid, edge, frame);
  const auto offset = [&](const Vec2& dot) {
    const Point at = frame.PointFromDot(dot).homogeneous().cast<Long>();
    return line.dot(at) / line.head<2>().norm() / static_cast<Long>(frame.pitch_mm().x());
  };
  return {offset(traced.a_px), offset(traced.b_px)};
}

ParameterVector BoundOf(const Cuboid& cuboid, const Frame& frame) {
  Eigen::Matrix<Long, kParameters, kParameters> information;
  information.setZero();
  for (const CuboidEdge& edge : VisibleEdges(cuboid)) {
    const Segment traced = ExactSegment(cuboid, edge, frame);
    const Long samples = SamplesOf((traced.b_px - traced.a_px).norm());
    for (const Long sign : {1, -1}) {
      LongParameters gradient;
      for (int i = 0; i < kParameters; ++i) {
        LongParameters step = LongParameters::Zero();
        step[i] = 1e-6L;
        const LongParameters at = cuboid.truth.parameters.cast<Long>();
        const Eigen::Matrix<Long, 2, 1> slope =
            (Offsets(at + step, cuboid, edge, frame) - Offsets(at - step, cuboid, edge, frame)) /
            2e-6L;
        const Long scale = sign > 0 ? std::sqrt(samples) / 2 : std::sqrt(samples / 12);
        gradient[i] = scale * (slope[1] + sign * slope[0]);
      }
      information += gradient * gradient.transpose();
    }
  }
  const auto covariance = information.fullPivLu().inverse().eval();
  return covariance.diagonal().cwiseSqrt().cast<double>();
}

TEST(CuboidBenchmark, VerticesAreOnTheGoldenPixels) {
  for (const Cuboid& cuboid : Cuboids())
    for (int index = 0; index < 8; ++index) {
      const Vec3 vertex = Vertex(index, cuboid.dimensions_m, cuboid.offset_m);
      const Vec2 pixel = Project(cuboid.truth, vertex).point_mm / FrameOf(kHi).pitch_mm().x();
      EXPECT_LT((pixel - cuboid.golden[static_cast<size_t>(index)]).norm(), 1e-9) << cuboid.name;
    }
}

TEST(CuboidBenchmark, TheEdgesOfTheFacesSeenGiveThePublishedBounds) {
  for (const Cuboid& cuboid : Cuboids())
    for (const Picture picture : {kHi, kLo}) {
      if (!cuboid.determined()) continue;
      const ParameterVector& expected = cuboid.bound[picture];
      const ParameterVector bound = BoundOf(cuboid, FrameOf(picture));
      EXPECT_LT((bound.cwiseQuotient(expected) - ParameterVector::Ones()).cwiseAbs().maxCoeff(),
                1e-6)
          << cuboid.name << picture;
    }
}

TEST(CuboidBenchmark, NoiseOfTheTracesHasTheStatedDeviations) {
  const Cuboid& cuboid = CuboidOf("B1");
  const std::vector<CuboidEdge> edges = VisibleEdges(cuboid);
  const Frame frame = FrameOf(kHi);
  double centre = 0, tilt = 0;
  const int trials = 2000;
  for (int seed = 0; seed < trials; ++seed) {
    const TracedCuboid traced = TraceCuboid(
        cuboid, {.sigma_px = 0.5, .seed = static_cast<std::uint64_t>(seed), .directions = false});
    for (size_t i = 0; i < edges.size(); ++i) {
      const ImageLine& line = std::get<EdgeTrace>(traced.photograph.traces[i]).line;
      const Segment exact = ExactSegment(cuboid, edges[i], frame);
      const Vec2 along = (exact.b_px - exact.a_px).normalized();
      const Vec2 across(-along.y(), along.x());
      const double a = across.dot(line.a_px - exact.a_px), b = across.dot(line.b_px - exact.b_px);
      centre += std::pow((a + b) / 2 / line.centre_sigma_px, 2);
      tilt += std::pow((b - a) / line.tilt_sigma_px, 2);
    }
  }
  const double draws = trials * static_cast<double>(edges.size());
  EXPECT_NEAR(centre / draws, 1, 4 * std::sqrt(2 / draws));
  EXPECT_NEAR(tilt / draws, 1, 4 * std::sqrt(2 / draws));
}

}  // namespace
}  // namespace tranos::camera::benchmark
