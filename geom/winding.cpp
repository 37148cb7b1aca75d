// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/winding.h"

#include <cmath>

#include "geom/curve_pieces.h"

namespace tranos::geom {
namespace {

constexpr int kDeepest = 60;

// The angle under which a chord is seen from the origin, from -π to π.
double SeenFromOrigin(const Vec2& a, const Vec2& b) {
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
}

class Turning {
 public:
  Turning(const Frame& plane, const Vec3& p) : plane_{p, plane.x, plane.y} {}

  double angle() const { return angle_; }

  void Add(const Line& line) { angle_ += SeenFromOrigin(Flat(line.start), Flat(line.end)); }
  template <class Piece>
  void Add(const Piece& piece) {
    for (const BezierSpan& span : BezierSpansOf(piece)) Add(span.poles, kDeepest);
  }

 private:
  Vec2 Flat(const Vec3& p) const { return plane_.ToLocal(p).head<2>(); }

  // A span whose poles all lie to one side of the origin turns as its chord does.
  void Add(const BezierPoles& poles, int depth) {
    const Vec2 a = Flat(Projected(poles.col(0)));
    const Vec2 b = Flat(Projected(poles.col(poles.cols() - 1)));
    if (depth == 0 || LiesToOneSide(poles)) {
      angle_ += SeenFromOrigin(a, b);
      return;
    }
    const auto [left, right] = Split(poles, 0.5);
    Add(left, depth - 1);
    Add(right, depth - 1);
  }

  bool LiesToOneSide(const BezierPoles& poles) const {
    Vec2 middle = Vec2::Zero();
    for (int i = 0; i < poles.cols(); ++i) middle += Flat(Projected(poles.col(i)));
    for (int i = 0; i < poles.cols(); ++i) {
      if (!(Flat(Projected(poles.col(i))).dot(middle) > 0)) return false;
    }
    return true;
  }

  Frame plane_;
  double angle_ = 0;
};

}  // namespace

int WindingNumber(const Curve& curve, const Frame& plane, const Vec3& p) {
  Turning turning(plane, p);
  ForEachPiece(curve, [&](const auto& piece, double, double) { turning.Add(piece); });
  return static_cast<int>(std::lround(turning.angle() / (2 * kPi)));
}

std::vector<Vec3> SpanningPoints(const Curve& curve) {
  std::vector<Vec3> points;
  ForEachPiece(curve, Overloaded{[&](const Line& l, double, double) {
                                   points.push_back(l.start);
                                   points.push_back(l.end);
                                 },
                                 [&](const Arc& a, double, double) {
                                   for (int i = 0; i <= 4; ++i)
                                     points.push_back(JetOf(a, 0.25 * i).point);
                                 },
                                 [&](const BsplineCurve& b, double, double) {
                                   points.insert(points.end(), b.poles.begin(), b.poles.end());
                                 }});
  return points;
}

}  // namespace tranos::geom
