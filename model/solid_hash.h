// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geom/solid.h"
#include "model/hash.h"

namespace tranos::model {

// Over what the solid is made of, without evaluating it; kept in its nodes, so that a solid made
// in many steps is hashed in as many.
Hash128 HashOf(const geom::Solid& solid);

}  // namespace tranos::model
