// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geom/surface.h"
#include "model/element.h"
#include "output/result.h"

namespace tranos::output {

// What an output draws of one element that is no group or instance, in that element's frame.
// Closed strokes end where they start; every triangle has three different corners and every
// normal is unit.
struct Facets {
  std::vector<geom::Vec3> points;
  std::vector<std::vector<geom::Vec3>> strokes;
  geom::Mesh mesh;
};
Result<Facets> FacetsOf(const model::Element& leaf, const geom::Tolerance& tolerance);

}  // namespace tranos::output
