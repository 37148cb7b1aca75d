// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "model/state.h"

namespace tranos::model {

geom::Frame FrameOf(std::string_view direction) {
  using geom::Vec3;
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const Vec3 origin = Vec3::Zero();
  if (direction == "front") return {origin, x, z};
  if (direction == "right") return {origin, y, z};
  if (direction == "back") return {origin, -x, z};
  if (direction == "left") return {origin, -y, z};
  if (direction == "top") return {origin, x, y};
  if (direction == "bottom") return {origin, x, -y};
  // Isometric: the viewer stands at (1, −1, 1), where the three axes look equally long.
  return {origin, Vec3(1, 1, 0) / std::sqrt(2.0), Vec3(-1, 1, 2) / std::sqrt(6.0)};
}

ElementPtr CameraOf(const View& view, const Model& model) {
  const ElementPtr element = model.Current(view.camera);
  const auto* photograph = element ? std::get_if<PhotographPtr>(&element->geometry) : nullptr;
  return photograph && HasCamera(**photograph) ? element : nullptr;
}

geom::Frame FrameOf(const View& view, const Model& model, std::string_view otherwise) {
  const ElementPtr through = CameraOf(view, model);
  if (!through) return FrameOf(view.direction.empty() ? otherwise : view.direction);
  const auto& photograph = *std::get<PhotographPtr>(through->geometry);
  const camera::Mat3 axes = camera::CameraFromWorld(photograph.estimate->camera.parameters);
  return {geom::Vec3::Zero(), axes.row(0).transpose(), -axes.row(1).transpose()};
}

}  // namespace tranos::model
