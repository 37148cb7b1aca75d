// SPDX-License-Identifier: GPL-3.0-or-later
// Chosen elements, in the order of choosing. Two words that are copied freely: one id is
// held in place, for the firing that makes one element is the usual one.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <vector>

#include "model/counted_pointer.h"
#include "model/entry.h"

namespace tranos::model {

class Selection {
 public:
  Selection() = default;
  // Of ids that are each there once.
  Selection(std::vector<ElementId> ids);  // NOLINT(google-explicit-constructor): it is its list
  Selection(std::initializer_list<ElementId> ids) : Selection(std::vector<ElementId>(ids)) {}

  std::size_t size() const { return many_ ? many_->ids.size() : one_ == kNoElement ? 0 : 1; }
  bool empty() const { return size() == 0; }
  const ElementId* begin() const { return many_ ? many_->ids.data() : &one_; }
  const ElementId* end() const { return begin() + size(); }
  ElementId operator[](std::size_t index) const { return begin()[index]; }
  ElementId back() const { return begin()[size() - 1]; }
  bool Contains(ElementId id) const;
  friend bool operator==(const Selection& a, const Selection& b);

  // The content of what is chosen, in order. A long selection keeps it, and is to be told by Rehash
  // when an element that it may hold was changed.
  Hash128 HashIn(const Entries& entries) const;
  void Rehash(const Entries& entries);

 private:
  struct Many {
    OwnerCount owners;
    std::vector<ElementId> ids;
    Hash128 hash;
    bool hashed = false;
    friend void Destroy(Many* many) { delete many; }
  };
  ElementId one_ = kNoElement;
  CountedPointer<Many> many_;
};

}  // namespace tranos::model
