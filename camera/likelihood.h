// SPDX-License-Identifier: GPL-3.0-or-later
// The likeliest camera for traced lines, points and curves of known place or direction, alone: no
// unknowns, no facades. Fixed-size Gauss–Newton with Levenberg's damping; nothing is allocated but
// the images of curves.
#pragma once

#include <optional>

#include "camera/residuals.h"
#include "camera/traces.h"

namespace tranos::camera {

struct CameraFit {
  Camera camera;
  ParameterMatrix information = ParameterMatrix::Zero();  // JᵀJ there, of traces and priors
  double chi2 = 0;                                        // of traces and priors
  int residuals = 0;                                      // of the traces
  int iterations = 0;
  bool converged = false;
};

// Whether all traces are edges in space, directions, points and curves.
bool NeedsCameraAlone(const Photograph&);

// The camera of least χ² near `start`, the intrinsic priors included (DESIGN.md, "How a photograph
// flows"). Iterates until a step is below 1e-12 of each parameter or 1e-8 of its deviation, or no
// longer halves, which is rounding. With `skew_rad` the skew angle is held there. Traces of other
// kinds are passed over; parameters that nothing determines stay near the start.
CameraFit FitCamera(const Photograph&, const Numbers&, const Camera& start,
                    std::optional<double> skew_rad = {});

// Whether the points, and a part of each edge and curve in space, are before the camera. Of the
// cameras that give the same lines, this tells the one that took the picture.
bool SeesTraces(const Photograph&, const Numbers&, const Camera&);

}  // namespace tranos::camera
