// SPDX-License-Identifier: GPL-3.0-or-later
// From a plate to a print on paper, as old as it is said to be.
#pragma once

#include "camera/photo.h"
#include "output/exposure.h"

namespace tranos::output {

// What came to the developed plate, and to the print on paper, since: softened a little, glowing
// about what is bright, with grain, dust, scratches, stains, faded, in the colours of its paper.
camera::Photo PrintOf(Tones tones, const model::PhotoRequest& request, int threads);

}  // namespace tranos::output
