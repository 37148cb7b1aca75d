// SPDX-License-Identifier: GPL-3.0-or-later
// The faces of what has any, as facets.
#pragma once

#include "geom/surface.h"
#include "model/state.h"

namespace tranos::model {

// Whether a leaf has faces: a surface, a region or a solid.
bool HasFaces(const Element& leaf);
// Whether its faces have an outer side, to which their normals point: those of a solid do.
bool HasOutside(const Element& leaf);

// Its faces in its own frame, with unit normals and three different corners to each triangle; none
// for what has no faces. Errors of geom's facets.
geom::Result<geom::Mesh> FacesOf(const Element& leaf, const geom::Tolerance& tolerance);

// Calls f(leaf, world_from_leaf, attributes) for every leaf with faces whose level is on.
template <class F>
void ForEachWithFaces(const Model& model, F&& f) {
  model.ForEach([&](const ElementPtr& element) {
    ForEachLeaf(*element, [&](const Element& leaf, const geom::Affine& world_from_leaf,
                              const Attributes& attributes) {
      if (HasFaces(leaf) && model.LevelIsOn(attributes.level)) f(leaf, world_from_leaf, attributes);
    });
  });
}
// Of a leaf as it stands.
void AddToHash(Hasher& hasher, const Element& leaf, const geom::Affine& world_from_leaf);

}  // namespace tranos::model
