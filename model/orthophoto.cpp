// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/orthophoto.h"

#include "model/state.h"

namespace tranos::model {

void AddToHash(Hasher& hasher, const Orthophoto& orthophoto) {
  const geom::Frame& plane = orthophoto.plane;
  hasher.Text(orthophoto.facade).Hash(orthophoto.photograph->hash);
  hasher.Point(plane.origin).Direction(plane.x).Direction(plane.y);
  hasher.Length(orthophoto.pixel_m).Length(orthophoto.tolerance_m);
  hasher.Integer(orthophoto.size_px.x()).Integer(orthophoto.size_px.y());
  hasher.Hash(orthophoto.standing->hash);
}

}  // namespace tranos::model
