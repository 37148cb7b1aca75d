// SPDX-License-Identifier: GPL-3.0-or-later
// What names stand for, with a hash that follows each change in constant time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "model/counted_pointer.h"
#include "model/entry.h"

namespace tranos::model {

struct NameBinding {
  PersistentVector<ElementId> ids;
  bool given = false;
};

// The names of one name scope (script, group, define body), by index. One word; copies share
// what they hold until one of them is changed.
class Names {
 public:
  std::size_t size() const { return table_ ? table_->bindings.size() : 0; }
  // A name that was never set is one that was not given.
  const NameBinding& operator[](std::size_t index) const;

  // The name is given, and stands for one element more.
  void Bind(std::size_t index, ElementId id, const Entries& entries);
  // The name stands for this instead of what it stood for.
  void Set(std::size_t index, NameBinding binding, const Entries& entries);

  // Of content and index. Apply keeps it right for the names in the state; whoever puts back the
  // names of an outer scope calls Rehash, for Apply did not see them meanwhile.
  Hash128 hash() const { return table_ ? table_->hash : Hash128{}; }
  void Rehash(const Entries& entries);
  // The element's content was `before` and is `after`.
  void Follow(ElementId id, const Hash128& before, const Hash128& after);

 private:
  // The hash is the sum over all bound elements of weight × content, word by word: linear in the
  // content, so that one weight for each element tells what a change of it does to the sum.
  // One word in the vector, so that naming copies little of it.
  using BindingPtr = std::shared_ptr<const NameBinding>;
  struct Table {
    OwnerCount owners;
    PersistentVector<BindingPtr> bindings;  // null: not given
    ElementId first_weighed = 0;
    PersistentVector<std::uint64_t> weights;  // by id, from first_weighed on
    Hash128 hash;
    void Put(std::size_t index, NameBinding binding);
    void Weigh(ElementId id, std::uint64_t weight, const Entries& entries);
    void MakeRoomFor(ElementId id);
    friend void Destroy(Table* table) { delete table; }
  };
  Table& Own();
  CountedPointer<Table> table_;
};

}  // namespace tranos::model
