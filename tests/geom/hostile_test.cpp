// SPDX-License-Identifier: GPL-3.0-or-later
// Values that no drawing should have: every function still ends, with an error or something finite.
#include <limits>

#include "geom/stroke_font.h"
#include "shapes.h"

namespace tranos::geom {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInf = std::numeric_limits<double>::infinity();

std::vector<Curve> HostileCurves() {
  const BsplineCurve sound{2, {0, 0, 0, 1, 1, 1}, {{-2, 4, 0}, {0, -4, 0}, {2, 4, 0}}, {}};
  auto spline = [&](auto change) {
    BsplineCurve c = sound;
    change(c);
    return Curve(c);
  };
  return {Line{{kNan, 0, 0}, {1, 0, 0}},
          Line{{0, 0, 0}, {kInf, 0, 0}},
          Line{{1e300, 0, 0}, {-1e300, 0, 0}},
          Arc{{}, kNan, 1},
          Arc{{}, 1, kInf},
          Arc{{}, -1, 1},
          Circle{{Vec3(0, 0, 0), Vec3(0, 0, 0)}, 1},
          Polyline{},
          Polyline{{{kNan, kNan, kNan}}, true},
          BsplineCurve{},
          Chain{},
          Chain{{Polyline{}}, true},
          spline([](BsplineCurve& c) { c.degree = 0; }),
          spline([](BsplineCurve& c) { c.degree = 1'000'000'000; }),
          spline([](BsplineCurve& c) { c.knots.pop_back(); }),
          spline([](BsplineCurve& c) { c.knots = {0, 0, 0, 0, 0, 0}; }),
          spline([](BsplineCurve& c) { c.knots = {1, 1, 1, 0, 0, 0}; }),
          spline([](BsplineCurve& c) { c.knots[3] = kNan; }),
          spline([](BsplineCurve& c) {
            c.weights = {1, 0, 1};
          }),
          spline([](BsplineCurve& c) {
            c.weights = {1, -1, 1};
          }),
          spline([](BsplineCurve& c) { c.weights = {1}; }),
          spline([](BsplineCurve& c) { c.poles[1].x() = kInf; })};
}

TEST(Hostile, UnsoundCurvesAreToldAndMeasureNothing) {
  for (const Curve& curve : HostileCurves()) {
    EXPECT_FALSE(Check(curve));
    EXPECT_EQ(Length(curve), 0);
    EXPECT_TRUE(BoundingBox(curve).empty());
    EXPECT_FALSE(Tessellate(curve, {}));
    EXPECT_FALSE(EnclosedArea(curve));
    EXPECT_FALSE(PlaneOf(curve));
    EXPECT_TRUE(PointAt(curve, 0.3).allFinite());
    EXPECT_TRUE(PointAtFraction(curve, 0.3).allFinite());
    EXPECT_TRUE(TangentAt(curve, 0.3).allFinite());
    EXPECT_TRUE(NearestPoint(curve, {1, 2, 3}).point.allFinite());
    EXPECT_FALSE(JoinChain({curve}));
    EXPECT_FALSE(Extrusion(curve, {0, 0, 1}));
    EXPECT_FALSE(Revolution(curve, {0, 0, 0}, {0, 0, 1}, 1));
    EXPECT_FALSE(Ruled(curve, curve));
    EXPECT_FALSE(EdgeSurface({curve, curve, curve, curve}));
    Reversed(curve);
    ToBspline(curve);
    IsClosed(curve);
  }
}

std::vector<Curve> DegenerateCurves() {
  const Vec3 p(1, 2, 3);
  return {Line{p, p},
          Arc{{}, 0, 1},
          Arc{{}, 1, 0},
          Circle{{}, 0},
          Polyline{{p}, false},
          Polyline{{p, p, p}, true},
          BsplineCurve{2, {0, 0, 0, 1, 1, 1}, {p, p, p}, {}},
          Chain{{Line{p, p}, Line{p, p}}, true},
          Line{{1e-300, 0, 0}, {0, 0, 0}},
          Line{{1e29, 0, 0}, {-1e29, 0, 0}},
          Circle{{}, 1e29}};
}

TEST(Hostile, CurvesWithoutExtentAndHugeOnesHaveFiniteMeasures) {
  for (const Curve& curve : DegenerateCurves()) {
    EXPECT_TRUE(Check(curve));
    EXPECT_TRUE(std::isfinite(Length(curve)));
    EXPECT_FALSE(BoundingBox(curve).empty());
    EXPECT_TRUE(PointAtFraction(curve, 0.5).allFinite());
    EXPECT_TRUE(TangentAt(curve, 0.5).allFinite());
    EXPECT_TRUE(std::isfinite(NearestPoint(curve, {4, 5, 6}).distance_m));
    if (const auto points = Tessellate(curve, {})) {
      EXPECT_GE(points->size(), 1u);
    }
    EnclosedArea(curve);
    Centroid(curve);
    PlaneOf(curve);
    for (const auto& surface :
         {Extrusion(curve, {0, 0, 1}), Ruled(curve, Line{{0, 0, 0}, {1, 0, 0}}),
          Revolution(curve, {5, 0, 0}, {0, 1, 0}, 1)}) {
      if (!surface) continue;
      EXPECT_TRUE(std::isfinite(Area(*surface)));
      Tessellate(*surface, {});
      Tessellate(*surface, {1, 5});
      VolumeUnder(*surface, 0);
      NearestPoint(*surface, {1, 2, 3});
    }
  }
}

TEST(Hostile, TolerancesThatMeanNothingAreRefused) {
  const Surface surface = *Extrusion(Circle{{}, 1}, {0, 0, 1});
  for (const double chord_m : {0.0, -1.0, kNan, kInf}) {
    EXPECT_EQ(Tessellate(Circle{{}, 1}, {chord_m, 0}).error().code, ErrorCode::kOutOfRange);
    EXPECT_EQ(Tessellate(surface, {chord_m, 0}).error().code, ErrorCode::kOutOfRange);
  }
  EXPECT_EQ(Tessellate(Circle{{}, 1}, {1e-3, -4}).error().code, ErrorCode::kOutOfRange);
  EXPECT_TRUE(Tessellate(surface, {1e90, 0}));
}

TEST(Hostile, UnsoundSurfacesAreToldAndMeasureNothing) {
  const Surface sound = *Extrusion(Circle{{}, 1}, {0, 0, 1});
  std::vector<BsplineSurface> unsound(6, std::get<BsplineSurface>(sound));
  unsound[0].poles[3].y() = kNan;
  unsound[1].count_u = 2'000'000'000;
  unsound[2].knots_v.clear();
  unsound[3].degree_u = -1;
  unsound[4].weights[2] = 0;
  unsound[5] = BsplineSurface{};
  for (const BsplineSurface& one : unsound) {
    const Surface surface = one;
    EXPECT_FALSE(Check(surface));
    EXPECT_EQ(Area(surface), 0);
    EXPECT_TRUE(BoundingBox(surface).empty());
    EXPECT_FALSE(Tessellate(surface, {}));
    EXPECT_FALSE(VolumeUnder(surface, 0));
    EXPECT_FALSE(IsClosed(surface));
    EXPECT_EQ(PointAt(surface, 0.5, 0.5), Vec3(0, 0, 0));
    EXPECT_EQ(NormalAt(surface, 0.5, 0.5), Vec3(0, 0, 0));
    EXPECT_EQ(NearestPoint(surface, {0, 0, 0}).distance_m, 0);
  }
  EXPECT_FALSE(Check(Surface(CoonsPatch{})));
}

TEST(Hostile, ParametersOutsideAreClamped) {
  const Curve line = Line{{1, 0, 0}, {2, 0, 0}};
  EXPECT_EQ(PointAt(line, -5), Vec3(1, 0, 0));
  EXPECT_EQ(PointAt(line, 1e300), Vec3(2, 0, 0));
  EXPECT_EQ(PointAt(line, kNan), Vec3(1, 0, 0));
  const Surface plane = *Extrusion(line, {0, 0, 1});
  EXPECT_EQ(PointAt(plane, kInf, -kInf), Vec3(2, 0, 0));
}

TEST(Hostile, ArcsFromNumbersThatAreNoneAreRefused) {
  EXPECT_FALSE(ArcThrough({kNan, 0, 0}, {1, 1, 0}, {2, 0, 0}));
  EXPECT_FALSE(ArcThrough({0, 0, 0}, {1e200, 1e200, 0}, {2e200, 0, 0}));
  EXPECT_FALSE(ArcAround({0, 0, 0}, {kInf, 0, 0}, {0, 1, 0}, {0, 0, 1}));
  EXPECT_FALSE(ArcAround({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}));
}

TEST(Hostile, TextWithoutAFrameIsNotDrawn) {
  Text text{"A", {}, kNan};
  EXPECT_TRUE(Strokes(text).empty());
  text.height_m = 1;
  text.frame.origin.x() = kInf;
  EXPECT_TRUE(Strokes(text).empty());
  EXPECT_TRUE(BoundingBox(text).empty());
}

}  // namespace
}  // namespace tranos::geom
