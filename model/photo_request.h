// SPDX-License-Identifier: GPL-3.0-or-later
// A photograph of the model that is to be taken: by which camera, on what plate, and what time has
// done to the print.
#pragma once

#include <cstdint>

#include "camera/camera.h"
#include "camera/distortion.h"
#include "model/state.h"

namespace tranos::model {

// How strong each is, from 0 (none) to 1 (as strong as on a badly kept print).
struct PrintEffects {
  double grain = 0;      // of the emulsion
  double vignette = 0;   // of the lens: darker towards the corners
  double fade = 0;       // of the print: weak shadows, most at its edges
  double dust = 0;       // specks and hairs
  double scratches = 0;  // of the plate
  double stains = 0;     // of damp, with rims, and foxing
  double paper = 0;      // its fibres and unevenness
  double scan = 0;       // noise of the scanner, pixel by pixel
};

enum class PrintTone : std::uint8_t { kSepia, kGrey };

struct PhotoRequest {
  Model model;       // as it stood when asked for
  ElementPtr taken;  // the camera's element
  camera::Camera camera;
  camera::Frame frame;  // the pixels asked for, on the camera's film
  camera::Distortion distortion;
  geom::Vec3 towards_sun = geom::Vec3::UnitZ();  // unit
  PrintEffects effects;
  PrintTone tone = PrintTone::kSepia;
  std::uint64_t seed = 1;
};

// Of all that its pixels depend on.
Hash128 HashOf(const PhotoRequest& request);

}  // namespace tranos::model
