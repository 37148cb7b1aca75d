// SPDX-License-Identifier: GPL-3.0-or-later
// Plane faces that were measured one by one, brought to common corners and edges.
#pragma once

#include <vector>

#include "geom/curve.h"

namespace tranos::geom {

// The outlines with corners of different faces that lie within `within_m` of each other moved to
// one place, the nearest ones first: to where the faces' planes meet, nearest to the corners' mean,
// so that every face stays in its plane. No corner goes farther than `within_m`. Errors, `part` the
// outline: kNotClosed; kNotPlanar; kTooLarge (more than 10 000 corners); kDegenerate: a face would
// lose a corner; kDoNotMeet: no corner of it is near to one of another, or their planes meet in no
// place near them.
Result<std::vector<Polyline>> JoinFaces(const std::vector<Polyline>& outlines, double within_m);

}  // namespace tranos::geom
