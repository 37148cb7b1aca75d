// SPDX-License-Identifier: GPL-3.0-or-later
// A vector whose every version stays valid and shares structure with the others: the state before
// a step costs a few words, not a copy. Append is O(1), set O(log₃₂ n).
//
// A radix tree of 32-way nodes with a tail. Versions share the tail's buffer: a version sees only the
// first `tail_size_` slots, so the newest version may append into free slots without copying. An
// older version that appends finds the slot taken and copies the tail then.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <variant>

namespace tranos::model {

template <class T>
class PersistentVector {
 public:
  static constexpr std::size_t kBits = 5, kWidth = std::size_t{1} << kBits;

  std::size_t size() const { return tree_size_ + tail_size_; }
  bool empty() const { return size() == 0; }

  const T& operator[](std::size_t index) const {
    if (index >= tree_size_) return tail_->items[index - tree_size_];
    const Node* node = root_.get();
    for (unsigned shift = shift_; shift > 0; shift -= kBits) {
      node = std::get<Children>(node->content)[(index >> shift) & kMask].get();
    }
    return std::get<LeafPtr>(node->content)->items[index & kMask];
  }
  const T& back() const { return (*this)[size() - 1]; }

  void Append(T item) {
    if (tail_size_ == kWidth) PushTail();
    if (!tail_ || tail_->used != tail_size_) {
      auto copy = std::make_shared<Leaf>();
      for (std::size_t i = 0; i < tail_size_; ++i) copy->items[i] = tail_->items[i];
      copy->used = tail_size_;
      tail_ = std::move(copy);
    }
    tail_->items[tail_size_] = std::move(item);
    tail_->used = ++tail_size_;
  }

  void Set(std::size_t index, T item) {
    if (index >= tree_size_) {
      auto copy = std::make_shared<Leaf>();
      for (std::size_t i = 0; i < tail_size_; ++i) copy->items[i] = tail_->items[i];
      copy->used = tail_size_;
      copy->items[index - tree_size_] = std::move(item);
      tail_ = std::move(copy);
      return;
    }
    root_ = SetIn(*root_, shift_, index, std::move(item));
  }

  // Calls f(item) for each item in order.
  template <class F>
  void ForEach(F&& f) const {
    if (root_) ForEachIn(*root_, f);
    for (std::size_t i = 0; i < tail_size_; ++i) f(tail_->items[i]);
  }

 private:
  static constexpr std::size_t kMask = kWidth - 1;
  struct Leaf {
    std::array<T, kWidth> items{};
    std::size_t used = 0;  // slots that some version has filled
  };
  using LeafPtr = std::shared_ptr<Leaf>;
  struct Node;
  using NodePtr = std::shared_ptr<const Node>;
  using Children = std::array<NodePtr, kWidth>;
  struct Node {
    std::variant<Children, LeafPtr> content;
  };

  // Moves the full tail into the tree, which grows by a level when it is full.
  void PushTail() {
    auto leaf = std::make_shared<const Node>(Node{tail_});
    if (!root_) {
      root_ = std::move(leaf);
      shift_ = 0;
    } else if (tree_size_ == kWidth << shift_) {
      Children children;
      children[0] = root_;
      children[1] = NewPath(shift_, std::move(leaf));
      root_ = std::make_shared<const Node>(Node{std::move(children)});
      shift_ += kBits;
    } else {
      root_ = PushIn(*root_, shift_, std::move(leaf));
    }
    tree_size_ += kWidth;
    tail_ = nullptr;
    tail_size_ = 0;
  }
  static NodePtr NewPath(unsigned shift, NodePtr node) {
    for (; shift > 0; shift -= kBits) {
      Children children;
      children[0] = std::move(node);
      node = std::make_shared<const Node>(Node{std::move(children)});
    }
    return node;
  }
  NodePtr PushIn(const Node& node, unsigned shift, NodePtr leaf) const {
    Children children = std::get<Children>(node.content);
    const std::size_t slot = (tree_size_ >> shift) & kMask;
    const unsigned below = shift - kBits;
    if (below == 0) {
      children[slot] = std::move(leaf);
    } else if (children[slot]) {
      children[slot] = PushIn(*children[slot], below, std::move(leaf));
    } else {
      children[slot] = NewPath(below, std::move(leaf));
    }
    return std::make_shared<const Node>(Node{std::move(children)});
  }
  static NodePtr SetIn(const Node& node, unsigned shift, std::size_t index, T item) {
    if (shift == 0) {
      auto leaf = std::make_shared<Leaf>(*std::get<LeafPtr>(node.content));
      leaf->items[index & kMask] = std::move(item);
      return std::make_shared<const Node>(Node{std::move(leaf)});
    }
    Children children = std::get<Children>(node.content);
    const std::size_t slot = (index >> shift) & kMask;
    children[slot] = SetIn(*children[slot], shift - kBits, index, std::move(item));
    return std::make_shared<const Node>(Node{std::move(children)});
  }
  template <class F>
  static void ForEachIn(const Node& node, F& f) {
    if (const auto* leaf = std::get_if<LeafPtr>(&node.content)) {
      for (const T& item : (*leaf)->items) f(item);
      return;
    }
    for (const NodePtr& child : std::get<Children>(node.content)) {
      if (child) ForEachIn(*child, f);
    }
  }

  NodePtr root_;
  LeafPtr tail_;
  std::size_t tree_size_ = 0;
  std::size_t tail_size_ = 0;
  unsigned shift_ = 0;  // bits below the root's slot
};

}  // namespace tranos::model
