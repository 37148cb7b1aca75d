// SPDX-License-Identifier: GPL-3.0-or-later
// The distributions that deviations and sums of squares are judged by, and normal numbers that are
// the same on every machine.
#pragma once

#include <cstdint>

namespace tranos::camera {

// The t below which Student's t with `dof` > 0 degrees of freedom falls with probability `p`,
// 0 < p < 1; the normal distribution's quantile for dof = infinity.
double StudentQuantile(double p, double dof);

// The probability that χ² with `dof` > 0 degrees of freedom exceeds `chi2`.
double ChiSquaredTail(double chi2, double dof);

// Numbers spread evenly in (0, 1): Steele, Lea and Flood's SplitMix64.
class UniformNumbers {
 public:
  explicit UniformNumbers(std::uint64_t seed) : state_(seed) {}
  double Next();

 private:
  std::uint64_t state_;
};

// Standard normal numbers, of these by Box and Muller.
class NormalNumbers {
 public:
  explicit NormalNumbers(std::uint64_t seed) : uniform_(seed) {}
  double Next();

 private:
  UniformNumbers uniform_;
};

}  // namespace tranos::camera
