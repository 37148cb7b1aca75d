// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/statistics.h"

#include <cmath>
#include <limits>

#include "geom/primitives.h"

namespace tranos::camera {

namespace {

constexpr int kTerms = 500;
constexpr double kTiny = 1e-300;

// The regularised incomplete beta function's continued fraction, by Lentz's method.
double BetaFraction(double a, double b, double x) {
  double c = 1, d = 1 / (1 - (a + b) * x / (a + 1)), value = d;
  for (int m = 1; m < kTerms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    for (const double term : {even, odd}) {
      d = 1 + term * d;
      d = 1 / (std::abs(d) < kTiny ? kTiny : d);
      c = 1 + term / c;
      c = std::abs(c) < kTiny ? kTiny : c;
      value *= c * d;
    }
    if (std::abs(c * d - 1) < 1e-16) break;
  }
  return value;
}

double IncompleteBeta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                a * std::log(x) + b * std::log1p(-x));
  // The fraction converges fast on this side of the mean.
  return x < (a + 1) / (a + b + 2) ? front * BetaFraction(a, b, x) / a
                                   : 1 - front * BetaFraction(b, a, 1 - x) / b;
}

double StudentBelow(double t, double dof) {
  if (std::isinf(dof)) return 0.5 * std::erfc(-t / std::sqrt(2.0));
  const double tail = 0.5 * IncompleteBeta(0.5 * dof, 0.5, dof / (dof + t * t));
  return t < 0 ? tail : 1 - tail;
}

}  // namespace

double StudentQuantile(double p, double dof) {
  double low = -1, high = 1;
  while (StudentBelow(low, dof) > p) low *= 2;
  while (StudentBelow(high, dof) < p) high *= 2;
  while (true) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) return middle;
    (StudentBelow(middle, dof) < p ? low : high) = middle;
  }
}

double ChiSquaredTail(double chi2, double dof) {
  if (!(chi2 > 0)) return 1;
  const double a = 0.5 * dof, x = 0.5 * chi2;
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {  // one less the series of the lower part
    double term = 1 / a, sum = term;
    for (int n = 1; n < 10000 && term > sum * 1e-17; ++n) sum += term *= x / (a + n);
    return 1 - front * sum;
  }
  double b = x + 1 - a, c = 1 / kTiny, d = 1 / b, value = d;
  for (int n = 1; n < 10000; ++n) {
    const double term = -n * (n - a);
    b += 2;
    d = 1 / (b + term * d);
    c = b + term / c;
    value *= c * d;
    if (std::abs(c * d - 1) < 1e-16) break;
  }
  return front * value;
}

double UniformNumbers::Next() {
  state_ += 0x9e3779b97f4a7c15u;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return (static_cast<double>(z >> 11) + 0.5) / 9007199254740992.0;
}

double NormalNumbers::Next() {
  const double radius = std::sqrt(-2 * std::log(uniform_.Next()));
  return radius * std::cos(2 * geom::kPi * uniform_.Next());
}

}  // namespace tranos::camera
