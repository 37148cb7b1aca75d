// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes.h"

namespace tranos::geom {
namespace {

const Vec3 kOrigin = Vec3::Zero(), kUp = Vec3::UnitZ();

Curve HalfMeridian(double radius) {
  return *ArcThrough({0, 0, -radius}, {radius, 0, 0}, {0, 0, radius});
}
Curve TubeAt(double distance, double radius) {
  return Circle{{Vec3(distance, 0, 0), Vec3::UnitX(), Vec3::UnitZ()}, radius};
}
Surface Sphere(double radius) { return *Revolution(HalfMeridian(radius), kOrigin, kUp, 2 * kPi); }

void ExpectRelative(double value, double exact, double relative) {
  EXPECT_NEAR(value, exact, relative * std::abs(exact));
}

TEST(Fig6, SurfaceIsTheExactBsplineOfThePaper) {
  const Surface dome = *EdgeSurface(Fig6Edges());
  ASSERT_TRUE(HasExactBspline(dome));
  const auto& s = std::get<BsplineSurface>(dome);
  const std::vector<double> knots = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
  const double x[] = {0, 5, 10, 10, 15, 20, 20, 25, 30};
  const double z[] = {0, 0, 0, 5, 5, 5, 0, 0, 0};
  const double h = std::sqrt(0.5), w[] = {1, 1, 1, h, 1, h, 1, 1, 1};
  EXPECT_EQ(s.degree_u, 2);
  EXPECT_EQ(s.degree_v, 2);
  EXPECT_EQ(s.knots_u, knots);
  EXPECT_EQ(s.knots_v, knots);
  ASSERT_EQ(s.count_u, 9);
  ASSERT_EQ(s.count_v, 9);
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) {
      EXPECT_TRUE(Near(s.poles[i * 9 + j], {x[i], -x[j], z[i] + z[j]}, 1e-12));
      EXPECT_NEAR(s.weights[i * 9 + j], w[i] * w[j], 1e-15);
    }
  }
}

TEST(Fig6, AreaAgreesWithItsClosedForm) {
  // Four flat squares, four half barrels, and over the crossing 100·∫ E(sin a) da over a right
  // angle, which is 50·(K² + π²/(4K²)) with K = K(√½).
  const double k = std::comp_ellint_1(std::sqrt(0.5));
  const double exact = 400 + 200 * kPi + 50 * (k * k + kPi * kPi / (4 * k * k));
  const Surface dome = *EdgeSurface(Fig6Edges());
  EXPECT_NEAR(Area(dome), 1236.08668, 1e-5);
  ExpectRelative(Area(dome), exact, 1e-11);
}

TEST(Fig6, VolumeApexAndBoxAreThoseOfThePaper) {
  const Surface dome = *EdgeSurface(Fig6Edges());
  ExpectRelative(*VolumeUnder(dome, 0), 750 * kPi, 1e-11);
  EXPECT_TRUE(Near(PointAt(dome, 0.5, 0.5), {15, -15, 10}, 1e-12));
  EXPECT_TRUE(Near(BoundingBox(dome).min, {0, -30, 0}, 1e-9));
  EXPECT_TRUE(Near(BoundingBox(dome).max, {30, 0, 10}, 1e-9));
}

TEST(Fig6, TheOrderAndDirectionsOfTheEdgesDoNotMatter) {
  std::vector<Curve> edges = Fig6Edges();
  std::swap(edges[1], edges[3]);
  edges[1] = Reversed(edges[1]);
  edges[2] = Reversed(edges[2]);
  const Surface dome = *EdgeSurface(edges);
  EXPECT_TRUE(Near(PointAt(dome, 0, 0), {0, 0, 0}, 1e-12));
  EXPECT_TRUE(Near(PointAt(dome, 1, 0), {30, 0, 0}, 1e-12));
  EXPECT_TRUE(Near(PointAt(dome, 0, 1), {0, -30, 0}, 1e-12));
  ExpectRelative(Area(dome), Area(*EdgeSurface(Fig6Edges())), 1e-12);
}

// A skew quadrilateral ring with sides of several kinds.
std::vector<Curve> Ring() {
  const Vec3 a(0, 0, 0), b(10, 0, 1), c(11, 9, -1), d(-1, 8, 2);
  const BsplineCurve wave{
      3, {0, 0, 0, 0, 1, 1, 1, 1}, {c, {7, 12, 3}, {3, 6, -2}, d}, {1, 2, 0.5, 1}};
  return {*ArcThrough(a, {5, -1, 3}, b), Line{b, c}, wave, Polyline{{d, {-2, 4, 1}, a}, false}};
}

