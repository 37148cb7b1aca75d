// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes in a binary tree, to find those that meet a box or a ray. Internal to geom.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/primitives.h"

namespace tranos::geom {

class BoxTree {
 public:
  explicit BoxTree(const std::vector<Box>& boxes);

  // Calls visit(index) for every box that meets `box`, touching included.
  template <class Visit>
  void ForEachMeeting(const Box& box, Visit&& visit) const {
    Walk([&](const Box& b) { return Meet(b, box); }, visit);
  }
  // … that the ray from `origin` meets; a hair wider than the boxes, so that none is missed.
  template <class Visit>
  void ForEachOnRay(const Vec3& origin, const Vec3& direction, Visit&& visit) const {
    const Vec3 inverse = direction.cwiseInverse();
    Walk([&](const Box& b) { return OnRay(b, origin, inverse); }, visit);
  }

  static bool Meet(const Box& a, const Box& b) {
    return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
  }

 private:
  struct Node {
    Box box;
    std::uint32_t first;  // of its indices, or its right child; the left one follows the node
    std::uint32_t count;  // of indices; 0 for an inner node
  };
  void Build(const std::vector<Box>& boxes, std::uint32_t first, std::uint32_t count);
  // No component of the ray's direction is zero.
  static bool OnRay(const Box& b, const Vec3& origin, const Vec3& inverse_direction);
  template <class Meets, class Visit>
  void Walk(const Meets& meets, Visit& visit) const {
    std::uint32_t stack[64];
    int depth = 0;
    if (!nodes_.empty()) stack[depth++] = 0;
    while (depth > 0) {
      const std::uint32_t at = stack[--depth];
      const Node& node = nodes_[at];
      if (!meets(node.box)) continue;
      if (node.count == 0) {
        stack[depth++] = node.first;
        stack[depth++] = at + 1;
        continue;
      }
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        if (meets(boxes_[i])) visit(order_[i]);
      }
    }
  }

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
  std::vector<Box> boxes_;  // in the tree's order
};

}  // namespace tranos::geom
