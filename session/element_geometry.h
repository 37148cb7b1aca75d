// SPDX-License-Identifier: GPL-3.0-or-later
// An element as a journal keeps it.
#pragma once

#include <set>

#include "model/element.h"
#include "session/json_text.h"

namespace tranos::session {

// Prototypes whose parts the journal holds already.
using KnownPrototypes = std::set<model::Hash128>;

// {id, type, name?, hash, attributes?, geometry}: the numbers that its hash is of, rounded as they
// are there. A prototype's parts are written where it is first used.
void WriteElement(const model::Element& element, KnownPrototypes* known, JsonText* out);

}  // namespace tranos::session
