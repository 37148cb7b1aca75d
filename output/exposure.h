// SPDX-License-Identifier: GPL-3.0-or-later
// What a plate shows of the model under sun and sky, taken by a camera of eleven parameters and a
// lens with distortion and falloff.
#pragma once

#include <vector>

#include "model/photo_request.h"
#include "output/result.h"

namespace tranos::output {

// From 0 (the deepest shadow) to 1 (bare paper), row by row from the top.
struct Tones {
  int width_px = 0, height_px = 0;
  std::vector<float> values;

  float& At(int x, int y) { return values[static_cast<std::size_t>(y) * width_px + x]; }
  float At(int x, int y) const { return values[static_cast<std::size_t>(y) * width_px + x]; }
};

// Distance of a pixel from the middle of the picture; 1 in the corners.
float Outward(int x, int y, int width_px, int height_px);

// As an orthochromatic plate takes it (blue counts most, red hardly at all), exposed for the
// brighter parts of what is built. Each pixel is the mean over its square of tones and not of
// light, in which what is bright would take more than its share of a pixel and so move edges. The
// same for any number of threads. Errors: a lens whose distortion folds the picture, elements whose
// facets cannot be made.
Result<Tones> Expose(const model::PhotoRequest& request, int threads);

}  // namespace tranos::output
