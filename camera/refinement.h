// SPDX-License-Identifier: GPL-3.0-or-later
// The joint adjustment of cameras, unknowns and facades to everything traced, through Ceres.
#pragma once

#include <functional>
#include <optional>

#include "camera/adjustment.h"

namespace tranos::camera {

// The numbers that traces stand on, for values of the unknowns, with their derivatives there.
using NumbersOfUnknowns = std::function<geom::Result<Numbers>(const Eigen::VectorXd& unknowns)>;

enum class Loss {
  kNone,
  kHuber,   // χ up to 1.345 deviations of a trace's residuals, linear from there
  kCauchy,  // χ² grows like a logarithm from 2.385 deviations
};

struct RefineOptions {
  Loss loss = Loss::kNone;
  double noise_scale = 1;          // deviations of dots in units of the stated ones
  std::optional<double> skew_rad;  // held, in the first photograph
  bool is_rough = false;  // until χ² falls by less than 1e-4 of itself: to compare starts
};

struct Refined {
  Eigen::VectorXd state;        // as Layout has it
  Numbers numbers;              // there
  double chi2 = 0;              // of all rows, before the robust loss
  double cost = 0;              // Σ ρ, what was made least; χ² where there is no loss
  std::vector<double> weights;  // by Layout::traces: 1, or how far the robust loss trusts a trace
  std::vector<bool> at_bound;   // by unknown
  bool converged = false;
};

// The state of least cost near `start`. `numbers_of` is called at most once for each point and is
// told as the error where it fails at the start; elsewhere its failure makes the step shorter.
// Unknowns outside their bounds start at them. Single-threaded; the same input gives the same bits.
// Errors: kDegenerate, where the start has no image; what `numbers_of` told.
geom::Result<Refined> Refine(std::span<const Photograph>, std::span<const Unknown>, const Layout&,
                             const NumbersOfUnknowns& numbers_of, const Eigen::VectorXd& start,
                             const RefineOptions& = {});

}  // namespace tranos::camera
