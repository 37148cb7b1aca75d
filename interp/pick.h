// SPDX-License-Identifier: GPL-3.0-or-later
// Which element a data point means.
#pragma once

#include "model/state.h"

namespace tranos::interp {

struct PickResult {
  model::ElementPtr element;  // the nearest on levels that are on; null if there is none
  double distance_m = 0;
  bool within = false;  // the locate tolerance
  bool ambiguous =
      false;  // several of the same kind were equally near: the one made last was taken
};

// Groups and placed elements are picked whole. Within 1e-9 m of the nearest a point wins over a
// curve and a curve over a surface.
PickResult Pick(const model::State& state, const geom::Vec3& point_in_world);

// Whether any part of the element is on a level that is on.
bool IsVisible(const model::Model& model, const model::Element& element);

}  // namespace tranos::interp
