// SPDX-License-Identifier: GPL-3.0-or-later
// Where an element stands in the model.
#pragma once

#include <cstdint>

#include "model/element.h"
#include "model/persistent_vector.h"

namespace tranos::model {

// kMember: inside a group (`owner`); kConsumed: made into something else; kDeleted: gone, its name
// too.
enum class Standing : std::uint8_t { kInModel, kMember, kConsumed, kDeleted };

struct Entry {
  ElementPtr element;  // as it is now, of a group's member the one in the group; null when deleted
  Standing standing = Standing::kInModel;
  ElementId owner = kNoElement;
};
using Entries = PersistentVector<Entry>;  // by id

// What a selection or a name means by this entry: its element's content and its standing.
Hash128 ContentOf(const Entry& entry);

}  // namespace tranos::model
