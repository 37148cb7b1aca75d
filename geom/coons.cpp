// SPDX-License-Identifier: GPL-3.0-or-later
// A Coons patch as rational Bézier patches. With W(u) the common denominator of south and north and
// V(v) that of west and east, the patch is a polynomial over W·V:
//   V·[(1−v)·A0 + v·A1] + W·[(1−u)·B0 + u·B1] − W·V·(bilinear of the corners),
// A0 = W·south and so on. So nothing is approximated, at the price of a higher degree.
#include <cmath>

#include "geom/surface_patches.h"

namespace tranos::geom {
namespace {

using Row = Eigen::Matrix<double, 1, Eigen::Dynamic>;
using Rows3 = Eigen::Matrix<double, 3, Eigen::Dynamic>;

double Binomial(int n, int k) {
  double value = 1;
  for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
  return value;
}

// The product of two polynomials given by Bernstein coefficients, one column each.
template <class A>
A Product(const A& a, const Row& b) {
  const int p = static_cast<int>(a.cols()) - 1, q = static_cast<int>(b.cols()) - 1;
  A product = A::Zero(a.rows(), p + q + 1);
  for (int i = 0; i <= p; ++i) {
    for (int j = 0; j <= q; ++j) {
      product.col(i + j) +=
          Binomial(p, i) * Binomial(q, j) / Binomial(p + q, i + j) * b(j) * a.col(i);
    }
  }
  return product;
}

// Two opposite edges over one denominator, with that denominator times 1 − x and times x;
// everything of one degree.
struct Pair {
  Rows3 low, high;
  Row rest, part;
};

Pair PairOf(const BezierSpan& low, const BezierSpan& high) {
  const int degree = std::max(DegreeOf(low.poles), DegreeOf(high.poles));
  const BezierPoles a = Elevated(low.poles, degree), b = Elevated(high.poles, degree);
  const Row wa = a.row(3), wb = b.row(3);
  const double scale = wa(0) / wb(0);
  Rows3 xa = a.topRows<3>(), xb = b.topRows<3>();
  Row weight = wa;
  if ((wa - scale * wb).cwiseAbs().maxCoeff() <= 1e-14 * wa.cwiseAbs().maxCoeff()) {
    xb *= scale;
  } else {
    xa = Product(xa, wb);
    xb = Product(xb, wa);
    weight = Product(wa, wb);
  }
  const Row one = Row::Ones(2);
  Row parameter(2);
  parameter << low.begin, low.end;
  return {Product(xa, one), Product(xb, one), Product(weight, Row(one - parameter)),
          Product(weight, parameter)};
}

BezierPatch PatchOf(const Pair& u, const Pair& v, const std::array<Vec3, 4>& corners) {
  const int count_u = static_cast<int>(u.low.cols()), count_v = static_cast<int>(v.low.cols());
  BezierPatch patch;
  patch.rows.assign(count_u, BezierPoles(4, count_v));
  for (int i = 0; i < count_u; ++i) {
    for (int j = 0; j < count_v; ++j) {
      const Vec3 blended = u.low.col(i) * v.rest(j) + u.high.col(i) * v.part(j) +
                           v.low.col(j) * u.rest(i) + v.high.col(j) * u.part(i);
      const Vec3 bilinear = u.rest(i) * (v.rest(j) * corners[0] + v.part(j) * corners[2]) +
                            u.part(i) * (v.rest(j) * corners[1] + v.part(j) * corners[3]);
      patch.rows[i].col(j).head<3>() = blended - bilinear;
      patch.rows[i](3, j) = (u.rest(i) + u.part(i)) * (v.rest(j) + v.part(j));
    }
  }
  return patch;
}

}  // namespace

PatchGrid PatchesOf(const CoonsPatch& coons) {
  PatchGrid grid;
  grid.breaks_u = UnitedBreaks(BreaksOf(coons.south), BreaksOf(coons.north));
  grid.breaks_v = UnitedBreaks(BreaksOf(coons.west), BreaksOf(coons.east));
  const auto south = SpansBetween(coons.south, grid.breaks_u);
  const auto north = SpansBetween(coons.north, grid.breaks_u);
  const auto west = SpansBetween(coons.west, grid.breaks_v);
  const auto east = SpansBetween(coons.east, grid.breaks_v);
  const std::array<Vec3, 4> corners = {coons.south.poles.front(), coons.south.poles.back(),
                                       coons.north.poles.front(), coons.north.poles.back()};
  for (std::size_t i = 0; i < south.size(); ++i) {
    const Pair u = PairOf(south[i], north[i]);
    for (std::size_t j = 0; j < west.size(); ++j) {
      grid.patches.push_back(PatchOf(u, PairOf(west[j], east[j]), corners));
    }
  }
  return grid;
}

}  // namespace tranos::geom
