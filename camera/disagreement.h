// SPDX-License-Identifier: GPL-3.0-or-later
// What is at fault where traces, dimensions and assumptions do not agree.
#pragma once

#include <string>

#include "camera/search.h"

namespace tranos::camera {

struct Disagreement {
  std::string text;     // what disagrees, χ², what is farthest off, and what could as well be
  int part = -1;        // index of the trace at fault through all photographs; −1: it is no trace
  int other_part = -1;  // of a trace that could as well be
};

// For a state of least cost with misfit `chi2` on `dof` degrees of freedom. Everything that says
// something is suspected: traces, deviations and bounds of unknowns, priors of the cameras. Those
// without which χ² would fall most, to first order and for the number of their residuals, are left
// out in turn and all else is adjusted again; at fault is the one without which χ² falls most. Of
// two that disagree with each other and with nothing else, it is the later one.
Disagreement DisagreementAt(const Task&, const Refined&, const Linearised&, double chi2, int dof);

}  // namespace tranos::camera
