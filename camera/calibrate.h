// SPDX-License-Identifier: GPL-3.0-or-later
// The likeliest cameras and unknowns for everything traced, how sure they are, and what is not
// determined: the one way in to this room's adjustment.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "camera/estimate.h"
#include "camera/refinement.h"
#include "camera/sweep.h"

namespace tranos::camera {

struct CalibrateOptions {
  Loss loss = Loss::kNone;
  double noise_px = 0.5;             // of a dot, as stated: only to be told in the result
  bool noise_is_estimated = false;   // stated deviations then say only how dots compare
  int trials = 0;                    // resamplings, the paper's Step I
  std::uint64_t seed = 1;            // of these
  std::optional<SkewRange> profile;  // χ² over the skew of the first photograph
  // By facade, the number that gives its azimuth, its distance from the world's origin the next one
  // (FacadePlane); −1 where its place is to be found.
  std::vector<NumberIndex> given_planes = {};
};

// An estimate for each photograph, all from one adjustment; what is told of unknowns, χ² and
// degrees of freedom is the same in each. Each photograph's starts are refined with its own traces,
// the pose of least χ² that has what is traced before it is taken, others within 9 of it are
// alternatives; with several photographs all are then refined together.
//
// χ² is of dots, unknowns and priors by their stated deviations, `dof` the number of these less the
// rank; with `noise_is_estimated`, deviations and shares are for the estimated noise, and `dof` is
// of the dots alone. A misfit far beyond the degrees of freedom is a warning, and beyond ten
// deviations for each an error, unless the loss is robust or the noise is estimated.
//
// Where the view of a single photograph is left open, its camera is a plausible one of those that
// fit: the traces' images are right, the numbers that are not determined mean nothing. Trials tell
// NaN for these. The profile is of what is made least, χ² without a robust loss.
//
// Errors, `part` the index of the trace, counted through the photographs in order, or after all
// traces of the unknown, `other` that of what it is the same as, or that could as well be the one
// that disagrees; with several photographs the sentence names the one that it is about.
// kDegenerate: a line traced twice, all lines parallel, a rectangle traced crosswise or clockwise,
// axes that share a vanishing point, too few traces to start from. kOutOfRange: a dimension that is
// not positive and finite, traces that disagree, a profile's range. What `numbers_of` told.
geom::Result<std::vector<Estimate>> Calibrate(std::span<const Photograph>, std::span<const Unknown>,
                                              const NumbersOfUnknowns& numbers_of,
                                              const CalibrateOptions& = {});

// The same for one photograph and no unknowns.
geom::Result<Estimate> Calibrate(const Photograph&, const Numbers&, const CalibrateOptions& = {});

}  // namespace tranos::camera
