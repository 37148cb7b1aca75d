// SPDX-License-Identifier: GPL-3.0-or-later
// A facade: a plane that is drawn on through a photograph. An element as a trace is one: named,
// undone, compared, and no part of what is built.
#pragma once

#include <string>

#include "geom/primitives.h"
#include "model/hash.h"

namespace tranos::model {

struct Facade {
  std::string name;   // by which commands know it
  geom::Frame plane;  // x to the right along it, y up, z towards who looks at it
  int solved = -1;    // its index in the estimates of the photographs it was calibrated with
};

void AddToHash(Hasher& hasher, const Facade& facade);

}  // namespace tranos::model