TEST(Coons, PassesThroughItsFourEdges) {
  const std::vector<Curve> ring = Ring();
  const Surface patch = *EdgeSurface({ring[0], ring[2], Reversed(ring[1]), ring[3]});
  EXPECT_FALSE(HasExactBspline(patch));
  for (int i = 0; i <= 40; ++i) {
    const double t = i / 40.0;
    EXPECT_LT(NearestPoint(ring[0], PointAt(patch, t, 0)).distance_m, 1e-9);
    EXPECT_LT(NearestPoint(ring[1], PointAt(patch, 1, t)).distance_m, 1e-9);
    EXPECT_LT(NearestPoint(ring[2], PointAt(patch, t, 1)).distance_m, 1e-9);
    EXPECT_LT(NearestPoint(ring[3], PointAt(patch, 0, t)).distance_m, 1e-9);
    EXPECT_LT(NearestPoint(patch, PointAt(ring[2], t)).distance_m, 1e-9);
  }
}

TEST(Coons, FlatRegionHasTheAreaOfItsOutline) {
  const std::vector<Curve> outline = {
      *ArcThrough({0, 0, 0}, {5, -2, 0}, {10, 0, 0}), Line{{10, 0, 0}, {9, 8, 0}},
      *ArcThrough({9, 8, 0}, {5, 10, 0}, {1, 7, 0}), Line{{1, 7, 0}, {0, 0, 0}}};
  const Surface patch = *EdgeSurface(outline);
  ExpectRelative(Area(patch), *EnclosedArea(*JoinChain(outline)), 1e-9);
  ExpectRelative(*VolumeUnder(patch, -3), 3 * Area(patch), 1e-9);
}

TEST(Coons, ThreeEdgesMakeATriangle) {
  const Surface triangle = *EdgeSurface(
      {Line{{0, 0, 0}, {4, 0, 0}}, Line{{0, 3, 0}, {4, 0, 0}}, Line{{0, 0, 0}, {0, 3, 0}}});
  ExpectRelative(Area(triangle), 6, 1e-9);
  EXPECT_TRUE(Near(PointAt(triangle, 1, 0), PointAt(triangle, 1, 1), 1e-12));
}

TEST(Coons, EdgesThatDoNotMeetAreNamed) {
  std::vector<Curve> ring = Ring();
  ring[2] = Line{{11, 9, -1}, {-1, 8, 2.5}};
  const auto open = EdgeSurface(ring);
  ASSERT_FALSE(open);
  EXPECT_EQ(open.error().code, ErrorCode::kDoNotMeet);
  EXPECT_EQ(open.error().part, 2);
  EXPECT_EQ(EdgeSurface({ring[0], ring[1]}).error().code, ErrorCode::kOutOfRange);
}

TEST(Area, RevolvedSolidsHaveTheirClosedForms) {
  ExpectRelative(Area(Sphere(2.5)), 4 * kPi * 6.25, 1e-10);
  ExpectRelative(Area(*Revolution(TubeAt(7, 2), kOrigin, kUp, 2 * kPi)), 4 * kPi * kPi * 14, 1e-10);
  const Line slant{{3, 0, 0}, {0, 0, 4}};
  ExpectRelative(Area(*Revolution(slant, kOrigin, kUp, 2 * kPi)), kPi * 3 * 5, 1e-10);
  const Line wall{{3, 0, 0}, {3, 0, 4}};
  ExpectRelative(Area(*Revolution(wall, kOrigin, kUp, -1)), 12, 1e-10);
  ExpectRelative(Area(*Extrusion(Circle{{}, 3}, {0, 0, 4})), 24 * kPi, 1e-10);
}

TEST(Area, SaddleAgreesWithItsIntegral) {
  // z = x·y over the unit square: ∫∫ √(1 + x² + y²) in closed form.
  const double exact =
      (std::sqrt(3) + 4 * std::log((1 + std::sqrt(3)) / std::sqrt(2)) - kPi / 6) / 3;
  const Surface saddle = *Ruled(Line{{0, 0, 0}, {1, 0, 0}}, Line{{0, 1, 0}, {1, 1, 1}});
  ExpectRelative(Area(saddle), exact, 1e-11);
  ExpectRelative(*VolumeUnder(saddle, 0), 0.25, 1e-12);
}

RC_GTEST_PROP(Area, ScalesWithTheSquareUnderASimilarity, ()) {
  const Surface patch = *EdgeSurface(Ring());
  double scale = 1;
  const Affine m = DrawSimilarity(&scale);
  RC_ASSERT(std::abs(Area(Transformed(patch, m)) / (scale * scale * Area(patch)) - 1) < 1e-9);
}

