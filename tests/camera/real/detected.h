// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras found from photographs with nothing traced by hand, and how far they are from the truth.
#pragma once

#include <span>

#include "camera/line_detection.h"
#include "camera/vanishing_directions.h"
#include "tests/camera/real/results.h"

namespace tranos::camera::real {

Photo PhotoOf(const Known&);

// The lines of each axis as the traces that `detect vanishing points` makes of them.
Traced TracedLines(const Known&, std::span<const ImageLine>, std::span<const int> axis);

// What each line is in truth, two ways. The axis whose known vanishing point makes the line
// likeliest; that of the labelled edge along which it lies, if there is one.
std::vector<int> AxesByDirections(const Known&, std::span<const ImageLine>);
std::vector<int> AxesByLabels(const Known&, std::span<const ImageLine>);

// Degrees: the largest of the three between a column of the rotation found and the true direction,
// signs and the order of the horizontal ones aside.
double DirectionError(const Mat3& found, const Mat3& truth);
// The larger vertical distance between the true horizon and the one found at the left and the right
// column of dots, over the photograph's height.
double HorizonError(const Found&, const Known&);

// Of each photograph, those not found counted as failed.
struct Errors {
  std::vector<double> direction_deg, horizon, focal;  // 180, infinite, infinite where not found

  void Add(const Found&, const Known&);
  double DirectionsWithin(double degrees) const;  // a share
  // The area under the share of photographs with less than each error up to `most`, over `most`.
  double HorizonArea(double most) const;
};

}  // namespace tranos::camera::real
