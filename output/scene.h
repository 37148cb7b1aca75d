// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "model/edit.h"
#include "output/eye.h"
#include "output/picture_plane.h"
#include "output/ray_scene.h"
#include "output/result.h"
#include "output/view.h"

namespace tranos::output {

// A line of a drawing in picture space (output/view.h).
struct Stroke {
  std::vector<Eigen::Vector3f> vertices;
  // Of an outline: for each of its segments the direction, one pixel long, in which the surface
  // that it bounds ends. Otherwise empty.
  std::vector<Eigen::Vector2f> outward;
  Shade colour = Shade::Zero();
  float opacity = 1;
  float width_px = 1;
  int linestyle = 0;
};

// Triangles of a surface that bear a plane's picture.
struct Borne {
  std::size_t plane;
  std::vector<bool> by;  // each triangle
};

// What a picture shows, ready to be traced and drawn.
struct Scene {
  Camera camera;
  std::vector<RaySurface> surfaces;       // in the order of elements
  std::vector<Shade> surface_colours;     // of each surface
  std::vector<std::vector<Borne>> borne;  // likewise; what is seen first is first
  std::vector<Stroke> strokes;            // later ones over earlier ones
  std::optional<Eye> eye;            // the viewer, where the view is through a photograph's camera
  std::vector<PicturePlane> planes;  // what faces in them show
  std::shared_ptr<const Picture> backdrop;  // the photograph, seen through the eye behind all
  float nearest = 0, farthest = 0;          // z of what is nearest to the viewer, and farthest

  // Of picture space; directions are given along the viewer's axes.
  geom::Vec3 InWorld(const Eigen::Vector3f& in_picture) const;
  geom::Vec3 DirectionInWorld(const Eigen::Vector3f& direction) const;
  Eigen::Vector3f TowardsViewer(float x, float y) const;
  Eigen::Vector3f Moving(const Eigen::Vector3f& from, const Eigen::Vector3f& direction) const;
  float PixelOfDepth(float z) const { return eye ? eye->PixelOfDepth(z) : 1; }
};

// Everything on visible levels, from the request's view. In shaded pictures surfaces have no lines.
Result<Scene> SceneOf(const model::RenderRequest& request, int threads);

}  // namespace tranos::output