TEST(Volume, HalfSphereAndConeStandOverTheirPlan) {
  const Arc quarter = *ArcAround(kOrigin, {3, 0, 0}, {0, 0, 3}, {0, -1, 0});
  ExpectRelative(*VolumeUnder(*Revolution(quarter, kOrigin, kUp, 2 * kPi), 0), 18 * kPi, 1e-10);
  const Line slant{{3, 0, 0}, {0, 0, 4}};
  ExpectRelative(*VolumeUnder(*Revolution(slant, kOrigin, kUp, 2 * kPi), 0), 12 * kPi, 1e-10);
  ExpectRelative(*VolumeUnder(*Revolution(slant, kOrigin, kUp, 2 * kPi), 1), 3 * kPi, 1e-10);
}

TEST(Volume, SurfacesWithSeveralHeightsOverAPointAreRefused) {
  auto code = [](const Surface& s) { return VolumeUnder(s, 0).error().code; };
  EXPECT_EQ(code(*Extrusion(Line{{0, 0, 0}, {5, 1, 0}}, kUp)), ErrorCode::kNotAGraph);
  EXPECT_EQ(code(Sphere(2)), ErrorCode::kNotAGraph);
  EXPECT_EQ(code(*Revolution(TubeAt(7, 2), kOrigin, kUp, 2 * kPi)), ErrorCode::kNotAGraph);
  const Polyline step{{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {2, 0, 1}}, false};
  EXPECT_EQ(code(*Extrusion(step, {0, 3, 0})), ErrorCode::kNotAGraph);
}

// A ramp about the z axis that rises by one a turn.
Surface Ramp(double turns) {
  BsplineCurve inner{2, {0, 0, 0}, {}, {}};
  const int spans = static_cast<int>(std::ceil(4 * turns));
  const double half = kPi * turns / spans;
  for (int i = 0; i <= 2 * spans; ++i) {
    const double angle = half * i, radius = i % 2 ? 1 / std::cos(half) : 1;
    inner.poles.push_back({radius * std::cos(angle), radius * std::sin(angle), angle / (2 * kPi)});
    inner.weights.push_back(i % 2 ? std::cos(half) : 1);
    if (i % 2 == 0 && i > 0) inner.knots.insert(inner.knots.end(), 2, i);
  }
  inner.knots.push_back(inner.knots.back());
  return *Ruled(inner, Transformed(inner, Moved(Vec3(2, 2, 1).asDiagonal(), Vec3::Zero())));
}

TEST(Volume, SpiralRampIsAGraphUntilItComesRound) {
  EXPECT_TRUE(VolumeUnder(Ramp(0.9), 0));
  ASSERT_FALSE(VolumeUnder(Ramp(1.1), 0));
  EXPECT_EQ(VolumeUnder(Ramp(1.1), 0).error().code, ErrorCode::kNotAGraph);
  EXPECT_FALSE(VolumeUnder(Ramp(2.5), 0));
}

TEST(Swept, RevolvedPointsKeepTheirDistanceFromTheAxis) {
  const Surface sphere = Sphere(2.5);
  for (int i = 0; i <= 20; ++i) {
    for (int j = 0; j <= 20; ++j) {
      EXPECT_NEAR(PointAt(sphere, i / 20.0, j / 20.0).norm(), 2.5, 1e-13);
    }
  }
  EXPECT_TRUE(IsClosed(sphere));
  EXPECT_TRUE(IsClosed(*Revolution(TubeAt(7, 2), kOrigin, kUp, 2 * kPi)));
  EXPECT_FALSE(IsClosed(*Revolution(TubeAt(7, 2), kOrigin, kUp, kPi)));
  EXPECT_FALSE(IsClosed(*Extrusion(Circle{{}, 3}, kUp)));
}

TEST(Swept, RevolutionTurnsCounterClockwiseAboutItsAxis) {
  const Surface quarter = *Revolution(Line{{1, 0, 0}, {1, 0, 1}}, kOrigin, kUp, kPi / 2);
  EXPECT_TRUE(Near(PointAt(quarter, 1, 0), {0, 1, 0}, 1e-14));
  const Surface back = *Revolution(Line{{1, 0, 0}, {1, 0, 1}}, kOrigin, kUp, -kPi / 2);
  EXPECT_TRUE(Near(PointAt(back, 1, 0), {0, -1, 0}, 1e-14));
}

