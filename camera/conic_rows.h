// SPDX-License-Identifier: GPL-3.0-or-later
// The linear constraints on the absolute conic that a photograph's traces give.
#pragma once

#include <vector>

#include "camera/absolute_conic.h"
#include "camera/pose.h"
#include "camera/vanishing_point.h"

namespace tranos::camera {

struct ConicRows {
  // By maximum likelihood from the lines of each axis; none where those are fewer than two or the
  // same line.
  std::array<std::optional<VanishingPoint>, 3> axes;
  // Those, and where missing X and Z of the first rectangle of facade 0.
  AxisPoints points;
  std::vector<Conic> orthogonal;  // of `points`: XZ, YZ, XY
  // Equal lengths: of the axes, from edges in space; of rectangles, with the orthogonality of their
  // sides; of ratios and of circles, where the facade's vanishing line is known. Each about 1 in
  // size.
  std::vector<Conic> metric;

  std::vector<Conic> all() const;
};

// Never fails; what is not there gives no row.
ConicRows ConicRowsOf(const Photograph& photograph, const Numbers& numbers);

// Independent rows from the front on, until there are `rank` of them or no more.
std::vector<Conic> IndependentRows(std::span<const Conic> rows, int rank);

}  // namespace tranos::camera
