// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/faces.h"

#include <utility>

namespace tranos::model {
namespace {

using geom::Vec3;

// A surface has no normal where it is singular (the pole of a dome, say): there the facets that
// meet in the vertex give one.
void CompleteNormals(geom::Mesh& mesh) {
  std::vector<Vec3> sums;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    if (mesh.normals[i].squaredNorm() > 0.5) continue;
    if (sums.empty()) {
      sums.assign(mesh.positions.size(), Vec3::Zero());
      for (const auto& t : mesh.triangles) {
        const Vec3& p = mesh.positions[t[0]];
        const Vec3 n = (mesh.positions[t[1]] - p).cross(mesh.positions[t[2]] - p);
        for (const std::uint32_t corner : t) sums[corner] += n;
      }
    }
    mesh.normals[i] = sums[i];
  }
  for (Vec3& n : mesh.normals) {
    const double length = n.norm();
    n = length > 0 ? Vec3(n / length) : Vec3::UnitZ();
  }
}

bool HasThreeCorners(const std::array<std::uint32_t, 3>& t) {
  return t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
}

geom::Result<geom::Mesh> Faces(const geom::Surface& surface, const geom::Tolerance& tolerance) {
  auto mesh = geom::Tessellate(surface, tolerance);
  if (!mesh) return mesh;
  std::erase_if(mesh->triangles, [](const auto& t) { return !HasThreeCorners(t); });
  CompleteNormals(*mesh);
  return mesh;
}

geom::Result<geom::Mesh> Faces(const geom::Solid& solid) {
  const auto mesh = solid.Facets();
  if (!mesh) return tl::unexpected(mesh.error());
  return geom::FacetsOf(**mesh);
}

geom::Result<geom::Mesh> Faces(const geom::Region& region, const geom::Tolerance& tolerance) {
  auto flat = geom::Triangulate(region, tolerance);
  if (!flat) return tl::unexpected(flat.error());
  geom::Mesh mesh;
  mesh.normals.assign(flat->positions.size(), region.plane.z());
  mesh.positions = std::move(flat->positions);
  mesh.triangles = std::move(flat->triangles);
  for (const auto& loop : flat->loops) {
    for (std::uint32_t i = loop.begin; i < loop.end; ++i) {
      mesh.edges.push_back({i, i + 1 < loop.end ? i + 1 : loop.begin});
    }
  }
  return mesh;
}

}  // namespace

bool HasFaces(const Element& leaf) {
  return std::holds_alternative<SurfacePtr>(leaf.geometry) ||
         std::holds_alternative<RegionPtr>(leaf.geometry) || HasOutside(leaf);
}

void AddToHash(Hasher& hasher, const Element& leaf, const geom::Affine& world_from_leaf) {
  hasher.Hash(leaf.hash).Point(world_from_leaf.translation());
  for (int i = 0; i < 3; ++i) hasher.Direction(world_from_leaf.linear().col(i));
}

bool HasOutside(const Element& leaf) { return std::holds_alternative<SolidPtr>(leaf.geometry); }

geom::Result<geom::Mesh> FacesOf(const Element& leaf, const geom::Tolerance& tolerance) {
  if (const auto* surface = std::get_if<SurfacePtr>(&leaf.geometry)) {
    return Faces(**surface, tolerance);
  }
  if (const auto* solid = std::get_if<SolidPtr>(&leaf.geometry)) return Faces(**solid);
  if (const auto* region = std::get_if<RegionPtr>(&leaf.geometry))
    return Faces(**region, tolerance);
  return geom::Mesh{};
}

}  // namespace tranos::model
