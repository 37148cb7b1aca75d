// SPDX-License-Identifier: GPL-3.0-or-later
// From an adjusted state to what is told of it: deviations, shares, residuals, what is open.
#pragma once

#include <span>

#include "camera/determination.h"
#include "camera/estimate.h"
#include "camera/refinement.h"

namespace tranos::camera {

// "`depth`", or of a dimension without a name "the dimension 14 m ± 0.14 m".
std::string NameOfUnknown(const Unknown&);

struct Determined {
  Determination determination;
  // Weighted as the robust loss has it, which is how the estimate hangs on each row.
  Eigen::MatrixXd jacobian;
};
Determined DeterminedOf(std::span<const Photograph>, std::span<const Unknown>, const Layout&,
                        const Refined&, const Linearised&);

// Adds a warning for each tilt or pan of the camera outside 5° to 40°, if its pose is known, and
// for each axis whose edges are parallel in the picture: where methods by vanishing points are
// weak.
void AppendWeaknesses(const Photograph&, const Numbers&, const Camera*,
                      std::vector<std::string>& warnings);

// An estimate for each photograph, without alternatives, trials and profile; noise as stated.
std::vector<Estimate> EstimatesOf(std::span<const Photograph>, std::span<const Unknown>,
                                  const Layout&, const Refined&, const Linearised&);

}  // namespace tranos::camera
