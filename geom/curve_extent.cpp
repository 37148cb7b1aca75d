// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes and nearest points of lines and of B-splines; arcs are in arc.cpp.
#include <cmath>
#include <queue>

#include "geom/curve_pieces.h"

namespace tranos::geom {
namespace {

constexpr int kMaxNodes = 20'000;

double Largest(const BezierPoles& poles, int axis, double sign) {
  double largest = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < poles.cols(); ++i) {
    largest = std::max(largest, sign * poles(axis, i) / poles(3, i));
  }
  return largest;
}

// Raises `best` to the largest of sign·coordinate over the curve: parts whose poles stay below
// what is already reached are left out, the others are halved.
void RaiseToLargest(const BezierPoles& poles, int axis, double sign, double slack, double& best) {
  std::vector<BezierPoles> open{poles};
  for (int nodes = 0; !open.empty(); ++nodes) {
    const BezierPoles part = open.back();
    open.pop_back();
    const double bound = Largest(part, axis, sign);
    if (!(bound > best + slack)) continue;
    if (nodes > kMaxNodes) {
      best = bound;
      continue;
    }
    auto [left, right] = Split(part, 0.5);
    best = std::max({best, sign * left(axis, 0) / left(3, 0), sign * right(axis, 0) / right(3, 0),
                     sign * right(axis, right.cols() - 1) / right(3, right.cols() - 1)});
    open.push_back(std::move(left));
    open.push_back(std::move(right));
  }
}

// Newton's method for (C(s) − p)·C'(s) = 0 from s, kept in [0, 1].
double PolishedParameter(const BezierPoles& poles, const Vec3& p, double s) {
  for (int i = 0; i < 30; ++i) {
    const CurveJet jet = JetOf(poles, s);
    const Vec3 off = jet.point - p;
    const double slope = off.dot(jet.d1);
    double bend = jet.d1.squaredNorm() + off.dot(jet.d2);
    if (!(bend > 0)) bend = jet.d1.squaredNorm();
    if (!(bend > 0)) break;
    const double next = std::clamp(s - slope / bend, 0.0, 1.0);
    if (std::abs(next - s) < 1e-16) break;
    s = next;
  }
  return s;
}

// A part of a span, and a distance below which no point of it comes.
struct Part {
  double at_least_m;
  double begin, end;
  BezierPoles poles;
  bool operator<(const Part& other) const { return at_least_m > other.at_least_m; }
};

// The distance from p to the chord, less the distance of the farthest pole from the chord.
double LowerBound(const BezierPoles& poles, const Vec3& p) {
  const Line chord{Projected(poles.col(0)), Projected(poles.col(poles.cols() - 1))};
  double thickness_m = 0;
  for (int i = 1; i + 1 < poles.cols(); ++i) {
    thickness_m = std::max(thickness_m, NearestOn(chord, Projected(poles.col(i))).distance_m);
  }
  return NearestOn(chord, p).distance_m - thickness_m;
}

}  // namespace

Box BoxOf(const Line& line) {
  Box box;
  box.Add(line.start);
  box.Add(line.end);
  return box;
}

Box BoxOf(const BsplineCurve& curve) {
  Box box, hull;
  const std::vector<BezierSpan> spans = BezierSpansOf(curve);
  for (const Vec3& p : curve.poles) hull.Add(p);
  for (const BezierSpan& span : spans) {
    box.Add(Projected(span.poles.col(0)));
    box.Add(Projected(span.poles.col(span.poles.cols() - 1)));
  }
  if (spans.empty()) return box;
  const double size = (hull.max - hull.min).norm() + hull.centre().norm();
  const double slack = std::min(1e-10, 1e-14 * size) + 4e-16 * size;
  for (int axis = 0; axis < 3; ++axis) {
    double highest = box.max[axis], lowest = -box.min[axis];
    for (const BezierSpan& span : spans) {
      RaiseToLargest(span.poles, axis, 1, slack, highest);
      RaiseToLargest(span.poles, axis, -1, slack, lowest);
    }
    box.max[axis] = highest;
    box.min[axis] = -lowest;
  }
  return box;
}

Nearest NearestOn(const Line& line, const Vec3& p) {
  const Vec3 along = line.end - line.start;
  const double square = along.squaredNorm();
  Nearest nearest;
  nearest.t = square > 0 ? std::clamp((p - line.start).dot(along) / square, 0.0, 1.0) : 0.0;
  nearest.point = JetOf(line, nearest.t).point;
  nearest.distance_m = (nearest.point - p).norm();
  return nearest;
}

Nearest NearestOn(const BsplineCurve& curve, const Vec3& p) {
  const std::vector<BezierSpan> spans = BezierSpansOf(curve);
  Nearest best;
  best.distance_m = std::numeric_limits<double>::infinity();
  auto offer = [&](const Part& part, double s) {
    const Vec3 point = JetOf(part.poles, s).point;
    const double distance_m = (point - p).norm();
    if (distance_m < best.distance_m) {
      best = {point, distance_m, part.begin + s * (part.end - part.begin)};
    }
  };
  std::priority_queue<Part> open;
  double size = 0;
  for (const BezierSpan& span : spans) {
    open.push({LowerBound(span.poles, p), span.begin, span.end, span.poles});
    size = std::max(size, (Projected(span.poles.col(0)) - p).norm());
  }
  for (int nodes = 0; !open.empty() && nodes < kMaxNodes; ++nodes) {
    const Part part = open.top();
    open.pop();
    if (part.at_least_m >= best.distance_m - 1e-13 * size) break;
    offer(part, 0);
    offer(part, 1);
    offer(part, PolishedParameter(part.poles, p, 0.5));
    const double middle = 0.5 * (part.begin + part.end);
    if (!(part.begin < middle && middle < part.end)) continue;
    auto [left, right] = Split(part.poles, 0.5);
    open.push({LowerBound(left, p), part.begin, middle, std::move(left)});
    open.push({LowerBound(right, p), middle, part.end, std::move(right)});
  }
  return best;
}

Nearest NearestPoint(const Curve& curve, const Vec3& p) {
  Nearest best;
  if (!Check(curve) || !p.allFinite()) return best;
  best.distance_m = std::numeric_limits<double>::infinity();
  ForEachPiece(curve, [&](const auto& piece, double t0, double t1) {
    Nearest nearest = NearestOn(piece, p);
    if (!(nearest.distance_m < best.distance_m)) return;
    nearest.t = t0 + nearest.t * (t1 - t0);
    best = nearest;
  });
  return best;
}

}  // namespace tranos::geom
