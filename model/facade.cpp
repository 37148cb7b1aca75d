// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/facade.h"

namespace tranos::model {

void AddToHash(Hasher& hasher, const Facade& facade) {
  hasher.Text(facade.name).Point(facade.plane.origin);
  hasher.Direction(facade.plane.x).Direction(facade.plane.y);
}

}  // namespace tranos::model
