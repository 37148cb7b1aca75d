// SPDX-License-Identifier: GPL-3.0-or-later
// The light that falls on a plate: what a camera of eleven parameters and a lens with distortion
// sees of the model under sun and sky.
#pragma once

#include <vector>

#include "model/photo_request.h"
#include "output/result.h"

namespace tranos::output {

// Row by row from the top; 1 is what the sky near the horizon gives. As an orthochromatic plate
// takes it: blue counts most, red hardly at all.
struct Exposure {
  int width_px = 0, height_px = 0;
  std::vector<float> light;
  float building = 0;  // the light of the brighter parts of what is built; 0 where none is seen

  float& At(int x, int y) { return light[static_cast<std::size_t>(y) * width_px + x]; }
};

// Each pixel is the mean over its square. The same for any number of threads. Errors: a lens whose
// distortion folds the picture, elements whose facets cannot be made.
Result<Exposure> Expose(const model::PhotoRequest& request, int threads);

}  // namespace tranos::output
