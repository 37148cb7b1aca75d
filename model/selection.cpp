// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/selection.h"

#include <algorithm>

namespace tranos::model {

namespace {

Hash128 HashOfEach(const Selection& selection, const Entries& entries) {
  Hasher hasher;
  for (const ElementId id : selection) hasher.Hash(ContentOf(entries[id]));
  return hasher.Finish();
}

}  // namespace

Selection::Selection(std::vector<ElementId> ids) {
  if (ids.size() == 1) one_ = ids[0];
  if (ids.size() < 2) return;
  auto* many = new Many;
  many->ids = std::move(ids);
  many_ = CountedPointer<Many>(many);
}

bool Selection::Contains(ElementId id) const { return std::find(begin(), end(), id) != end(); }

bool operator==(const Selection& a, const Selection& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

Hash128 Selection::HashIn(const Entries& entries) const {
  return many_ && many_->hashed ? many_->hash : HashOfEach(*this, entries);
}

void Selection::Rehash(const Entries& entries) {
  if (!many_) return;
  const Hash128 hash = HashOfEach(*this, entries);
  if (many_->hashed && many_->hash == hash) return;
  auto* many = new Many(*many_);  // an earlier state may hold the old one
  many->hash = hash;
  many->hashed = true;
  many_ = CountedPointer<Many>(many);
}

}  // namespace tranos::model
