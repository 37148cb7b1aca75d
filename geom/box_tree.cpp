// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/box_tree.h"

#include <algorithm>
#include <numeric>

namespace tranos::geom {

namespace {

constexpr std::uint32_t kLeafSize = 4;

}  // namespace

BoxTree::BoxTree(const std::vector<Box>& boxes) : order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.reserve(boxes.size());
  if (!boxes.empty()) Build(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
  boxes_.reserve(boxes.size());
  for (const std::uint32_t i : order_) boxes_.push_back(boxes[i]);
}

// Halves at the median of the centres along the longest side, so that the depth is that of a
// balanced tree: below 64 for any number of boxes that an index can count.
void BoxTree::Build(const std::vector<Box>& boxes, std::uint32_t first, std::uint32_t count) {
  const std::size_t at = nodes_.size();
  Box box, centres;
  for (std::uint32_t i = first; i < first + count; ++i) {
    box.Add(boxes[order_[i]]);
    centres.Add(boxes[order_[i]].centre());
  }
  nodes_.push_back({box, first, count});
  if (count <= kLeafSize) return;
  int axis = 0;
  (centres.max - centres.min).maxCoeff(&axis);
  const std::uint32_t half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    const double ca = boxes[a].min[axis] + boxes[a].max[axis];
    const double cb = boxes[b].min[axis] + boxes[b].max[axis];
    return ca != cb ? ca < cb : a < b;
  });
  Build(boxes, first, half);
  nodes_[at].first = static_cast<std::uint32_t>(nodes_.size());
  nodes_[at].count = 0;
  Build(boxes, first + half, count - half);
}

bool BoxTree::OnRay(const Box& b, const Vec3& origin, const Vec3& inverse_direction) {
  constexpr double kHair = 1e-12;
  const double hair = kHair * (1 + b.min.cwiseAbs().maxCoeff() + b.max.cwiseAbs().maxCoeff() +
                               origin.cwiseAbs().maxCoeff());
  const Vec3 t0 = ((b.min - origin).array() - hair) * inverse_direction.array();
  const Vec3 t1 = ((b.max - origin).array() + hair) * inverse_direction.array();
  const double enter = t0.cwiseMin(t1).maxCoeff(), leave = t0.cwiseMax(t1).minCoeff();
  return leave >= 0 && enter <= leave;
}

}  // namespace tranos::geom
