// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/parts.h"

#include <algorithm>
#include <unordered_map>

#include "output/parallel.h"

namespace tranos::output {
using geom::Affine;
using geom::Vec3;

std::shared_ptr<const RayMesh> RayMeshOf(const geom::Mesh& mesh, const Vec3& centre) {
  const auto result = std::make_shared<RayMesh>();
  const auto rounded = [](const Vec3& v) {
    return std::array<float, 3>{static_cast<float>(v.x()), static_cast<float>(v.y()),
                                static_cast<float>(v.z())};
  };
  for (const Vec3& p : mesh.positions) result->positions.push_back(rounded(p - centre));
  for (const Vec3& n : mesh.normals) result->normals.push_back(rounded(n));
  result->triangles = mesh.triangles;
  return result;
}

Parts VisibleParts(const model::Model& model, int threads) {
  Parts result;
  std::unordered_map<const model::Element*, std::size_t> known;
  model.ForEach([&](const model::ElementPtr& element) {
    model::ForEachLeaf(*element, [&](const model::Element& leaf, const Affine& world_from_leaf,
                                     const model::Attributes& attributes) {
      if (!model.LevelIsOn(attributes.level)) return;
      const auto [entry, is_new] = known.try_emplace(&leaf, result.parts.size());
      if (is_new) result.parts.emplace_back().element = &leaf;
      Part& part = result.parts[entry->second];
      part.largest_scale =
          std::max(part.largest_scale, world_from_leaf.linear().colwise().norm().maxCoeff());
      result.placements.push_back({entry->second, world_from_leaf, attributes.colour,
                                   attributes.linestyle, attributes.weight, attributes.material,
                                   element->id});
    });
  });
  ParallelFor(result.parts.size(), threads, [&](std::size_t i) {
    result.parts[i].box = model::BoundingBox(*result.parts[i].element);
  });
  return result;
}

std::optional<Error> MakeFacets(Part& part, double chord_m) {
  const geom::Tolerance tolerance = {chord_m / std::max(part.largest_scale, 1e-12),
                                     part.element->tolerance.facets_per_turn};
  Result<Facets> facets = FacetsOf(*part.element, tolerance);
  if (!facets) return facets.error();
  part.facets = *std::move(facets);
  if (part.facets.mesh.triangles.empty()) return std::nullopt;
  part.centre = part.box.centre();
  part.ray_mesh = RayMeshOf(part.facets.mesh, part.centre);
  return std::nullopt;
}

std::optional<Error> MakeFacets(Parts& parts, double chord_m, int threads) {
  std::vector<std::optional<Error>> errors(parts.parts.size());
  ParallelFor(parts.parts.size(), threads,
              [&](std::size_t i) { errors[i] = MakeFacets(parts.parts[i], chord_m); });
  for (const std::optional<Error>& error : errors) {
    if (error) return error;
  }
  return std::nullopt;
}

geom::Box BoxInWorld(const Parts& parts) {
  geom::Box world;
  for (const Placement& placement : parts.placements) {
    world.Add(geom::Carried(parts.parts[placement.part].box, placement.world_from_part));
  }
  return world;
}

}  // namespace tranos::output
