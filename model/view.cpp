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

geom::Frame FrameOf(const View& view, std::string_view otherwise) {
  if (!view.camera) return FrameOf(view.direction.empty() ? otherwise : view.direction);
  const auto& photograph = *std::get<PhotographPtr>(view.camera->geometry);
  const camera::Mat3 axes = camera::CameraFromWorld(photograph.estimate->camera.parameters);
  return {geom::Vec3::Zero(), axes.row(0).transpose(), -axes.row(1).transpose()};
}

}  // namespace tranos::model
