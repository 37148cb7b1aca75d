// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/surface_patches.h"

#include <algorithm>
#include <cmath>

namespace tranos::geom {
namespace {

Vec4 HomogeneousPole(const BsplineSurface& s, int i, int j) {
  const std::size_t k = static_cast<std::size_t>(i) * s.count_v + j;
  return Homogeneous(s.poles[k], s.weights.empty() ? 1.0 : s.weights[k]);
}

// Along u each column of poles is cut to the knot span, then each row of the result along v.
BezierPatch PatchOver(const BsplineSurface& s, int ku, int kv) {
  BezierPatch patch;
  patch.rows.assign(s.degree_u + 1, BezierPoles(4, s.degree_v + 1));
  BezierPoles column(4, s.degree_u + 1);
  for (int j = 0; j <= s.degree_v; ++j) {
    for (int i = 0; i <= s.degree_u; ++i) {
      column.col(i) = HomogeneousPole(s, ku - s.degree_u + i, kv - s.degree_v + j);
    }
    const BezierPoles cut = BezierOver(s.knots_u, ku, column, s.knots_u[ku], s.knots_u[ku + 1]);
    for (int i = 0; i <= s.degree_u; ++i) patch.rows[i].col(j) = cut.col(i);
  }
  for (BezierPoles& row : patch.rows) {
    row = BezierOver(s.knots_v, kv, row, s.knots_v[kv], s.knots_v[kv + 1]);
  }
  return patch;
}

std::vector<int> SpanIndices(const std::vector<double>& knots, int degree) {
  std::vector<int> indices;
  for (int k = degree; k + degree + 1 < static_cast<int>(knots.size()); ++k) {
    if (knots[k] < knots[k + 1]) indices.push_back(k);
  }
  return indices;
}

double Natural(const std::vector<double>& knots, double knot) {
  return (knot - knots.front()) / (knots.back() - knots.front());
}

std::vector<double> BreaksOf(const std::vector<double>& knots, const std::vector<int>& spans) {
  std::vector<double> breaks;
  for (const int k : spans) breaks.push_back(Natural(knots, knots[k]));
  breaks.push_back(1);
  return breaks;
}

}  // namespace

SurfaceJet JetOf(const BezierPatch& patch, double s, double t) {
  const int count = static_cast<int>(patch.rows.size());
  BezierPoles at(4, count), d1(4, count), d2(4, count);
  for (int i = 0; i < count; ++i) {
    const HomogeneousJet jet = HomogeneousJetOf(patch.rows[i], t);
    at.col(i) = jet.point;
    d1.col(i) = jet.d1;
    d2.col(i) = jet.d2;
  }
  const HomogeneousJet h = HomogeneousJetOf(at, s), hv = HomogeneousJetOf(d1, s);
  const Vec4 hvv = HomogeneousJetOf(d2, s).point;
  const double w = h.point.w();
  SurfaceJet jet;
  jet.point = h.point.head<3>() / w;
  jet.du = (h.d1.head<3>() - h.d1.w() * jet.point) / w;
  jet.dv = (hv.point.head<3>() - hv.point.w() * jet.point) / w;
  jet.duu = (h.d2.head<3>() - h.d2.w() * jet.point - 2 * h.d1.w() * jet.du) / w;
  jet.dvv = (hvv.head<3>() - hvv.w() * jet.point - 2 * hv.point.w() * jet.dv) / w;
  jet.duv =
      (hv.d1.head<3>() - hv.d1.w() * jet.point - h.d1.w() * jet.dv - hv.point.w() * jet.du) / w;
  return jet;
}

Vec3 PointOf(const BezierPatch& patch, double s, double t) {
  const int count = static_cast<int>(patch.rows.size());
  BezierPoles at(4, count);
  for (int i = 0; i < count; ++i) at.col(i) = HomogeneousJetOf(patch.rows[i], t).point;
  return Projected(HomogeneousJetOf(at, s).point);
}

BezierPoles ColumnOf(const BezierPatch& patch, int j) {
  BezierPoles column(4, static_cast<int>(patch.rows.size()));
  for (int i = 0; i < column.cols(); ++i) column.col(i) = patch.rows[i].col(j);
  return column;
}

BezierPatch SplitOff(const BezierPatch& patch, bool along_u, bool upper_half) {
  BezierPatch half = patch;
  if (!along_u) {
    for (BezierPoles& row : half.rows) {
      auto [low, high] = Split(row, 0.5);
      row = upper_half ? high : low;
    }
    return half;
  }
  for (int j = 0; j < patch.rows[0].cols(); ++j) {
    const auto [low, high] = Split(ColumnOf(patch, j), 0.5);
    for (std::size_t i = 0; i < half.rows.size(); ++i) {
      half.rows[i].col(j) = (upper_half ? high : low).col(static_cast<int>(i));
    }
  }
  return half;
}

PatchGrid PatchesOf(const Surface& surface) {
  PatchGrid grid;
  if (!Check(surface)) return grid;
  if (const auto* coons = std::get_if<CoonsPatch>(&surface)) return PatchesOf(*coons);
  const auto& s = std::get<BsplineSurface>(surface);
  const std::vector<int> spans_u = SpanIndices(s.knots_u, s.degree_u);
  const std::vector<int> spans_v = SpanIndices(s.knots_v, s.degree_v);
  grid.breaks_u = BreaksOf(s.knots_u, spans_u);
  grid.breaks_v = BreaksOf(s.knots_v, spans_v);
  grid.patches.reserve(spans_u.size() * spans_v.size());
  for (const int ku : spans_u) {
    for (const int kv : spans_v) grid.patches.push_back(PatchOver(s, ku, kv));
  }
  return grid;
}

Located PatchAt(const BsplineSurface& surface, double u, double v) {
  auto place = [](const std::vector<double>& knots, int degree, double t) {
    const double knot = knots.front() + t * (knots.back() - knots.front());
    const int k = KnotSpanAt(knots, degree, knot);
    const double local = (knot - knots[k]) / (knots[k + 1] - knots[k]);
    return std::pair(k, local > 0 ? std::min(local, 1.0) : 0.0);
  };
  const auto [ku, s] = place(surface.knots_u, surface.degree_u, u);
  const auto [kv, t] = place(surface.knots_v, surface.degree_v, v);
  return {PatchOver(surface, ku, kv), s, t};
}

std::vector<double> BreaksOf(const BsplineCurve& c) {
  return BreaksOf(c.knots, SpanIndices(c.knots, c.degree));
}

std::vector<double> UnitedBreaks(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> all(a), united;
  all.insert(all.end(), b.begin(), b.end());
  std::sort(all.begin(), all.end());
  for (const double t : all) {
    if (united.empty() || t - united.back() > 1e-12) united.push_back(t);
  }
  united.back() = 1;
  return united;
}

std::vector<BezierSpan> SpansBetween(const BsplineCurve& c, const std::vector<double>& breaks) {
  std::vector<BezierSpan> spans;
  const double first = c.knots.front(), range = c.knots.back() - first;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double a = first + breaks[i] * range, b = first + breaks[i + 1] * range;
    const int k = KnotSpanAt(c.knots, c.degree, 0.5 * (a + b));
    // A break within rounding of a knot is the knot.
    auto snap = [&](double t) {
      if (std::abs(t - c.knots[k]) <= 1e-11 * range) return c.knots[k];
      return std::abs(t - c.knots[k + 1]) <= 1e-11 * range ? c.knots[k + 1] : t;
    };
    spans.push_back(
        {breaks[i], breaks[i + 1], BezierOver(c.knots, k, ControlOf(c, k), snap(a), snap(b))});
  }
  return spans;
}

}  // namespace tranos::geom
