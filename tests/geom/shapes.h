// SPDX-License-Identifier: GPL-3.0-or-later
// Curves and transforms for the tests of geom, made from whole numbers so that failing cases read
// well.
#pragma once

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "geom/curve.h"
#include "geom/surface.h"

namespace tranos::geom {

inline double Hundredth(int limit) {
  return *rc::gen::inRange(-limit * 100, limit * 100 + 1) / 100.0;
}
inline double Within(double low, double high) {
  return low + (high - low) * (*rc::gen::inRange(0, 10001) / 10000.0);
}
inline Vec3 DrawPoint(int limit = 20) {
  const double x = Hundredth(limit), y = Hundredth(limit), z = Hundredth(limit);
  return {x, y, z};
}
inline Eigen::Matrix3d DrawRotation() {
  const double a = Within(-3, 3), b = Within(-1.5, 1.5), c = Within(-3, 3);
  return (Eigen::AngleAxisd(a, Vec3::UnitZ()) * Eigen::AngleAxisd(b, Vec3::UnitY()) *
          Eigen::AngleAxisd(c, Vec3::UnitX()))
      .toRotationMatrix();
}
inline Frame DrawFrame() {
  const Eigen::Matrix3d axes = DrawRotation();
  Frame frame;
  frame.origin = DrawPoint();
  frame.x = axes.col(0);
  frame.y = axes.col(1);
  return frame;
}
inline Arc DrawArc() {
  Arc arc;
  arc.frame = DrawFrame();
  arc.radius = Within(0.1, 15);
  arc.sweep_rad = Within(0.05, 2 * kPi);
  return arc;
}
inline BsplineCurve DrawBspline() {
  BsplineCurve curve;
  curve.degree = *rc::gen::inRange(1, 5);
  const int count = curve.degree + *rc::gen::inRange(1, 6);
  for (int i = 0; i < count; ++i) {
    curve.poles.push_back(DrawPoint());
    curve.weights.push_back(Within(0.2, 3));
  }
  curve.knots.assign(curve.degree, -1.0);
  double knot = -1;
  for (int i = curve.degree; i <= count; ++i, knot += Within(0.1, 2)) curve.knots.push_back(knot);
  curve.knots.insert(curve.knots.end(), curve.degree, curve.knots.back());
  return curve;
}
inline Polyline DrawPolyline() {
  Polyline polyline;
  const int count = *rc::gen::inRange(2, 8);
  for (int i = 0; i < count; ++i) polyline.vertices.push_back(DrawPoint());
  polyline.closed = *rc::gen::arbitrary<bool>();
  return polyline;
}
// A curve of any kind.
inline Curve DrawCurve() {
  switch (*rc::gen::inRange(0, 6)) {
    case 0:
      return Line{DrawPoint(), DrawPoint()};
    case 1:
      return DrawArc();
    case 2:
      return Circle{DrawFrame(), Within(0.1, 15)};
    case 3:
      return DrawPolyline();
    case 4:
      return DrawBspline();
    default: {
      const Arc arc = DrawArc();
      const Vec3 end = PointAt(arc, 1);
      const Polyline rest{{end, DrawPoint(), DrawPoint()}, false};
      return Chain{{Line{DrawPoint(), PointAt(arc, 0)}, arc, rest}, false};
    }
  }
}
inline Affine Moved(const Eigen::Matrix3d& linear, const Vec3& by) {
  Affine m;
  m.linear() = linear;
  m.translation() = by;
  return m;
}
inline Affine DrawSimilarity(double* scale) {
  *scale = Within(0.1, 5);
  const double mirror = *rc::gen::arbitrary<bool>() ? -1 : 1;
  const Eigen::Matrix3d linear = *scale * DrawRotation() * Vec3(1, 1, mirror).asDiagonal();
  return Moved(linear, DrawPoint());
}
inline Affine DrawStretch() {
  const Vec3 by(Within(0.3, 3), Within(0.3, 3), Within(0.3, 3));
  const Eigen::Matrix3d linear = DrawRotation() * by.asDiagonal() * DrawRotation();
  return Moved(linear, DrawPoint());
}
inline ::testing::AssertionResult Near(const Vec3& a, const Vec3& b, double tolerance) {
  if ((a - b).norm() <= tolerance) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << a.transpose() << " is not " << b.transpose();
}

// The outline of Fig. 6: a line, a half circle and a line, turned about z by quarters.
inline Curve Fig6Edge(const Vec3& from, const Vec3& along) {
  auto at = [&](double x, double z) { return Vec3(from + x * along + z * Vec3::UnitZ()); };
  const Arc arc = *ArcThrough(at(10, 0), at(15, 5), at(20, 0));
  return *JoinChain({Line{at(0, 0), at(10, 0)}, arc, Line{at(20, 0), at(30, 0)}});
}
inline std::vector<Curve> Fig6Edges() {
  return {Fig6Edge({0, 0, 0}, {1, 0, 0}), Fig6Edge({30, -30, 0}, {0, 1, 0}),
          Fig6Edge({30, -30, 0}, {-1, 0, 0}), Fig6Edge({0, 0, 0}, {0, -1, 0})};
}

}  // namespace tranos::geom
