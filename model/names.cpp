// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/names.h"

namespace tranos::model {

namespace {

// An odd number for the position-th element of a name, far from those of its neighbours
// (the finishing steps of splitmix64).
std::uint64_t WeightOf(std::size_t index, std::size_t position) {
  std::uint64_t mixed = (std::uint64_t{index} << 32) + position + 0x9e3779b97f4a7c15;
  mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9;
  mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111eb;
  return (mixed ^ (mixed >> 31)) | 1;
}

// A name that is given weighs something even if it stands for an empty list.
constexpr std::size_t kGivenPosition = 0xffffffff;
constexpr Hash128 kGivenContent = {1, 1};

void AddWeighed(Hash128& sum, std::uint64_t weight, const Hash128& content) {
  sum.high += weight * content.high;
  sum.low += weight * content.low;
}

}  // namespace

const NameBinding& Names::operator[](std::size_t index) const {
  static const NameBinding kNotGiven;
  return index < size() && table_->bindings[index] ? *table_->bindings[index] : kNotGiven;
}

Names::Table& Names::Own() {
  if (!table_) {
    table_ = CountedPointer<Table>(new Table);
  } else if (!table_.unique()) {
    table_ = CountedPointer<Table>(new Table(*table_));
  }
  return *table_;
}

void Names::Table::MakeRoomFor(ElementId id) {
  if (weights.empty()) first_weighed = id;
  if (id < first_weighed) {
    PersistentVector<std::uint64_t> wider;
    for (ElementId i = id; i < first_weighed; ++i) wider.Append(0);
    weights.ForEach([&](std::uint64_t weight) { wider.Append(weight); });
    weights = std::move(wider);
    first_weighed = id;
  }
  while (weights.size() <= id - first_weighed) weights.Append(0);
}

void Names::Table::Weigh(ElementId id, std::uint64_t weight, const Entries& entries) {
  AddWeighed(hash, weight, ContentOf(entries[id]));
  if (!weights.empty() && id == first_weighed + weights.size()) {
    weights.Append(weight);
    return;
  }
  MakeRoomFor(id);
  const std::size_t slot = id - first_weighed;
  weights.Set(slot, weights[slot] + weight);
}

void Names::Table::Put(std::size_t index, NameBinding binding) {
  auto pointer = std::make_shared<const NameBinding>(std::move(binding));
  while (bindings.size() < index) bindings.Append(nullptr);
  if (bindings.size() == index) {
    bindings.Append(std::move(pointer));
  } else {
    bindings.Set(index, std::move(pointer));
  }
}

void Names::Bind(std::size_t index, ElementId id, const Entries& entries) {
  NameBinding binding = (*this)[index];
  Table& table = Own();
  if (!binding.given) AddWeighed(table.hash, WeightOf(index, kGivenPosition), kGivenContent);
  table.Weigh(id, WeightOf(index, binding.ids.size()), entries);
  binding.ids.Append(id);
  binding.given = true;
  table.Put(index, std::move(binding));
}

void Names::Set(std::size_t index, NameBinding binding, const Entries& entries) {
  const NameBinding before = (*this)[index];
  Table& table = Own();
  std::size_t position = 0;
  before.ids.ForEach(
      [&](ElementId id) { table.Weigh(id, 0 - WeightOf(index, position++), entries); });
  position = 0;
  binding.ids.ForEach([&](ElementId id) { table.Weigh(id, WeightOf(index, position++), entries); });
  const std::uint64_t given = WeightOf(index, kGivenPosition);
  if (before.given) AddWeighed(table.hash, 0 - given, kGivenContent);
  if (binding.given) AddWeighed(table.hash, given, kGivenContent);
  table.Put(index, std::move(binding));
}

void Names::Rehash(const Entries& entries) {
  if (!table_) return;
  const PersistentVector<BindingPtr> bindings = table_->bindings;
  table_ = {};
  for (std::size_t index = 0; index < bindings.size(); ++index) {
    if (bindings[index]) Set(index, *bindings[index], entries);
  }
}

void Names::Follow(ElementId id, const Hash128& before, const Hash128& after) {
  if (!table_ || id < table_->first_weighed) return;
  const std::size_t slot = id - table_->first_weighed;
  if (slot >= table_->weights.size() || table_->weights[slot] == 0) return;
  const std::uint64_t weight = table_->weights[slot];
  Table& table = Own();
  AddWeighed(table.hash, 0 - weight, before);
  AddWeighed(table.hash, weight, after);
}

}  // namespace tranos::model
