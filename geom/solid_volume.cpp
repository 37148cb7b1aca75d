// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>

#include "geom/box_tree.h"
#include "geom/solid.h"
#include "geom/union_find.h"

namespace tranos::geom {

namespace {

// Boxes that have more than a touch in common.
bool Overlap(const Box& a, const Box& b) {
  const Vec3 size = a.max.cwiseMin(b.max) - a.min.cwiseMax(b.min);
  return size.minCoeff() > kCoincident_m;
}

}  // namespace

Result<double> FilledVolume(const std::vector<Solid>& solids) {
  std::vector<Box> boxes;
  for (const Solid& solid : solids) {
    const auto facets = solid.Facets();  // so that the boxes are tight
    if (!facets) return tl::unexpected(facets.error());
    boxes.push_back(solid.Bounds());
  }
  const BoxTree tree(boxes);
  UnionFind lots(solids.size());
  for (std::uint32_t i = 0; i < solids.size(); ++i) {
    if (boxes[i].empty()) continue;
    tree.ForEachMeeting(boxes[i], [&](std::uint32_t other) {
      if (Overlap(boxes[i], boxes[other])) lots.Unite(i, other);
    });
  }
  std::map<std::uint32_t, std::vector<Solid>> members;
  for (std::uint32_t i = 0; i < solids.size(); ++i) members[lots.Root(i)].push_back(solids[i]);
  double sum_m3 = 0;
  for (auto& [root, lot] : members) {
    const auto facets = Solid::Union(std::move(lot)).Facets();
    if (!facets) return tl::unexpected(facets.error());
    sum_m3 += Volume(**facets);
  }
  return sum_m3;
}

}  // namespace tranos::geom
