// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "model/element.h"

namespace tranos::output {

// The colour of a face. Colour 0, that of lines where none is set, is nearly black, in which a
// surface's form would drown: faces of colour 0 are of a light stone.
inline model::Rgb SurfaceColour(model::Colour colour) {
  if (colour == model::Colour{0}) return {222, 214, 198};
  return model::RgbOf(colour);
}

}  // namespace tranos::output
