// SPDX-License-Identifier: GPL-3.0-or-later
// From an adjusted state to what is told of it: deviations, shares, residuals, what is open.
#pragma once

#include <span>

#include "camera/determination.h"
#include "camera/estimate.h"
#include "camera/refinement.h"

namespace tranos::camera {

struct Determined {
  Determination determination;
  // Weighted as the robust loss has it, which is how the estimate hangs on each row.
  Eigen::MatrixXd jacobian;
};
Determined DeterminedOf(std::span<const Photograph>, std::span<const Unknown>, const Layout&,
                        const Refined&, const Linearised&);

// An estimate for each photograph, without alternatives, trials and profile; noise as stated.
std::vector<Estimate> EstimatesOf(std::span<const Photograph>, std::span<const Unknown>,
                                  const Layout&, const Refined&, const Linearised&);

}  // namespace tranos::camera
