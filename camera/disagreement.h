// SPDX-License-Identifier: GPL-3.0-or-later
// What is at fault where traces, dimensions and assumptions do not agree.
#pragma once

#include "camera/estimate.h"
#include "camera/search.h"

namespace tranos::camera {

// For a state of least cost with misfit `chi2` on `dof` degrees of freedom. Everything that says
// something is suspected: traces, deviations and bounds of unknowns, priors of the cameras. Those
// without which χ² for each degree of freedom would be least, to first order, are left out in turn
// and all else is adjusted again; at fault is the one without which the rest agrees best. Of two
// that disagree with each other and with nothing else, it is the later one.
Disagreement DisagreementAt(const Task&, const Refined&, const Linearised&, double chi2, int dof);

}  // namespace tranos::camera
