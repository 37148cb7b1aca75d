// SPDX-License-Identifier: GPL-3.0-or-later
// The visible part of a model as facets: each part once, however often it is placed.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/state.h"
#include "output/facets.h"
#include "output/ray_scene.h"

namespace tranos::output {

// Where a part stands and how it looks.
struct Placement {
  std::size_t part;
  geom::Affine world_from_part;
  model::Colour colour;
  int linestyle, weight;
  std::string material;
  model::ElementId element;  // of the model, to which it belongs
};
// What is shared by all its placements.
struct Part {
  const model::Element* element = nullptr;
  double largest_scale = 0;  // of its placements
  geom::Box box;
  Facets facets;
  geom::Vec3 centre = geom::Vec3::Zero();
  std::shared_ptr<const RayMesh> ray_mesh;  // about the centre; null without faces
};
struct Parts {
  std::vector<Part> parts;
  std::vector<Placement> placements;  // in the order of elements
};

// Everything on levels that are on, with boxes and without facets.
Parts VisibleParts(const model::Model& model, int threads);

// In single precision about a centre.
std::shared_ptr<const RayMesh> RayMeshOf(const geom::Mesh& mesh, const geom::Vec3& centre);

// Gives the part its facets and its mesh; as placed they deviate from it by `chord_m` at most.
std::optional<Error> MakeFacets(Part& part, double chord_m);
// All of them; the error is that of the first part that has one.
std::optional<Error> MakeFacets(Parts& parts, double chord_m, int threads);

// Around all placements' boxes.
geom::Box BoxInWorld(const Parts& parts);

}  // namespace tranos::output
