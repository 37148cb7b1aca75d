// SPDX-License-Identifier: GPL-3.0-or-later
// Small models for the tests of output.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model/edit.h"

namespace tranos::output {

inline model::Model ModelOf(std::vector<model::ElementPtr> elements) {
  model::Edit edit;
  edit.added = std::move(elements);
  return model::Apply(model::State{}, edit).state.model;
}
inline model::ElementPtr ElementOf(model::Geometry geometry, model::Attributes attributes = {},
                                   const char* name = nullptr) {
  return model::MakeElement(model::kNoElement, std::move(geometry),
                            std::make_shared<const model::Attributes>(std::move(attributes)),
                            name ? std::make_shared<const std::string>(name) : nullptr, {});
}
inline model::ElementPtr LineOf(const geom::Vec3& a, const geom::Vec3& b,
                                model::Attributes attributes = {}) {
  return ElementOf(std::make_shared<const geom::Curve>(geom::Line{a, b}), std::move(attributes));
}
// The rectangle from (x, y0, z) to (x + width, y0, z + height), which faces the front view.
inline model::ElementPtr WallOf(const geom::Vec3& corner, double width, double height) {
  return ElementOf(std::make_shared<const geom::Surface>(*geom::Extrusion(
      geom::Line{corner, corner + geom::Vec3(width, 0, 0)}, geom::Vec3(0, 0, height))));
}
// A sphere of radius 1 about the origin: half a circle turned about z.
inline model::ElementPtr SphereOf() {
  const geom::Arc half =
      *geom::ArcThrough(-geom::Vec3::UnitZ(), geom::Vec3::UnitX(), geom::Vec3::UnitZ());
  return ElementOf(std::make_shared<const geom::Surface>(
      *geom::Revolution(half, geom::Vec3::Zero(), geom::Vec3::UnitZ(), 2 * geom::kPi)));
}
// A stated camera that looks along Y, level.
inline model::ElementPtr CameraAt(const geom::Vec3& place_m) {
  camera::Estimate estimate;
  estimate.camera.parameters << 25, 1, 0, 0, geom::kPi / 2, 0, 0, 0, place_m.x(), place_m.y(),
      place_m.z();
  model::Photograph photograph;
  photograph.frame = {{40.5, 26.7}, {600, 400}};
  photograph.estimate = std::make_shared<const camera::Estimate>(estimate);
  return ElementOf(std::make_shared<const model::Photograph>(photograph));
}
// An orthophoto of 4 m by 3 m in the plane y = 0, all of this tone, as far as a camera at this
// place sees it.
inline model::ElementPtr EvenOrthophoto(std::uint8_t tone,
                                        const geom::Vec3& camera_m = {2, -10, 1.5}) {
  model::Orthophoto made;
  made.facade = "front";
  made.photograph = CameraAt(camera_m);
  camera::Photo photo{600, 400, std::vector<std::uint8_t>(std::size_t{3} * 600 * 400, tone)};
  made.pixels = std::make_shared<const camera::Photo>(std::move(photo));
  made.plane = {geom::Vec3::Zero(), geom::Vec3::UnitX(), geom::Vec3::UnitZ()};
  made.pixel_m = 0.02;
  made.size_px = {200, 150};
  made.tolerance_m = 0.02;
  made.standing = std::make_shared<const model::Model>();
  return ElementOf(std::make_shared<const model::Orthophoto>(made));
}

}  // namespace tranos::output
