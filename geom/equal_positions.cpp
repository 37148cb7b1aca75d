// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/equal_positions.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace tranos::geom {

std::vector<std::uint32_t> FirstOfEqual(const std::vector<Vec3>& positions) {
  std::vector<std::uint32_t> order(positions.size()), first(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    const Vec3& p = positions[i];
    return std::tuple(p.x(), p.y(), p.z(), i);
  };
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool equal = i > 0 && positions[order[i]] == positions[order[i - 1]];
    first[order[i]] = equal ? first[order[i - 1]] : order[i];
  }
  return first;
}

}  // namespace tranos::geom
