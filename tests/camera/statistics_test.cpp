// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tranos::camera {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Statistics, StudentsQuantilesInClosedForm) {
  for (const double p : {0.6, 0.9, 0.975, 0.999}) {
    // One degree of freedom is Cauchy's distribution, two have a square root.
    EXPECT_NEAR(StudentQuantile(p, 1), std::tan(M_PI * (p - 0.5)), 1e-9 * StudentQuantile(p, 1));
    EXPECT_NEAR(StudentQuantile(p, 2), (2 * p - 1) * std::sqrt(1 / (2 * p * (1 - p))), 1e-10);
    EXPECT_NEAR(StudentQuantile(1 - p, 7), -StudentQuantile(p, 7), 1e-10);
  }
  EXPECT_NEAR(StudentQuantile(0.5 * std::erfc(-1.0), kInfinity), std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(StudentQuantile(0.975, 1e7), StudentQuantile(0.975, kInfinity), 1e-5);
}

TEST(Statistics, ChiSquaredTailsInClosedForm) {
  for (const double x : {0.1, 1.0, 3.0, 10.0, 40.0}) {
    EXPECT_NEAR(ChiSquaredTail(x, 2), std::exp(-x / 2), 1e-13);
    EXPECT_NEAR(ChiSquaredTail(x, 1), std::erfc(std::sqrt(x / 2)), 1e-13);
    EXPECT_NEAR(ChiSquaredTail(x, 4), std::exp(-x / 2) * (1 + x / 2), 1e-13);
  }
}

TEST(Statistics, NormalNumbersHaveTheirMomentsAndRepeat) {
  NormalNumbers numbers(7), again(7), other(8);
  double sum = 0, squares = 0, quartics = 0;
  const int n = 100000;
  for (int i = 0; i < n; ++i) {
    const double x = numbers.Next();
    EXPECT_EQ(x, again.Next());
    EXPECT_NE(x, other.Next());
    sum += x, squares += x * x, quartics += x * x * x * x;
  }
  EXPECT_NEAR(sum / n, 0, 4 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1, 4 * std::sqrt(2.0 / n));
  EXPECT_NEAR(quartics / n, 3, 4 * std::sqrt(96.0 / n));
}

}  // namespace
}  // namespace tranos::camera
