// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/boolean.h"

namespace tranos::geom {
namespace {

using Kind = Solid::Kind;

void Append(const TriangleMesh& mesh, TriangleMesh* all) {
  const auto first = static_cast<std::uint32_t>(all->positions.size());
  std::uint32_t surfaces = 0;
  for (const std::uint32_t s : all->surfaces) surfaces = std::max(surfaces, s + 1);
  all->positions.insert(all->positions.end(), mesh.positions.begin(), mesh.positions.end());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    all->triangles.push_back({first + a, first + b, first + c});
    all->surfaces.push_back(surfaces + mesh.surfaces[i]);
  }
}

}  // namespace

Result<TriangleMesh> Evaluate(const Solid& solid) {
  const Solid::Node& node = solid.node();
  if (node.kind == Kind::kMesh) return node.mesh;
  TriangleMesh all;
  for (const Solid& part : node.parts) {
    const auto mesh = Evaluate(part);
    if (!mesh) return mesh;
    Append(*mesh, &all);
    if (node.kind == Kind::kDifference) break;
    if (node.kind == Kind::kIntersection) return TriangleMesh{};
  }
  if (node.kind != Kind::kTransformed) return all;
  for (Vec3& p : all.positions) p = node.target_from_source * p;
  if (node.target_from_source.linear().determinant() < 0) {
    for (auto& t : all.triangles) std::swap(t[1], t[2]);
  }
  return all;
}

}  // namespace tranos::geom
