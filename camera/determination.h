// SPDX-License-Identifier: GPL-3.0-or-later
// What the data determine, judged by the singular values of the linearised problem before any
// number is given out, and what trades off where they do not (LANGUAGE.md section 8, "Determined
// means").
#pragma once

#include <string>
#include <vector>

#include "camera/camera.h"

namespace tranos::camera {

// A column of the Jacobian. `scale` is the change that counts as large: for parameters with a limit
// the largest deviation with which one is called determined.
struct Quantity {
  enum class Kind {
    kLimited,   // determined below a deviation of `scale`: angles, f, aspect, principal point
    kPosition,  // by rank, or by its share where a limited one is not determined
    kUnknown,   // by rank
    kNuisance,  // asked for by nobody
  };
  Kind kind = Kind::kNuisance;
  double scale = 1;
  std::string term;          // in words; several may share one ("principal point")
  bool is_measured = false;  // an unknown whose own deviation, its `scale`, is among the data
  bool has_prior = false;    // a parameter of a camera of which something is assumed
};

// Limits: 2° for angles, 20 % of f, 0.2 of the aspect, 20 % of the frame's width for the principal
// point; a position in units of a tenth of its distance from what is seen.
std::vector<Quantity> QuantitiesOf(const Camera&, const Frame&, double distance_m);

struct Determination {
  std::vector<bool> by_data;      // by column
  std::vector<bool> with_priors;  // by column; follows from `by_data` where there are no priors
  int free_directions = 0;        // of the data: columns less rank
  int rank = 0;                   // with priors
  // Of all columns, with priors; those of columns that are still free are zero.
  Eigen::MatrixXd covariance;
  // The pseudo-inverse of the information Jᵀ J, of all columns: nothing is left out, so that what
  // is weak still takes its part in how the others hang on the data (shares, redundancies).
  Eigen::MatrixXd inverse_information;
  // A sentence for each group of quantities that the data leave open, what determined them told.
  std::vector<std::string> undetermined;
};

// `jacobian` by the quantities, whitened: its first `data_rows` of observations, then camera
// priors. Of the scaled singular values those above 1e-8 of the largest have rank; a quantity with
// a share above 1e-6 in a direction without rank is not determined.
Determination Determine(const Eigen::MatrixXd& jacobian, int data_rows,
                        const std::vector<Quantity>&);

}  // namespace tranos::camera
