// SPDX-License-Identifier: GPL-3.0-or-later
// From light to a print on paper, as old as it is said to be.
#pragma once

#include "camera/photo.h"
#include "output/exposure.h"

namespace tranos::output {

// Tones of a print, from 0 (its deepest shadow) to 1 (bare paper), row by row.
struct Tones {
  int width_px = 0, height_px = 0;
  std::vector<float> values;

  float& At(int x, int y) { return values[static_cast<std::size_t>(y) * width_px + x]; }
  float At(int x, int y) const { return values[static_cast<std::size_t>(y) * width_px + x]; }
};

// The plate developed and printed: softened by the lens, glowing a little about what is bright,
// darker towards the corners, in the tones of its curve, with grain; what has come to plate and
// print since; in the colours of its paper. `exposure` is used up.
camera::Photo PrintOf(Exposure exposure, const model::PhotoRequest& request, int threads);

}  // namespace tranos::output
