// SPDX-License-Identifier: GPL-3.0-or-later
// What a glTF file shows of photographs: orthophotos on faces and by themselves, and photographs as
// planes at their frames.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "output/gltf_tables.h"
#include "output/pasting.h"
#include "output/picture_plane.h"

namespace tranos::output {

class GlbPictures {
 public:
  GlbPictures(const model::Model& model, int threads, GlbTables* tables)
      : model_(model), threads_(threads), tables_(*tables), pasting_(model) {
    is_borne_.resize(pasting_.elements().size());
  }

  bool any() const { return !pasting_.elements().empty(); }
  bool Touch(const geom::Box& box, const geom::Affine& world_from_box) const {
    return pasting_.Touch(box, world_from_box);
  }
  // As Pasting::Split; what bears an orthophoto is noted.
  std::optional<SplitMesh> Split(const geom::Mesh& mesh, const geom::Affine& world_from_mesh,
                                 bool has_outside);
  // Bears its orthophoto; what is not seen of it has this colour.
  tinygltf::Primitive PrimitiveOf(const BearingMesh& bearing, const geom::Vec3& centre,
                                  const model::Rgb& beneath);
  // The nodes of orthophotos that no face bears: they stand by themselves.
  std::vector<int> AddUnborne();
  // The node of a photograph as a plane at its frame; -1 where its pixels are not at hand.
  Result<int> AddPhotographPlane(const model::Element& element,
                                 const model::Photograph& photograph);
  double PlaneDepth_m(const model::Photograph& photograph);

  // Makes the pictures of all materials asked for, one orthophoto at a time.
  std::optional<Error> MakePictures();

 private:
  const model::Model& model_;
  int threads_;
  GlbTables& tables_;
  Pasting pasting_;
  std::vector<bool> is_borne_;        // by orthophoto
  std::optional<geom::Box> visible_;  // around all that is; once asked for
  std::map<std::pair<std::size_t, std::uint32_t>, int> materials_;  // by orthophoto and colour
};

}  // namespace tranos::output
