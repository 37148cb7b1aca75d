// SPDX-License-Identifier: GPL-3.0-or-later
// The straight edges of a photograph as image lines, with how sure each is.
#pragma once

#include <vector>

#include "camera/image_line.h"
#include "camera/photo.h"

namespace tranos::camera {

struct LineDetection {
  double min_length_px = 0;  // 0: 3 % of the photograph's shorter side
};

// The straight edges, longest first. What the detectors propose is followed along the edge: at each
// pixel of its length the place where the brightness changes fastest across it is found to a part
// of a pixel, and a line fitted to these by total least squares, each weighted by how steep the
// edge is there, those farther off than 2.5 robust deviations left out. Collinear pieces with the
// same side bright are one line where they overlap or the gap is shorter than the shorter of them.
// Deviations are of the scatter that is left, neighbouring pixels' errors being correlated by the
// smoothing. Of a photograph larger than 2 000 px a picture made smaller by a whole number is
// searched. Error kOutOfRange: a photograph less than 16 px wide or high.
geom::Result<std::vector<ImageLine>> DetectLines(const Photo& photo, const LineDetection& = {});

}  // namespace tranos::camera
