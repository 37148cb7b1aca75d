// SPDX-License-Identifier: GPL-3.0-or-later
// Evaluates a solid's tree. Internal to geom.
#pragma once

#include "geom/solid.h"

namespace tranos::geom {

// The facets of what the tree describes: closed, free of self-intersections as rounded, facets of
// one plane merged. Empty for an empty solid.
Result<TriangleMesh> Evaluate(const Solid& solid);

}  // namespace tranos::geom
