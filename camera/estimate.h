// SPDX-License-Identifier: GPL-3.0-or-later
// What a calibration found, as a plain value: the camera, how sure each parameter is, and what the
// data could not determine.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "camera/traces.h"

namespace tranos::camera {

// How much of a parameter's information came from where; the three add up to 1.
struct Shares {
  double pixels = 1;  // the dots
  double metric = 0;  // unknowns with a deviation of their own
  double priors = 0;  // what was assumed of the camera
};

struct ParameterEstimate {
  double sigma = 0;  // of the value in `Estimate::camera`, in its unit; without meaning if free
  bool determined = true;
  bool from_prior = false;  // not determined by the data, held by a prior alone
  Shares shares;

  bool free() const { return !determined && !from_prior; }  // its value means nothing
};

struct UnknownEstimate {
  std::string name;
  double value = 0;
  double sigma = 0;
  bool determined = true;
  bool at_bound = false;
};

// A facade that traces declared: an upright plane, its x to the right and its y upward as seen from
// outside, from the first dot of its first rectangle, or else from the foot of the world's origin.
struct FacadeEstimate {
  geom::Frame plane;
  // Of how far it is moved along its normal at its origin (m) and turned about its x and its y
  // (rad), by the columns of Estimate::deviations.
  Eigen::MatrixXd deviations;
  bool determined = true;
};

// What is at fault where traces, dimensions and assumptions do not agree.
struct Disagreement {
  std::string text;  // what disagrees, χ², what is farthest off, and what could as well be
  // Of what is at fault, and of what could as well be: the index of a trace through all photographs
  // or, after all traces, of an unknown; −1: a prior of the camera, or nothing.
  int part = -1;
  int other_part = -1;
};

// Where a traced rectangle's plane is in the picture, whatever camera took it.
struct RectangleView {
  int trace = 0;  // index in Photograph::traces
  // Dots from metres on its facade, to the right and upward from its first dot.
  Mat3 dot_from_metres = Mat3::Zero();
};

// What remains between a trace and what the camera says it should be.
struct TraceResidual {
  int trace = 0;                 // index in Photograph::traces
  std::vector<double> whitened;  // in deviations
  double weight = 1;             // of the robust loss; below 0.5 it is doubted
};

struct TrialSpread {  // the paper's Step I
  int trials = 0;
  ParameterVector mean = ParameterVector::Zero();
  ParameterVector deviation = ParameterVector::Zero();
};

struct ProfilePoint {
  double alpha_rad;
  double chi2;  // least, with the other parameters re-adjusted
};

struct Estimate {
  Camera camera;
  ParameterEstimate parameters[kParameters];
  // Of the camera's parameters and then the unknowns, in their order; free ones have zero rows.
  Eigen::MatrixXd covariance;
  // The same as what it comes from: a row for each of the covariance's, a column for each of the
  // independent sources, of deviation 1, that all estimates of one adjustment share. D Dᵀ is the
  // covariance, and D of one with Dᵀ of another that of the two.
  Eigen::MatrixXd deviations;
  int photographs = 1;  // that were adjusted together: χ² and degrees of freedom are of all
  double chi2 = 0;
  int dof = 0;
  double noise_px = 0;              // stated, or estimated from the residuals
  bool noise_is_estimated = false;  // then intervals are Student's t with `dof`
  // Half the width of a 95 % interval in deviations: the normal distribution's, or Student's t.
  double quantile95 = 1.959963984540054;
  std::vector<UnknownEstimate> unknowns;
  std::vector<FacadeEstimate> facades;  // by the index that traces have
  std::vector<Estimate> alternatives;   // other poses that explain the traces within their noise
  std::vector<TraceResidual> residuals;
  std::vector<std::string> undetermined;  // in words: what trades off, and what would determine it
  std::vector<std::string> warnings;      // near-degenerate vanishing points, tilt, pan
  std::optional<Disagreement> disagreement;
  std::vector<ProfilePoint> profile;
  TrialSpread trials;
  std::vector<RectangleView> rectangles;

  // Whether the data alone determine all parameters.
  bool determined() const {
    return std::ranges::all_of(parameters, &ParameterEstimate::determined);
  }
  // Whether all parameters have a number, be it by a prior: then the camera may be used.
  bool complete() const { return std::ranges::none_of(parameters, &ParameterEstimate::free); }
};

}  // namespace tranos::camera
