// SPDX-License-Identifier: GPL-3.0-or-later
// Adaptive Gauss-Legendre quadrature in one and two variables. Internal to geom.
#pragma once

#include <array>
#include <cmath>

namespace tranos::geom {

struct GaussNode {
  double x, weight;
};

// The positive half of the rules on [-1, 1].
inline constexpr std::array<GaussNode, 4> kGauss8 = {{
    {0.9602898564975362872, 0.1012285362903762587},
    {0.7966664774136267280, 0.2223810344533744821},
    {0.5255324099163289908, 0.3137066458778872691},
    {0.1834346424956498078, 0.3626837833783619902},
}};
inline constexpr std::array<GaussNode, 8> kGauss16 = {{
    {0.9894009349916499385, 0.0271524594117540964},
    {0.9445750230732326003, 0.0622535239386478936},
    {0.8656312023878317552, 0.0951585116824927857},
    {0.7554044083550029987, 0.1246289712555338769},
    {0.6178762444026437706, 0.1495959888165767360},
    {0.4580167776572273697, 0.1691565193950025359},
    {0.2816035507792589154, 0.1826034150449235838},
    {0.0950125098376374405, 0.1894506104550685022},
}};

// The 16-point rule over [a, b]; Value is a double or a vector that `f` returns.
template <class F>
auto Gauss16(const F& f, double a, double b) {
  const double centre = 0.5 * (a + b), half = 0.5 * (b - a);
  auto at = [&](double x) -> decltype(f(x)) { return f(centre + half * x); };
  decltype(f(a)) sum = kGauss16[0].weight * (at(kGauss16[0].x) + at(-kGauss16[0].x));
  for (std::size_t i = 1; i < kGauss16.size(); ++i) {
    sum += kGauss16[i].weight * (at(kGauss16[i].x) + at(-kGauss16[i].x));
  }
  sum *= half;
  return sum;
}

// ∫ f over [a, b] to the absolute tolerance; halves an interval until its rule agrees with
// those of its halves. `depth` bounds the work where the integrand is wild.
template <class F>
double IntegrateAdaptively(const F& f, double a, double b, double whole, double tolerance,
                           int depth) {
  const double middle = 0.5 * (a + b);
  const double left = Gauss16(f, a, middle), right = Gauss16(f, middle, b);
  if (depth <= 0 || !(std::abs(left + right - whole) > tolerance)) return left + right;
  return IntegrateAdaptively(f, a, middle, left, tolerance, depth - 1) +
         IntegrateAdaptively(f, middle, b, right, tolerance, depth - 1);
}

template <class F>
double Integrate(const F& f, double a, double b, double relative_tolerance = 1e-13) {
  const double whole = Gauss16(f, a, b);
  return IntegrateAdaptively(f, a, b, whole, relative_tolerance * std::abs(whole), 30);
}

struct Cell {
  double u0, u1, v0, v1;
  Cell Quarter(int k) const {
    const double u = 0.5 * (u0 + u1), v = 0.5 * (v0 + v1);
    return {k & 1 ? u : u0, k & 1 ? u1 : u, k & 2 ? v : v0, k & 2 ? v1 : v};
  }
};

// The 8 × 8 rule over the cell.
template <class F>
double Gauss8Squared(const F& f, const Cell& cell) {
  const double cu = 0.5 * (cell.u0 + cell.u1), hu = 0.5 * (cell.u1 - cell.u0);
  const double cv = 0.5 * (cell.v0 + cell.v1), hv = 0.5 * (cell.v1 - cell.v0);
  double sum = 0;
  for (const GaussNode& i : kGauss8) {
    for (const GaussNode& j : kGauss8) {
      const double u = hu * i.x, v = hv * j.x;
      sum += i.weight * j.weight *
             (f(cu - u, cv - v) + f(cu + u, cv - v) + f(cu - u, cv + v) + f(cu + u, cv + v));
    }
  }
  return sum * hu * hv;
}

// ∫∫ f over the cell to about the absolute tolerance, quartering where the rule disagrees with
// its quarters; `cells_left` bounds the work.
template <class F>
double IntegrateAdaptively(const F& f, const Cell& cell, double whole, double tolerance,
                           long& cells_left) {
  std::array<double, 4> quarters;
  double sum = 0;
  for (int k = 0; k < 4; ++k) sum += quarters[k] = Gauss8Squared(f, cell.Quarter(k));
  cells_left -= 4;
  if (cells_left <= 0 || !(std::abs(sum - whole) > tolerance)) return sum;
  double refined = 0;
  for (int k = 0; k < 4; ++k) {
    refined += IntegrateAdaptively(f, cell.Quarter(k), quarters[k], tolerance, cells_left);
  }
  return refined;
}

}  // namespace tranos::geom
