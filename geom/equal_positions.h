// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes double their vertices along creases; these are found to be one place again.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/primitives.h"

namespace tranos::geom {

// For each position the lowest index of an equal one.
std::vector<std::uint32_t> FirstOfEqual(const std::vector<Vec3>& positions);

}  // namespace tranos::geom
