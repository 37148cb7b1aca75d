// SPDX-License-Identifier: GPL-3.0-or-later
// Sets that grow together. Internal to geom.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace tranos::geom {

class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  // The smallest member of the set.
  std::uint32_t Root(std::uint32_t i) const {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void Unite(std::uint32_t a, std::uint32_t b) {
    a = Root(a), b = Root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  mutable std::vector<std::uint32_t> parent_;  // paths are shortened as they are walked
};

}  // namespace tranos::geom
