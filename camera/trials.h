// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's Step I: how the cameras scatter when what was measured is drawn anew.
#pragma once

#include <cstdint>
#include <vector>

#include "camera/estimate.h"
#include "camera/search.h"

namespace tranos::camera {

// By photograph, of `trials` adjustments of traces, unknowns and priors drawn anew about what was
// measured; those that find no camera are not counted.
std::vector<TrialSpread> Trials(const Task&, const Refined& near, int trials, std::uint64_t seed);

}  // namespace tranos::camera
