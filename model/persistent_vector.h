// SPDX-License-Identifier: GPL-3.0-or-later
// A vector whose every version stays valid and shares structure with the others: the state before
// a step costs three words, not a copy. Append is O(1), Set O(log₃₂ n).
//
// A radix tree of 32-way nodes with a tail. Versions share the tail: a version sees only the slots
// below its size, so the newest version may append into free slots without copying. An older
// version that appends finds the slot claimed and copies the tail then. What one version alone
// owns is changed in place, so that many changes of one step copy a path once.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "model/counted_pointer.h"

namespace tranos::model {

template <class T>
class PersistentVector {
 public:
  static constexpr unsigned kBits = 5;
  static constexpr std::size_t kWidth = std::size_t{1} << kBits;

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  const T& operator[](std::size_t index) const {
    if (index >= tree_size()) return AsLeaf(*tail_).items[index & kMask];
    const Block* node = root_.get();
    for (unsigned shift = node->shift; shift > 0; shift -= kBits) {
      node = AsInner(*node).children[(index >> shift) & kMask].get();
    }
    return AsLeaf(*node).items[index & kMask];
  }
  const T& back() const { return (*this)[size_ - 1]; }

  void Append(T item) {
    if (tail_ && tail_size() == kWidth) PushTail();
    const auto used = static_cast<std::uint32_t>(size_ & kMask);
    if (!tail_ || !Claim(AsLeaf(*tail_), used)) {
      tail_ = CopyOfTail(used);
      AsLeaf(*tail_).used.store(used + 1, std::memory_order_relaxed);
    }
    AsLeaf(*tail_).items[used] = std::move(item);
    ++size_;
  }

  void Set(std::size_t index, T item) {
    if (index >= tree_size()) {
      if (!tail_.unique()) tail_ = CopyOfTail(static_cast<std::uint32_t>(tail_size()));
      AsLeaf(*tail_).items[index & kMask] = std::move(item);
      return;
    }
    Pointer* at = &root_;
    for (unsigned shift = root_->shift; shift > 0; shift -= kBits) {
      at = &Own<Inner>(*at).children[(index >> shift) & kMask];
    }
    Own<Leaf>(*at).items[index & kMask] = std::move(item);
  }

  // Calls f(item) for each item in order.
  template <class F>
  void ForEach(F&& f) const {
    if (root_) ForEachIn(*root_, f);
    for (std::size_t i = 0; i < tail_size(); ++i) f(AsLeaf(*tail_).items[i]);
  }

 private:
  static constexpr std::size_t kMask = kWidth - 1;

  struct Block {
    OwnerCount owners;
    unsigned shift = 0;  // bits below a slot of this node; 0 for a leaf
    friend void Destroy(Block* block) {
      if (block->shift == 0) {
        delete static_cast<Leaf*>(block);
      } else {
        delete static_cast<Inner*>(block);
      }
    }
  };
  using Pointer = CountedPointer<Block>;
  struct Leaf : Block {
    Leaf() = default;
    Leaf(const Leaf& other) : Block(other), items(other.items) { used.store(kWidth); }
    std::atomic<std::uint32_t> used{0};  // slots that some version has filled
    std::array<T, kWidth> items{};
  };
  struct Inner : Block {
    explicit Inner(unsigned bits) { this->shift = bits; }
    std::array<Pointer, kWidth> children{};
  };
  static Leaf& AsLeaf(Block& block) { return static_cast<Leaf&>(block); }
  static const Leaf& AsLeaf(const Block& block) { return static_cast<const Leaf&>(block); }
  static const Inner& AsInner(const Block& block) { return static_cast<const Inner&>(block); }

  std::size_t tail_size() const { return size_ == 0 ? 0 : ((size_ - 1) & kMask) + 1; }
  std::size_t tree_size() const { return size_ - tail_size(); }

  static bool Claim(Leaf& leaf, std::uint32_t slot) {
    return leaf.used.compare_exchange_strong(slot, slot + 1, std::memory_order_acq_rel);
  }
  Pointer CopyOfTail(std::uint32_t count) const {
    auto* copy = new Leaf;
    for (std::uint32_t i = 0; i < count; ++i) copy->items[i] = AsLeaf(*tail_).items[i];
    copy->used.store(count, std::memory_order_relaxed);
    return Pointer(copy);
  }
  // The node behind `pointer`, which no other version sees after this.
  template <class Node>
  static Node& Own(Pointer& pointer) {
    if (!pointer.unique()) pointer = Pointer(new Node(static_cast<const Node&>(*pointer)));
    return static_cast<Node&>(*pointer);
  }
  // Moves the full tail into the tree, which grows by a level when it is full.
  void PushTail() {
    const std::size_t index = size_ - kWidth;
    if (!root_) {
      root_ = Pointer(new Inner(kBits));
    } else if (index == kWidth << root_->shift) {
      auto* taller = new Inner(root_->shift + kBits);
      taller->children[0] = std::move(root_);
      root_ = Pointer(taller);
    }
    Pointer* at = &root_;
    for (unsigned shift = root_->shift; shift > 0; shift -= kBits) {
      if (!*at) *at = Pointer(new Inner(shift));
      at = &Own<Inner>(*at).children[(index >> shift) & kMask];
    }
    *at = std::move(tail_);
  }
  template <class F>
  static void ForEachIn(const Block& block, F& f) {
    if (block.shift == 0) {
      for (const T& item : AsLeaf(block).items) f(item);
      return;
    }
    for (const Pointer& child : AsInner(block).children) {
      if (child) ForEachIn(*child, f);
    }
  }

  Pointer root_;
  Pointer tail_;
  std::size_t size_ = 0;
};

}  // namespace tranos::model
