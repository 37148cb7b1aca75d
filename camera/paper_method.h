// SPDX-License-Identifier: GPL-3.0-or-later
// The method `paper`: the procedure of the paper's Fig. 4, literally, to compare with.
#pragma once

#include "camera/sweep.h"

namespace tranos::camera {

// f, r, u and v from the vanishing points and one known ratio without skew (Step B); then, for each
// skew angle, s = f cot α with f, r, u, v kept, the poses of H and −H of the facade with most edges
// or of its rectangle (Steps C and D, Lemmas 1 and 8), and of all the one with the least penalty
// (Steps F and G). It is inconsistent: f, r, u, v found without skew are not those of a camera with
// it, so that at α = 89° it errs by millimetres in f without any noise. Not refined between the
// steps. Errors as for `CalibrateSweep`, and where no facade gives a homography.
geom::Result<SweepResult> CalibratePaper(const Photograph& photograph, const Numbers& numbers,
                                         const SkewRange& range = {});

}  // namespace tranos::camera
