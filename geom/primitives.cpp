// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/primitives.h"

namespace tranos::geom {

Affine Frame::WorldFromFrame() const {
  Affine world_from_frame;
  world_from_frame.linear().col(0) = x;
  world_from_frame.linear().col(1) = y;
  world_from_frame.linear().col(2) = z();
  world_from_frame.translation() = origin;
  return world_from_frame;
}

}  // namespace tranos::geom
