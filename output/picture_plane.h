// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures that lie on planes of the world: orthophotos, photographs at their frames.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "model/state.h"
#include "output/picture.h"

namespace tranos::output {

struct PicturePlane {
  // Columns from the picture's left border and rows from its upper one, both from 0 to 1, and the
  // height over the plane in metres.
  Eigen::Matrix<double, 3, 4> place_from_world;
  std::shared_ptr<const Picture> picture;
  model::OrthophotoPtr of = nullptr;  // null for a photograph's

  // What is seen at this point; nothing where the picture shows nothing there.
  std::optional<Shade> At(const geom::Vec3& point) const;
};

// The picture at a place, in pixels from the centre of its upper left one, between the four next
// ones; nothing outside it.
std::optional<Shade> Sample(const Picture& picture, double x, double y);

// What an orthophoto shows, in its place. Errors of Rectify.
Result<PicturePlane> PlaneOf(const model::OrthophotoPtr& orthophoto, int threads);
// The orthophotos of a model whose pixels are at hand, the later first. Errors of Rectify.
Result<std::vector<PicturePlane>> OrthophotoPlanes(const model::Model& model, int threads);
// Lets what the plane shows be seen where the orthophoto's picture, which lies in it, shows
// nothing.
void ShowBehind(const PicturePlane& plane, const model::Orthophoto& orthophoto, int threads,
                Picture* picture);
// The picture with what is not seen of it in this colour, opaque.
Picture OverColour(const Picture& picture, const model::Rgb& colour);

// The photograph's picture, if it is at hand.
std::shared_ptr<const Picture> PictureOf(const model::Photograph& photograph);

// Where the corners of a photograph's frame are, this far before its camera: the lower left one,
// and on anticlockwise as the camera sees them. They are those of a parallelogram: a rectangle
// but for the skew.
std::array<geom::Vec3, 4> FrameCorners(const model::Photograph& photograph, double depth_m);
PicturePlane PlaneAtFrame(const model::Photograph& photograph, double depth_m,
                          std::shared_ptr<const Picture> picture);
// How far before the camera the photograph is shown as a plane: a seventh of the way to what is
// built.
double FrameDepth_m(const model::Photograph& photograph, const geom::Box& built);

}  // namespace tranos::output
