// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras found from real photographs' edges by `Calibrate` under `prior default`, and how far they
// are from the truth. One noise model and one loss for every photograph.
#pragma once

#include "camera/calibrate.h"
#include "tests/camera/real/photographs.h"

namespace tranos::camera::real {

// The photograph with its edges as traces. Ends were set by hand or by a line detector, so each is
// off by the same deviation, whatever the edge's length, and how large that is, is estimated from
// the residuals. The longest upright edge is two points, the origin and 3 m above it: that says as
// much of the directions as a trace of direction would, and fixes place and scale besides, which
// directions leave open.
struct Traced {
  Photograph photograph;
  Numbers numbers;
};
Traced TracedEdges(const Known&);
// The same with every edge a trace of direction, place and scale left open.
Traced TracedDirections(const Known&);

// Aspect 1 ± 3 %, principal point in the middle ± 5 % of width and height, axes at 90° ± 1°.
void AssumeDefaults(Photograph&);

struct Found {
  std::string name;
  bool is_found = false;  // a camera with a focal length; else the numbers mean nothing
  int edges = 0;
  double focal_px = 0;  // in x
  double sigma_px = 0;  // of it
  double noise_px = 0;
  Mat3 camera_from_world = Mat3::Identity();
  Mat3 dot_from_camera = Mat3::Identity();  // together they put vanishing points where seen

  // A focal length that data and priors leave uncertain by more than a fifth of it.
  bool is_loose() const { return sigma_px > 0.2 * focal_px; }
};
// With the noise estimated. Edges that `Calibrate` tells are others again are left out.
Found FoundCamera(Traced, Loss = Loss::kHuber);
std::vector<Found> FoundCameras(const std::vector<Known>&, Loss = Loss::kHuber);

// Relative; infinite where no camera was found, or, on request, its focal length is loose.
enum class Loose { kCounts, kInfinite };
std::vector<double> FocalErrors(const std::vector<Found>&, const std::vector<Known>&, Loose);

// Degrees between the true rotation and the one found, after the signs of the axes in which they
// agree best.
double RotationErrorUpToSigns(const Mat3& found, const Mat3& truth);
// For every two photographs, degrees between the true and the found turn from one to the other.
std::vector<double> RelativeRotationErrors(const std::vector<Found>&, const std::vector<Known>&);
// For every photograph, the true rotation from the castle's frame: its Z is the true upright, its
// azimuth, which no survey tells, the mean of those found. So many turns about Z are alike: two
// where it is known which facade is which, four where it is not.
std::vector<Mat3> TrueRotations(const std::vector<Found>& found, const std::vector<Known>& known,
                                int alike);
// For every photograph, degrees between that and the rotation found.
std::vector<double> RotationErrors(const std::vector<Found>& found, const std::vector<Known>& known,
                                   int alike = 2);
// For every photograph, degrees between the true upright direction and the one found.
std::vector<double> UprightErrors(const std::vector<Found>&, const std::vector<Known>&);

// A camera with square pixels and dots' axes at a right angle, from directions alone, none of its
// principal point assumed: by the self-polar triangle, and by `Calibrate` with both held by priors
// of a millionth. Nothing where there is no such camera.
struct Square {
  double focal_px;
  Vec2 principal_px;
};
std::optional<Square> SquareByOrthocentre(const Known&);
std::optional<Square> SquareByLikelihood(const Known&);

// The share of the focal lengths found whose stated deviation, times 1.96, covers the truth.
double Coverage(const std::vector<Found>&, const std::vector<Known>&);

// The value that a share `p` of them does not exceed, between neighbours in proportion.
double Quantile(std::vector<double> values, double p);

}  // namespace tranos::camera::real
