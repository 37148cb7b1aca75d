// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/orthophoto.h"

#include <cmath>

#include "model/faces.h"
#include "model/state.h"

namespace tranos::model {
namespace {

using geom::Box;
using geom::Vec3;

// The cosine of the angle between a face and a plane, up to which it lies in it.
constexpr double kParallel = 0.999;

// Whether a box, along the orthophoto's plane, reaches into the pyramid over the orthophoto whose
// apex is the camera, and does so before the tolerance.
bool MayHide(const Box& box, const Orthophoto& orthophoto, const Vec3& camera) {
  if (box.empty() || box.max.z() <= orthophoto.tolerance_m || box.min.z() >= camera.z()) {
    return false;
  }
  const geom::Vec2 size = orthophoto.size_m();
  const Vec3 corners[] = {{0, 0, 0}, {size.x(), 0, 0}, {size.x(), size.y(), 0}, {0, size.y(), 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    // With the corners anticlockwise as the camera sees them this points into the pyramid.
    const Vec3 inward = (corners[(i + 1) % 4] - camera).cross(corners[i] - camera);
    const Vec3 innermost = (inward.array() > 0).select(box.max, box.min);
    if (inward.dot(innermost - camera) < 0) return false;
  }
  return true;
}

// A sum over the faces that may hide it, as they stand.
Hash128 HashOfHiding(const Orthophoto& orthophoto) {
  const auto& taken = *std::get<PhotographPtr>(orthophoto.photograph->geometry);
  const Vec3 camera = orthophoto.plane.ToLocal(taken.estimate->camera.position_m());
  const geom::Affine plane_from_world = orthophoto.plane.WorldFromFrame().inverse();
  Hash128 sum;
  ForEachWithFaces(
      *orthophoto.standing,
      [&](const Element& leaf, const geom::Affine& world_from_leaf, const Attributes&) {
        const geom::Affine plane_from_leaf = plane_from_world * world_from_leaf;
        if (!MayHide(geom::Carried(BoundingBox(leaf), plane_from_leaf), orthophoto, camera)) return;
        Hasher hasher;
        AddToHash(hasher, leaf, world_from_leaf);
        sum = sum + hasher.Finish();
      });
  return sum;
}

}  // namespace

void AddToHash(Hasher& hasher, const Orthophoto& orthophoto) {
  const geom::Frame& plane = orthophoto.plane;
  hasher.Text(orthophoto.facade).Hash(orthophoto.photograph->hash);
  hasher.Point(plane.origin).Direction(plane.x).Direction(plane.y);
  hasher.Length(orthophoto.pixel_m).Length(orthophoto.tolerance_m);
  hasher.Integer(orthophoto.size_px.x()).Integer(orthophoto.size_px.y());
  hasher.Hash(HashOfHiding(orthophoto));
}

bool Bears(const std::array<Vec3, 3>& in_world, const Vec3& outward, const geom::Frame& plane,
           double tolerance_m) {
  const Vec3 front = plane.z();
  for (const Vec3& corner : in_world) {
    if (std::abs(front.dot(corner - plane.origin)) > tolerance_m + geom::kCoincident_m) {
      return false;
    }
  }
  const Vec3 across = (in_world[1] - in_world[0]).cross(in_world[2] - in_world[0]);
  return std::abs(across.dot(front)) > kParallel * across.norm() && outward.dot(front) >= 0;
}

}  // namespace tranos::model