TEST(Swept, MeaninglessSweepsAreRefused) {
  const Line line{{1, 0, 0}, {1, 0, 1}};
  EXPECT_EQ(Extrusion(line, kOrigin).error().code, ErrorCode::kDegenerate);
  EXPECT_EQ(Revolution(line, kOrigin, kOrigin, 1).error().code, ErrorCode::kDegenerate);
  EXPECT_EQ(Revolution(line, kOrigin, kUp, 0).error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(Revolution(line, kOrigin, kUp, 7).error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(Revolution(Line{{0, 0, 0}, {0, 0, 1}}, kOrigin, kUp, 1).error().code,
            ErrorCode::kDegenerate);
}

RC_GTEST_PROP(Swept, RuledSurfacePassesThroughBothCurves, ()) {
  const Curve from = DrawCurve(), to = DrawCurve();
  RC_PRE(Length(from) + Length(to) > 0.01);
  const Surface ruled = *Ruled(from, to);
  for (int i = 0; i <= 10; ++i) {
    RC_ASSERT(NearestPoint(from, PointAt(ruled, i / 10.0, 0)).distance_m < 1e-9);
    RC_ASSERT(NearestPoint(to, PointAt(ruled, i / 10.0, 1)).distance_m < 1e-9);
  }
}

TEST(SurfaceBox, TiltedTorusHasATightBox) {
  const Surface torus = *Revolution(TubeAt(7, 2), kOrigin, kUp, 2 * kPi);
  EXPECT_TRUE(Near(BoundingBox(torus).max, {9, 9, 2}, 1e-9));
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd(0.4, Vec3::UnitX()).toRotationMatrix();
  const Box box = BoundingBox(Transformed(torus, Moved(tilt, Vec3::Zero())));
  EXPECT_TRUE(Near(box.max, {9, 7 * std::cos(0.4) + 2, 7 * std::sin(0.4) + 2}, 1e-9));
}

TEST(SurfaceBox, CoonsPatchIsInItsBoxAndTouchesIt) {
  const Surface patch = *EdgeSurface(Ring());
  const Box box = BoundingBox(patch);
  Box seen;
  for (int i = 0; i <= 200; ++i) {
    for (int j = 0; j <= 200; ++j) seen.Add(PointAt(patch, i / 200.0, j / 200.0));
  }
  EXPECT_TRUE(Near(seen.max, box.max, 2e-3));
  EXPECT_TRUE(Near(seen.min, box.min, 2e-3));
  EXPECT_TRUE((box.max.array() >= seen.max.array() - 1e-9).all());
  EXPECT_TRUE((box.min.array() <= seen.min.array() + 1e-9).all());
}

RC_GTEST_PROP(SurfaceNearest, OnASphereItIsOnTheRadius, ()) {
  const Vec3 p = DrawPoint(5);
  RC_PRE(p.norm() > 0.1);
  const Nearest nearest = NearestPoint(Sphere(2.5), p);
  RC_ASSERT(std::abs(nearest.distance_m - std::abs(p.norm() - 2.5)) < 1e-9);
  RC_ASSERT((nearest.point - 2.5 * p.normalized()).norm() < 1e-6);
}

RC_GTEST_PROP(SurfaceNearest, NothingSampledIsNearer, ()) {
  const Surface patch = *EdgeSurface(Ring());
  const Vec3 p = DrawPoint(12);
  const Nearest nearest = NearestPoint(patch, p);
  for (int i = 0; i <= 30; ++i) {
    for (int j = 0; j <= 30; ++j) {
      RC_ASSERT((PointAt(patch, i / 30.0, j / 30.0) - p).norm() >= nearest.distance_m - 1e-9);
    }
  }
}

TEST(SurfaceNormal, IsUnitAndSquareToTheSurface) {
  const Surface patch = *EdgeSurface(Ring());
  for (const double u : {0.1, 0.35, 0.8}) {
    for (const double v : {0.2, 0.45, 0.9}) {
      const Vec3 normal = NormalAt(patch, u, v);
      EXPECT_NEAR(normal.norm(), 1, 1e-12);
      const Vec3 du = PointAt(patch, u + 1e-6, v) - PointAt(patch, u - 1e-6, v);
      const Vec3 dv = PointAt(patch, u, v + 1e-6) - PointAt(patch, u, v - 1e-6);
      EXPECT_NEAR(normal.dot(du.normalized()), 0, 1e-7);
      EXPECT_NEAR(normal.dot(dv.normalized()), 0, 1e-7);
      EXPECT_GT(normal.dot(du.cross(dv)), 0);
    }
  }
}

}  // namespace
}  // namespace tranos::geom
