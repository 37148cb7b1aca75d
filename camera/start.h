// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras for the likelihood to start from, by linear methods.
#pragma once

#include <vector>

#include "camera/traces.h"

namespace tranos::camera {

// Cameras that explain what is traced, best first, at least one if the photograph has any trace and
// up to eight: of control points and edges (`dlt`), of vanishing points and ratios, with as many of
// the assumptions (the priors' values; without one a right angle, aspect 1, the principal point in
// the middle) as the data leave open, of the facade's homography for a range of focal lengths with
// the pose of the facade's mirrored normal too, and, where all of that explains little, of upright
// cameras looking in all directions, as far away as the extents of curves in space say. On exact
// traces that determine the camera the first is it. `numbers` are for the unknowns' starts. What
// the traces leave open has a usual value: f 1.1 times the picture's width, position (0, −10 m, 0).
std::vector<Camera> Starts(const Photograph& photograph, const Numbers& numbers);

// The photograph with something plausible assumed of each intrinsic parameter that has no prior,
// about where a start has it.
Photograph Anchored(Photograph photograph, const Camera& start);

}  // namespace tranos::camera
