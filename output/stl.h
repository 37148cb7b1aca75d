// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "model/state.h"
#include "output/result.h"

namespace tranos::output {

// The faces of the visible part of the model as the bytes of a binary STL: metres, Z up, each
// triangle anticlockwise seen from outside. Instances are written out, curves and points left out;
// a model without faces gives a file without triangles. Coordinates have single precision, as the
// format has them; the same model gives the same bytes.
Result<std::string> StlOf(const model::Model& model);

}  // namespace tranos::output
