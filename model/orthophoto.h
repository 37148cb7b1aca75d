// SPDX-License-Identifier: GPL-3.0-or-later
// A facade as a photograph shows it, seen squarely and to scale. An element as a facade is one:
// named, undone, compared, and no part of what is built; what is built bears it where it lies in
// its plane.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "camera/photo_file.h"
#include "geom/primitives.h"
#include "model/hash.h"

namespace tranos::model {

struct Element;
struct Model;

struct Orthophoto {
  std::string facade;
  std::shared_ptr<const Element> photograph;  // with its camera
  camera::PhotoPtr pixels = nullptr;          // of the photograph; null in a replay
  geom::Frame plane;  // the origin is the lower left corner; x to the right, y up, z to the viewer
  double pixel_m = 0;
  Eigen::Vector2i size_px = {0, 0};
  double tolerance_m = 0;  // so far from the plane a face still lies in it
  // What stood there when it was made, and may hide the facade from the camera.
  std::shared_ptr<const Model> standing;
  double sampling_m = 0;  // what a pixel of the photograph covers of it, in the middle of all

  geom::Vec2 size_m() const { return pixel_m * size_px.cast<double>(); }
};

// Of what stands before it, that and no more: what cannot hide it may change.
void AddToHash(Hasher& hasher, const Orthophoto& orthophoto);

// Whether a triangle bears what lies in a plane: none of its corners, given in the world, is
// farther from the plane than the tolerance, it is parallel to the plane within 2.5°, and its outer
// side is the plane's front. `outward` is a direction on the outer side, or zero for a face that
// has none.
bool Bears(const std::array<geom::Vec3, 3>& in_world, const geom::Vec3& outward,
           const geom::Frame& plane, double tolerance_m);

}  // namespace tranos::model
