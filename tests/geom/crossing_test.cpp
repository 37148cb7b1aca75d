// SPDX-License-Identifier: GPL-3.0-or-later
// What interp's `intersection` shows of lines and arcs is tested there; here B-splines, whose
// crossings must be those of the arcs and lines that they are equal to.
#include "geom/crossing.h"

#include "geom/construction.h"
#include "shapes.h"

namespace tranos::geom {
namespace {

RC_GTEST_PROP(Crossings, OfBsplinesAreThoseOfTheArcsTheyEqual, ()) {
  Frame other;
  other.origin = {Within(-4, 4), Within(-4, 4), 0};
  const Arc a{Frame{}, Within(1, 3), Within(1, 2 * kPi)},
      b{other, Within(1, 3), Within(1, 2 * kPi)};
  const auto exact = Crossings(a, b);
  // What nearly touches is found or not by a hair.
  const double distance = other.origin.norm();
  RC_PRE(std::abs(distance - a.radius - b.radius) > 1e-3);
  RC_PRE(std::abs(distance - std::abs(a.radius - b.radius)) > 1e-3);
  const auto found = Crossings(ToBspline(a), b), both = Crossings(ToBspline(a), ToBspline(b));
  RC_ASSERT(found.size() == exact.size());
  RC_ASSERT(both.size() == exact.size());
  for (const Crossing& crossing : found) {
    RC_ASSERT(NearestPoint(a, crossing.point).distance_m < 1e-9);
    RC_ASSERT(NearestPoint(b, crossing.point).distance_m < 1e-9);
    RC_ASSERT(Near(PointAt(ToBspline(a), crossing.t_a), crossing.point, 1e-6));
    RC_ASSERT(Near(PointAt(b, crossing.t_b), crossing.point, 1e-6));
  }
}

TEST(Crossings, OfAWaveAndALine) {
  std::vector<Vec3> points;
  for (int i = 0; i <= 20; ++i) points.push_back({1.0 * i, i % 2 == 0 ? -1.0 : 1.0, 0});
  const BsplineCurve wave = *CurveThrough(points, false);
  const auto found = Crossings(wave, Line{{-1, 0, 0}, {30, 0, 0}});
  ASSERT_EQ(found.size(), 20u);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].point.y(), 0, 1e-12);
    if (i > 0) {
      EXPECT_GT(found[i].t_a, found[i - 1].t_a);
    }
  }
}

TEST(Crossings, OfCurvesThatLieOnOneAnotherEnd) {
  const BsplineCurve curve = *CurveThrough({{0, 0, 0}, {1, 1, 0}, {3, 0, 0}, {5, 2, 1}}, false);
  EXPECT_FALSE(Crossings(curve, curve).empty());
}

TEST(Crossings, OfSkewCurvesAreNone) {
  const BsplineCurve curve = *CurveThrough({{0, 0, 0}, {1, 1, 0}, {3, 0, 0}}, false);
  EXPECT_TRUE(Crossings(curve, Line{{0, 0.5, 0.001}, {3, 0.5, 0.001}}).empty());
}

}  // namespace
}  // namespace tranos::geom
