// SPDX-License-Identifier: GPL-3.0-or-later
// A facade as it is seen on a photograph, brought to a plane at scale; nothing where it is not
// seen.
#pragma once

#include "model/orthophoto.h"
#include "output/picture.h"
#include "output/result.h"

namespace tranos::output {

// Why a pixel of an orthophoto shows nothing.
enum class Unseen : std::uint8_t {
  kSeen,
  kOutside,  // it lies outside the photograph, or behind the camera
  kHidden,   // something that is built stands before it
};

// Rows from the top, as a picture's.
struct SeenPixels {
  std::vector<Unseen> why;
  std::size_t outside = 0, hidden = 0;  // how many
};

// The orthophoto's picture, transparent where nothing is seen of it (and black there), and why. A
// pixel is sampled at its centre, bilinearly, from the photograph at the size that shows about as
// much: where the photograph is finer, from the means of 2×2, 4×4 … of its pixels. What hides it
// stands more than the orthophoto's tolerance before its plane; its triangles' shadows, cast by the
// camera, are filled in exactly. The same for any number of threads. Errors: the photograph's
// pixels are not at hand; facets that cannot be made.
struct RectifiedFacade {
  Picture picture;
  SeenPixels seen;
};
Result<RectifiedFacade> Rectify(const model::Orthophoto& orthophoto, int threads);

}  // namespace tranos::output
