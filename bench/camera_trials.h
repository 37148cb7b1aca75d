// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated calibrations of the benchmark's cuboids, by every method, and what their errors were.
#pragma once

#include <string>
#include <vector>

#include "camera/calibrate.h"
#include "tests/camera/cuboid.h"

namespace tranos::bench {

using camera::kParameters;
using camera::ParameterVector;
using camera::benchmark::Cuboid;

enum Method : int { kOrthocentre, kDlt, kPaper, kSweep, kLikelihood, kMethods };
inline constexpr const char* kMethodNames[kMethods] = {"orthocentre", "dlt", "paper", "sweep",
                                                       "likelihood"};

struct Noise {
  camera::benchmark::Picture picture;
  double sigma_px;
  std::string name() const;  // "hi 0.5"
};
inline const std::vector<Noise> kNoises = {
    {camera::benchmark::kHi, 0.1}, {camera::benchmark::kHi, 0.25}, {camera::benchmark::kHi, 0.5},
    {camera::benchmark::kHi, 1.0}, {camera::benchmark::kLo, 0.25}, {camera::benchmark::kLo, 0.5}};
inline const Noise kPlainNoise{camera::benchmark::kHi, 0.5};

// mm, degrees and metres, as the paper's tables have it.
ParameterVector InTableUnits(ParameterVector);

// Errors of many trials, in table units.
struct Errors {
  int trials = 0;
  int failures = 0;  // told as an error; `likelihood`: or as not determined
  int warned = 0;    // `likelihood`: with a warning of tilt, pan or vanishing points
  std::vector<ParameterVector> each;                  // of the trials that did not fail
  ParameterVector covered = ParameterVector::Zero();  // truths within the 95 % intervals

  ParameterVector Mean() const;
  ParameterVector Deviation() const;
  ParameterVector Rmse() const;
  ParameterVector Median() const;    // of absolute errors
  ParameterVector Coverage() const;  // of the trials that did not fail
  // The mean error in standard errors of itself.
  ParameterVector BiasInStandardErrors() const;
};

// Trial i has the seed 1 + i + 100000 × `chosen`. The visible edges, with true dimensions, noise
// declared as it is, no priors.
Errors Simulate(const Cuboid&, const Noise&, Method, int trials, int chosen);

// The Cramér–Rao bound in table units, from the information matrix at the truth.
ParameterVector BoundOf(const Cuboid&, const Noise&);

}  // namespace tranos::bench
