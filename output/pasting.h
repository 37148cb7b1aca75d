// SPDX-License-Identifier: GPL-3.0-or-later
// Orthophotos on the faces that lie in their planes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geom/surface.h"
#include "model/state.h"
#include "output/orthophoto.h"

namespace tranos::output {

// Triangles that bear an orthophoto, with a place on its picture for each position: (0, 0) the
// upper left corner, (1, 1) the lower right one.
struct BearingMesh {
  std::size_t orthophoto;  // its index in the pasting
  geom::Mesh mesh;
  std::vector<geom::Vec2> places;
};
struct SplitMesh {
  geom::Mesh plain;
  std::vector<BearingMesh> bearing;
};

// A model's orthophotos whose photographs are at hand. Where two lie in one place, the later one is
// seen.
class Pasting {
 public:
  explicit Pasting(const model::Model& model);

  const std::vector<model::ElementPtr>& elements() const { return elements_; }
  const model::Orthophoto& At(std::size_t index) const;
  // The mesh cut along the orthophotos' borders where its triangles lie in their planes; nothing
  // where none of them does.
  std::optional<SplitMesh> Split(const geom::Mesh& mesh, const geom::Affine& world_from_mesh) const;

 private:
  std::vector<model::ElementPtr> elements_;
};

// The orthophoto with what is not seen of it in this colour, opaque.
Picture OverColour(const Picture& picture, const model::Rgb& colour);

}  // namespace tranos::output
