// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/bezier.h"

#include <algorithm>
#include <cmath>

#include "geom/arc.h"

namespace tranos::geom {

HomogeneousJet HomogeneousJetOf(const BezierPoles& poles, double s) {
  const int degree = DegreeOf(poles);
  BezierPoles work = poles;
  for (int level = degree; level > 2; --level) {
    for (int i = 0; i < level; ++i) work.col(i) += s * (work.col(i + 1) - work.col(i));
  }
  HomogeneousJet jet;
  if (degree >= 2) {
    jet.d2 = degree * (degree - 1.0) * (work.col(2) - 2 * work.col(1) + work.col(0));
    for (int i = 0; i < 2; ++i) work.col(i) += s * (work.col(i + 1) - work.col(i));
  }
  jet.d1 = degree * (work.col(1) - work.col(0));
  jet.point = (1 - s) * work.col(0) + s * work.col(1);
  return jet;
}

CurveJet Project(const HomogeneousJet& h) {
  CurveJet jet;
  const double w = h.point.w();
  jet.point = h.point.head<3>() / w;
  jet.d1 = (h.d1.head<3>() - h.d1.w() * jet.point) / w;
  jet.d2 = (h.d2.head<3>() - h.d2.w() * jet.point - 2 * h.d1.w() * jet.d1) / w;
  return jet;
}

CurveJet JetOf(const BezierPoles& poles, double s) { return Project(HomogeneousJetOf(poles, s)); }

std::pair<BezierPoles, BezierPoles> Split(const BezierPoles& poles, double s) {
  const int degree = DegreeOf(poles);
  BezierPoles left = poles, right = poles;
  for (int level = degree; level > 0; --level) {
    left.col(degree - level) = right.col(0);
    for (int i = 0; i < level; ++i) right.col(i) += s * (right.col(i + 1) - right.col(i));
  }
  left.col(degree) = right.col(0);
  return {left, right};
}

BezierPoles Elevated(const BezierPoles& poles, int degree) {
  BezierPoles raised = poles;
  while (DegreeOf(raised) < degree) {
    const int n = DegreeOf(raised) + 1;
    BezierPoles next(4, n + 1);
    next.col(0) = raised.col(0);
    next.col(n) = raised.col(n - 1);
    for (int i = 1; i < n; ++i) {
      const double part = static_cast<double>(i) / n;
      next.col(i) = part * raised.col(i - 1) + (1 - part) * raised.col(i);
    }
    raised = next;
  }
  return raised;
}

bool HasSoundShape(const BsplineCurve& c) {
  const auto poles = c.poles.size();
  return c.degree >= 1 && c.degree <= kMaxDegree && poles > static_cast<std::size_t>(c.degree) &&
         c.knots.size() == poles + c.degree + 1 && (c.weights.empty() || c.weights.size() == poles);
}

int KnotSpanAt(const std::vector<double>& knots, int degree, double u) {
  const int last = static_cast<int>(knots.size()) - degree - 2;
  const auto after = std::upper_bound(knots.begin() + degree, knots.begin() + last + 1, u);
  int k = std::clamp(static_cast<int>(after - knots.begin()) - 1, degree, last);
  while (k > degree && !(knots[k] < knots[k + 1])) --k;
  return k;
}

BezierPoles ControlOf(const BsplineCurve& c, int knot_index) {
  BezierPoles control(4, c.degree + 1);
  for (int j = 0; j <= c.degree; ++j) {
    const int i = knot_index - c.degree + j;
    control.col(j) = Homogeneous(c.poles[i], c.weights.empty() ? 1.0 : c.weights[i]);
  }
  return control;
}

BezierPoles BezierOver(const std::vector<double>& knots, int knot_index, const BezierPoles& control,
                       double a, double b) {
  const int p = DegreeOf(control);
  BezierPoles out(4, p + 1), work(4, p + 1);
  // Pole m is the blossom with b taken m times and a taken p - m times.
  for (int m = 0; m <= p; ++m) {
    work = control;
    for (int r = 1; r <= p; ++r) {
      const double argument = r <= p - m ? a : b;
      for (int j = p; j >= r; --j) {
        const double low = knots[knot_index - p + j], high = knots[knot_index + j - r + 1];
        const double part = (argument - low) / (high - low);
        work.col(j) = (1 - part) * work.col(j - 1) + part * work.col(j);
      }
    }
    out.col(m) = work.col(p);
  }
  return out;
}

std::vector<BezierSpan> BezierSpansOf(const BsplineCurve& c) {
  std::vector<BezierSpan> spans;
  if (!HasSoundShape(c)) return spans;
  const int last = static_cast<int>(c.poles.size());
  const double first = c.knots[c.degree], range = c.knots[last] - first;
  for (int k = c.degree; k < last; ++k) {
    if (!(c.knots[k] < c.knots[k + 1])) continue;
    spans.push_back({(c.knots[k] - first) / range, (c.knots[k + 1] - first) / range,
                     BezierOver(c.knots, k, ControlOf(c, k), c.knots[k], c.knots[k + 1])});
  }
  return spans;
}

BezierSpan BezierSpanAt(const BsplineCurve& c, double t) {
  const int last = static_cast<int>(c.poles.size());
  const double first = c.knots[c.degree], range = c.knots[last] - first;
  const int k = KnotSpanAt(c.knots, c.degree, first + t * range);
  return {(c.knots[k] - first) / range, (c.knots[k + 1] - first) / range,
          BezierOver(c.knots, k, ControlOf(c, k), c.knots[k], c.knots[k + 1])};
}

std::vector<BezierSpan> BezierSpansOf(const Arc& arc) {
  const int count = static_cast<int>(std::clamp(PartsOf(arc.sweep_rad, 0.5 * kPi), 1.0, 4.0));
  const double half = 0.5 * arc.sweep_rad / count;
  // A right angle's middle weight is √½ to the last bit, which a cosine of π/4 is not always.
  const double weight = std::abs(half - 0.25 * kPi) < 1e-15 ? std::sqrt(0.5) : std::cos(half);
  std::vector<BezierSpan> spans(count);
  for (int i = 0; i < count; ++i) {
    const double from = arc.sweep_rad * i / count, to = arc.sweep_rad * (i + 1) / count;
    const CosSin a = ExactCosSin(from), b = ExactCosSin(to);
    // The tangents' meeting point is (e_a + e_b) / (1 + e_a·e_b) from the centre.
    const double scale = arc.radius / (1 + a.cos * b.cos + a.sin * b.sin);
    const Vec3 tip =
        arc.frame.origin + scale * ((a.cos + b.cos) * arc.frame.x + (a.sin + b.sin) * arc.frame.y);
    spans[i].begin = static_cast<double>(i) / count;
    spans[i].end = static_cast<double>(i + 1) / count;
    spans[i].poles.resize(4, 3);
    spans[i].poles.col(0) = Homogeneous(PointAtAngle(arc, from), 1);
    spans[i].poles.col(1) = Homogeneous(tip, weight);
    spans[i].poles.col(2) = Homogeneous(PointAtAngle(arc, to), 1);
  }
  return spans;
}

BsplineCurve JoinSpans(const std::vector<BezierSpan>& spans) {
  BsplineCurve joined;
  if (spans.empty()) return joined;
  for (const BezierSpan& span : spans)
    joined.degree = std::max(joined.degree, DegreeOf(span.poles));
  joined.knots.assign(joined.degree + 1, 0.0);
  bool rational = false;
  double scale = 1;
  for (std::size_t i = 0; i < spans.size(); ++i) {
    const BezierPoles poles = Elevated(spans[i].poles, joined.degree);
    scale = i == 0 ? 1 / poles(3, 0) : joined.weights.back() / poles(3, 0);
    for (int j = i == 0 ? 0 : 1; j <= joined.degree; ++j) {
      joined.poles.push_back(Projected(poles.col(j)));
      joined.weights.push_back(scale * poles(3, j));
      rational = rational || joined.weights.back() != 1;
    }
    const int multiplicity = i + 1 < spans.size() ? joined.degree : joined.degree + 1;
    joined.knots.insert(joined.knots.end(), multiplicity, static_cast<double>(i + 1));
  }
  if (!rational) joined.weights.clear();
  return joined;
}

}  // namespace tranos::geom
