// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "model/state.h"
#include "output/result.h"

namespace tranos::output {

// The curves and texts on visible levels, seen from the top, as an SVG that fits a square of this
// many pixels: a path for each colour, line style and weight, in which what meets end to end goes
// on. Surfaces and points are left out. Nothing to draw gives an empty picture.
Result<std::string> PlanSvgOf(const model::Model& model, int side_px);

}  // namespace tranos::output
