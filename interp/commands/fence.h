// SPDX-License-Identifier: GPL-3.0-or-later
// A polygon through which elements are chosen.
#pragma once

#include "interp/command.h"

namespace tranos::interp {

struct Fence {
  geom::Frame plane;                // elements are seen along its normal
  std::vector<geom::Vec2> outline;  // in the plane; closed by itself

  // Whether the element lies wholly inside; with `overlap`, whether any of it does.
  bool Takes(const model::Element& element, bool overlap) const;
};

// Two points are opposite corners of a rectangle, more are the corners of an outline.
tl::expected<Fence, CommandError> MakeFence(const std::vector<geom::Vec3>& points,
                                            const geom::Frame& plane);

}  // namespace tranos::interp
