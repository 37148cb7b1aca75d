// SPDX-License-Identifier: GPL-3.0-or-later
// A photograph's camera as the viewer of a picture. Its map from the world is projective and keeps
// lines and planes straight, so that everything else works as in a parallel projection: picture
// space (output/view.h) with z = b / depth.
#pragma once

#include "camera/camera.h"
#include "output/facets.h"

namespace tranos::output {

// The length that a pixel of the photograph shows of the nearest part of the box, or of what is
// half a metre away where that is nearer.
double FinestPixel_m(const geom::Box& box, const camera::Camera& camera,
                     const camera::Frame& frame);

class Eye {
 public:
  // The photograph's frame, as large as it fits into a picture of this size, in its middle.
  Eye(const camera::Camera& camera, const camera::Frame& frame, int width_px, int height_px);

  // What of it lies before the camera, at 5 cm or more: positions in picture space, normals along
  // the viewer's axes (x right, y up, z to the viewer).
  Facets InPicture(const Facets& facets, const geom::Affine& world_from_part) const;
  std::vector<std::vector<geom::Vec3>> InPicture(const std::vector<std::vector<geom::Vec3>>& lines,
                                                 const geom::Affine& world_from_part) const;

  geom::Vec3 InWorld(const geom::Vec3& in_picture) const;
  // The direction in the world of one along the viewer's axes.
  geom::Vec3 InWorldAlong(const geom::Vec3& direction) const {
    return axes_.transpose() * direction;
  }
  // Along the viewer's axes, unit, from a place of the picture.
  Eigen::Vector3f TowardsViewer(float x, float y) const;
  // Of what moves by the length that a pixel shows there, in a unit direction along the viewer's
  // axes: how it moves in picture space.
  Eigen::Vector3f Moving(const Eigen::Vector3f& from, const Eigen::Vector3f& direction) const;
  // By how much z changes over a depth of the length that a pixel shows where z is this.
  float PixelOfDepth(float z) const { return z / static_cast<float>(focal_px_); }
  // Where a place of the picture is on the photograph, in dots.
  geom::Vec2 DotAt(double x, double y) const { return centre_px_ + geom::Vec2(x, -y) / scale_; }

 private:
  // A position with its depth before the camera, in picture space but for the division by it.
  Eigen::Vector4d Of(const geom::Vec3& in_world) const {
    return picture_from_world_ * in_world.homogeneous();
  }
  using Line = std::vector<geom::Vec3>;
  void AddLine(const Line& line, const geom::Affine& world_from_part,
               std::vector<Line>* lines) const;

  double scale_;     // pixels of the picture for one of the photograph
  double focal_px_;  // of the picture
  geom::Vec2 centre_px_;
  Eigen::Matrix4d picture_from_world_, world_from_picture_;
  camera::Mat3 axes_;  // from the world's
  camera::Mat3 camera_from_dot_;
};

}  // namespace tranos::output
