// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/solid_hash.h"

#include <vector>

namespace tranos::model {

namespace {

using geom::Solid;

bool IsKnown(const Solid& solid) {
  return solid.node().content_hash[0] != 0 || solid.node().content_hash[1] != 0;
}

void AddMesh(Hasher& hasher, const geom::TriangleMesh& mesh) {
  hasher.Integer(static_cast<std::int64_t>(mesh.positions.size()));
  for (const geom::Vec3& p : mesh.positions) hasher.Point(p);
  hasher.Integer(static_cast<std::int64_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) hasher.Integer(corner);
  }
  for (const std::uint32_t surface : mesh.surfaces) hasher.Integer(surface);
}

// Of a node whose parts are known.
Hash128 HashOfNode(const Solid::Node& node) {
  Hasher hasher;
  hasher.Tag(static_cast<std::uint8_t>(node.kind));
  hasher.Integer(static_cast<std::int64_t>(node.parts.size()));
  for (const Solid& part : node.parts) {
    hasher.Hash({part.node().content_hash[0], part.node().content_hash[1]});
  }
  if (node.kind == Solid::Kind::kMesh) AddMesh(hasher, node.mesh);
  if (node.kind == Solid::Kind::kTransformed) {
    for (int column = 0; column < 3; ++column) {
      hasher.Direction(node.target_from_source.linear().col(column));
    }
    hasher.Point(node.target_from_source.translation());
  }
  return hasher.Finish();
}

}  // namespace

Hash128 HashOf(const Solid& solid) {
  // A stack in place of recursion: a union in a loop is as deep as the loop is long.
  std::vector<const Solid*> open = {&solid};
  while (!open.empty()) {
    const Solid& next = *open.back();
    const std::size_t before = open.size();
    if (!IsKnown(next)) {
      for (const Solid& part : next.node().parts) {
        if (!IsKnown(part)) open.push_back(&part);
      }
    }
    if (open.size() > before) continue;
    open.pop_back();
    if (IsKnown(next)) continue;
    const Hash128 hash = HashOfNode(next.node());
    next.node().content_hash = {hash.high, hash.low};
  }
  return {solid.node().content_hash[0], solid.node().content_hash[1]};
}

}  // namespace tranos::model
