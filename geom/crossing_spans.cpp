// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of spans whose hulls come near are halved until both are nearly straight, where Newton's
// method finds the one point they may share.
#include "geom/crossing_spans.h"

#include <algorithm>
#include <cmath>

#include "geom/crossing.h"

namespace tranos::geom {
namespace {

constexpr int kMostPairs = 20'000;  // curves that lie on one another would be halved for ever
constexpr double kStraight = 0.02;  // the hull's thickness by the chord

struct Part {
  double begin = 0, end = 1;  // of its span
  BezierPoles poles;

  double middle() const { return 0.5 * (begin + end); }
};

Box HullOf(const BezierPoles& poles) {
  Box box;
  for (int i = 0; i < poles.cols(); ++i) box.Add(Projected(poles.col(i)));
  return box;
}

double SizeOf(const Part& part) {
  const Box box = HullOf(part.poles);
  return (box.max - box.min).norm();
}

bool IsNearlyStraight(const Part& part) {
  const Vec3 start = Projected(part.poles.col(0));
  const Vec3 chord = Projected(part.poles.col(part.poles.cols() - 1)) - start;
  const double square = chord.squaredNorm();
  for (int i = 1; i + 1 < part.poles.cols(); ++i) {
    const Vec3 off = Projected(part.poles.col(i)) - start;
    const double along = off.dot(chord);
    if (off.cross(chord).norm() > kStraight * square || along < 0 || along > square) return false;
  }
  return true;
}

std::pair<Part, Part> Halved(const Part& part) {
  auto [left, right] = Split(part.poles, 0.5);
  return {{part.begin, part.middle(), std::move(left)},
          {part.middle(), part.end, std::move(right)}};
}

// Gauss's and Newton's method for the least |A(s) − B(t)|, damped where the two run in parallel.
std::optional<Vec3> Polished(const BezierPoles& a, double s, const BezierPoles& b, double t) {
  for (int i = 0; i < 60; ++i) {
    const CurveJet p = JetOf(a, s), q = JetOf(b, t);
    const Vec3 gap = p.point - q.point;
    const double aa = p.d1.squaredNorm(), bb = q.d1.squaredNorm(), ab = p.d1.dot(q.d1);
    const double damped = 1 + 1e-12;
    const double determinant = aa * bb * damped * damped - ab * ab;
    if (!(determinant > 0)) break;
    const double ga = gap.dot(p.d1), gb = -gap.dot(q.d1);
    const double next_s = std::clamp(s - (bb * damped * ga + ab * gb) / determinant, 0.0, 1.0);
    const double next_t = std::clamp(t - (aa * damped * gb + ab * ga) / determinant, 0.0, 1.0);
    const double moved = std::abs(next_s - s) + std::abs(next_t - t);
    s = next_s, t = next_t;
    if (moved < 1e-15) break;
  }
  const Vec3 p = JetOf(a, s).point;
  if (!((p - JetOf(b, t).point).norm() <= kMeeting_m)) return std::nullopt;
  return p;
}

bool MayMeet(const Part& a, const Part& b) {
  const Box p = HullOf(a.poles), q = HullOf(b.poles);
  return ((p.min - q.max).array() <= kMeeting_m).all() &&
         ((q.min - p.max).array() <= kMeeting_m).all();
}

void MeetSpans(const BezierPoles& a, const BezierPoles& b, std::vector<Vec3>& points) {
  std::vector<std::pair<Part, Part>> open = {{Part{0, 1, a}, Part{0, 1, b}}};
  for (int count = 0; !open.empty() && count < kMostPairs; ++count) {
    const auto [p, q] = std::move(open.back());
    open.pop_back();
    if (!MayMeet(p, q)) continue;
    const bool halve_p = !IsNearlyStraight(p), halve_q = !IsNearlyStraight(q);
    const double size_p = SizeOf(p), size_q = SizeOf(q);
    if ((!halve_p && !halve_q) || std::max(size_p, size_q) <= kMeeting_m) {
      const auto point = Polished(a, p.middle(), b, q.middle());
      const auto is_near = [&](const Vec3& known) { return (known - *point).norm() <= kMeeting_m; };
      if (point && std::none_of(points.begin(), points.end(), is_near)) points.push_back(*point);
      continue;
    }
    if (halve_p && (!halve_q || size_p >= size_q)) {
      auto [left, right] = Halved(p);
      open.emplace_back(std::move(left), q);
      open.emplace_back(std::move(right), q);
    } else {
      auto [left, right] = Halved(q);
      open.emplace_back(p, std::move(left));
      open.emplace_back(p, std::move(right));
    }
  }
}

}  // namespace

std::vector<Vec3> MeetBySpans(const std::vector<BezierSpan>& a, const std::vector<BezierSpan>& b) {
  std::vector<Vec3> points;
  for (const BezierSpan& span : a) {
    for (const BezierSpan& other : b) MeetSpans(span.poles, other.poles, points);
  }
  return points;
}

}  // namespace tranos::geom
