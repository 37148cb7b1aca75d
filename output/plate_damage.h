// SPDX-License-Identifier: GPL-3.0-or-later
// What happens to plates and prints: dust, scratches, stains.
#pragma once

#include "model/photo_request.h"
#include "output/print.h"

namespace tranos::output {

// For each pixel, how much of it is covered by what. Places and sizes are shares of the picture's
// width, so that a larger picture with the same seed has the same damage.
struct Damage {
  std::vector<float> light;  // scratches and dust on the plate: bare paper shows
  std::vector<float> dark;   // dust and hairs on the print
  std::vector<float> brown;  // stains
};
Damage DamageOf(const model::PrintEffects& effects, std::uint64_t seed, int width_px,
                int height_px);

}  // namespace tranos::output
