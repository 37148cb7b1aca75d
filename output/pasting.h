// SPDX-License-Identifier: GPL-3.0-or-later
// Orthophotos on the faces that lie in their planes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geom/surface.h"
#include "model/state.h"

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
  std::vector<std::size_t> borne;  // the orthophotos on it, those that later ones cover, too
};

// A model's orthophotos whose photographs are at hand. Where two lie in one place, the later one is
// seen, and through what is not seen of it the earlier one.
class Pasting {
 public:
  explicit Pasting(const model::Model& model);

  const std::vector<model::ElementPtr>& elements() const { return elements_; }
  const model::OrthophotoPtr& Shared(std::size_t index) const;
  const model::Orthophoto& At(std::size_t index) const { return *Shared(index); }
  // Whether the box comes so near to any of them that a face in it may bear it.
  bool Touch(const geom::Box& box, const geom::Affine& world_from_box) const;
  // The mesh cut along the orthophotos' borders where its triangles bear them; nothing where none
  // does. `has_outside`: normals point to the outer side, which alone bears anything.
  std::optional<SplitMesh> Split(const geom::Mesh& mesh, const geom::Affine& world_from_mesh,
                                 bool has_outside) const;

 private:
  std::vector<model::ElementPtr> elements_;
};

// The corners of an orthophoto in the world: the lower left one, and on anticlockwise.
std::array<geom::Vec3, 4> CornersOf(const model::Orthophoto& orthophoto);
// Whether the box comes so near to it that a face in it may bear it.
bool Touches(const model::Orthophoto& orthophoto, const geom::Box& box,
             const geom::Affine& world_from_box);
// Whether an orthophoto would bear another one, as a face does.
bool LiesIn(const model::Orthophoto& over, const model::Orthophoto& beneath);

}  // namespace tranos::output
