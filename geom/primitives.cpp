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

Box Carried(const Box& box, const Affine& target_from_source) {
  Box carried;
  if (box.empty()) return carried;
  for (int i = 0; i < 8; ++i) {
    carried.Add(target_from_source * Vec3(i & 1 ? box.max.x() : box.min.x(),
                                          i & 2 ? box.max.y() : box.min.y(),
                                          i & 4 ? box.max.z() : box.min.z()));
  }
  return carried;
}

}  // namespace tranos::geom
