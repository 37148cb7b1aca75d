// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <map>

#include "geom/box_tree.h"
#include "geom/solid.h"
#include "geom/solid_rounding.h"
#include "geom/union_find.h"

namespace tranos::geom {

namespace {

// Boxes that have more than a touch in common.
bool Overlap(const Box& a, const Box& b) {
  const Vec3 size = a.max.cwiseMin(b.max) - a.min.cwiseMax(b.min);
  return size.minCoeff() > kCoincident_m;
}

Result<double> VolumeOfSeveral(const std::vector<PlacedSolid>& solids,
                               const std::vector<std::uint32_t>& lot) {
  std::vector<Solid> parts;
  for (const std::uint32_t i : lot) {
    // Of the facets as they are, that what they were made from is not gone through again.
    auto part =
        Solid::FromMesh(Transformed(**solids[i].solid.Facets(), solids[i].world_from_solid));
    if (!part) return tl::unexpected(part.error());
    parts.push_back(*std::move(part));
  }
  const auto facets = Solid::Union(std::move(parts)).Facets();
  if (!facets) return tl::unexpected(facets.error());
  return Volume(**facets);
}

}  // namespace

Result<double> Solid::FilledVolume() const {
  if (node_->filled_m3 >= 0) return node_->filled_m3;
  const auto facets = Facets();
  if (!facets) return tl::unexpected(facets.error());
  double volume_m3 = Volume(**facets);
  if ((*facets)->may_cross && HasSelfIntersection(**facets)) {
    const auto uncrossed = Uncrossed(**facets);
    if (!uncrossed) return tl::unexpected(uncrossed.error());
    volume_m3 = Volume(*uncrossed);
  }
  node_->filled_m3 = volume_m3;
  return volume_m3;
}

Result<double> FilledVolume(const std::vector<PlacedSolid>& solids) {
  std::vector<Box> boxes;
  for (const PlacedSolid& solid : solids) {
    const auto facets = solid.solid.Facets();
    if (!facets) return tl::unexpected(facets.error());
    boxes.emplace_back();
    for (const Vec3& p : (*facets)->positions) boxes.back().Add(solid.world_from_solid * p);
  }
  const BoxTree tree(boxes);
  UnionFind lots(solids.size());
  for (std::uint32_t i = 0; i < solids.size(); ++i) {
    if (boxes[i].empty()) continue;
    tree.ForEachMeeting(boxes[i], [&](std::uint32_t other) {
      if (Overlap(boxes[i], boxes[other])) lots.Unite(i, other);
    });
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> members;
  for (std::uint32_t i = 0; i < solids.size(); ++i) {
    if (!boxes[i].empty()) members[lots.Root(i)].push_back(i);
  }
  double sum_m3 = 0;
  for (const auto& [root, lot] : members) {
    const PlacedSolid& first = solids[lot[0]];
    auto volume_m3 = lot.size() > 1 ? VolumeOfSeveral(solids, lot) : first.solid.FilledVolume();
    if (!volume_m3) return volume_m3;
    if (lot.size() == 1) *volume_m3 *= std::abs(first.world_from_solid.linear().determinant());
    sum_m3 += *volume_m3;
  }
  return sum_m3;
}

}  // namespace tranos::geom
