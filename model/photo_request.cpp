// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/photo_request.h"

#include "model/edit.h"
#include "model/faces.h"

namespace tranos::model {

// A sum over the faces, as they stand and look: nothing else is seen on a photograph.
static Hash128 HashOfFaces(const Model& model) {
  Hash128 sum;
  ForEachWithFaces(model, [&](const Element& leaf, const geom::Affine& world_from_leaf,
                              const Attributes& attributes) {
    Hasher hasher;
    AddToHash(hasher, leaf, world_from_leaf);
    AddToHash(hasher, attributes);
    sum = sum + hasher.Finish();
  });
  return sum;
}

Hash128 HashOf(const PhotoRequest& request) {
  Hasher hasher;
  hasher.Hash(HashOfFaces(request.model)).Hash(request.taken->hash);
  hasher.Integer(request.frame.size_px.x()).Integer(request.frame.size_px.y());
  hasher.Ratio(request.distortion.k1).Ratio(request.distortion.k2).Direction(request.towards_sun);
  const PrintEffects& e = request.effects;
  for (const double share :
       {e.grain, e.vignette, e.fade, e.dust, e.scratches, e.stains, e.paper, e.scan}) {
    hasher.Ratio(share);
  }
  hasher.Tag(static_cast<std::uint8_t>(request.tone));
  hasher.Integer(static_cast<std::int64_t>(request.seed));
  return hasher.Finish();
}

const Model* ModelOf(const OutputRequest& request) {
  struct {
    const Model* operator()(const RenderRequest& render) const { return &render.model; }
    const Model* operator()(const ExportRequest& exported) const { return &exported.model; }
    const Model* operator()(const PhotoFileRequest& photo) const { return &photo.taken_as->model; }
    const Model* operator()(const CameraRequest&) const { return nullptr; }
    const Model* operator()(const OrthophotoRequest& o) const { return o.made->standing.get(); }
  } model_of;
  return std::visit(model_of, request);
}

}  // namespace tranos::model
