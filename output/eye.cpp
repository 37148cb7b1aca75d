// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/eye.h"

#include <algorithm>

namespace tranos::output {
namespace {

using Eigen::Vector3f;
using Eigen::Vector4d;
using geom::Affine;
using geom::Vec2;
using geom::Vec3;

constexpr double kNearest_m = 0.05;

constexpr double kNearestFine_m = 0.5;

}  // namespace

double FinestPixel_m(const geom::Box& box, const camera::Camera& camera,
                     const camera::Frame& frame) {
  const Vec3 eye = camera.position_m();
  const double near_m = box.empty() ? 10 : (eye.cwiseMax(box.min).cwiseMin(box.max) - eye).norm();
  return std::max(near_m, kNearestFine_m) * frame.pitch_mm().minCoeff() / camera[camera::kFocal];
}

Eye::Eye(const camera::Camera& camera, const camera::Frame& frame, int width_px, int height_px)
    : scale_(std::min(static_cast<double>(width_px) / frame.size_px.x(),
                      static_cast<double>(height_px) / frame.size_px.y())),
      centre_px_(frame.centre_px()) {
  const camera::Mat3 camera_from_world = camera::CameraFromWorld(camera.parameters);
  axes_ = Vec3(1, -1, -1).asDiagonal() * camera_from_world;
  const camera::Mat3 dot_from_camera =
      frame.DotFromFrame() * camera::FrameFromCamera(camera.parameters);
  camera_from_dot_ = dot_from_camera.inverse();
  const camera::ProjectionMatrix dot = camera::DotFromWorld(camera, frame);
  picture_from_world_.row(0) = scale_ * (dot.row(0) - centre_px_.x() * dot.row(2));
  picture_from_world_.row(1) = -scale_ * (dot.row(1) - centre_px_.y() * dot.row(2));
  focal_px_ = scale_ * dot_from_camera(0, 0);
  picture_from_world_.row(2) << 0, 0, 0, focal_px_;
  picture_from_world_.row(3) = dot.row(2);
  world_from_picture_ = picture_from_world_.inverse();
}

Facets Eye::InPicture(const Facets& facets, const Affine& world_from_part) const {
  Facets seen;
  for (const Vec3& p : facets.points) {
    const Vector4d at = Of(world_from_part * p);
    if (at.w() >= kNearest_m) seen.points.push_back(at.hnormalized());
  }
  for (const Line& stroke : facets.strokes) AddLine(stroke, world_from_part, &seen.strokes);
  const geom::Mesh& mesh = facets.mesh;
  const camera::Mat3 axes_from_normal = axes_ * world_from_part.linear().inverse().transpose();
  std::vector<Vector4d> at;
  std::vector<Vec3> normals;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    at.push_back(Of(world_from_part * mesh.positions[i]));
    normals.push_back((axes_from_normal * mesh.normals[i]).normalized());
  }
  geom::Mesh& made = seen.mesh;
  // Positions keep their indices, by which edges know them; new ones stand where triangles are cut.
  for (std::size_t i = 0; i < at.size(); ++i) {
    const bool is_before = at[i].w() >= kNearest_m;
    made.positions.push_back(is_before ? Vec3(at[i].hnormalized()) : Vec3(Vec3::Zero()));
    made.normals.push_back(normals[i]);
  }
  for (const auto& edge : mesh.edges) {
    if (at[edge[0]].w() >= kNearest_m && at[edge[1]].w() >= kNearest_m) made.edges.push_back(edge);
  }
  for (const auto& t : mesh.triangles) {
    std::vector<std::uint32_t> kept;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      const double over_a = at[a].w() - kNearest_m, over_b = at[b].w() - kNearest_m;
      if (over_a >= 0) kept.push_back(a);
      if ((over_a >= 0) == (over_b >= 0)) continue;
      const double share = over_a / (over_a - over_b);
      kept.push_back(static_cast<std::uint32_t>(made.positions.size()));
      made.positions.push_back((at[a] + share * (at[b] - at[a])).hnormalized());
      made.normals.push_back((normals[a] + share * (normals[b] - normals[a])).normalized());
    }
    for (std::size_t k = 2; k < kept.size(); ++k) {
      made.triangles.push_back({kept[0], kept[k - 1], kept[k]});
    }
  }
  return seen;
}

std::vector<std::vector<Vec3>> Eye::InPicture(const std::vector<Line>& lines,
                                              const Affine& world_from_part) const {
  std::vector<Line> seen;
  for (const Line& line : lines) AddLine(line, world_from_part, &seen);
  return seen;
}

void Eye::AddLine(const Line& line, const Affine& world_from_part, std::vector<Line>* lines) const {
  Line piece;
  const auto end_piece = [&] {
    if (piece.size() > 1) lines->push_back(piece);
    piece.clear();
  };
  Vector4d before;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vector4d at = Of(world_from_part * line[i]);
    const double over = at.w() - kNearest_m, over_before = i > 0 ? before.w() - kNearest_m : over;
    if ((over >= 0) != (over_before >= 0)) {
      const double share = over_before / (over_before - over);
      piece.push_back((before + share * (at - before)).hnormalized());
    }
    if (over >= 0) {
      piece.push_back(at.hnormalized());
    } else {
      end_piece();
    }
    before = at;
  }
  end_piece();
}

Vec3 Eye::InWorld(const Vec3& in_picture) const {
  return (world_from_picture_ * in_picture.homogeneous()).hnormalized();
}

Vector3f Eye::TowardsViewer(float x, float y) const {
  const Vec3 ray = camera_from_dot_ * DotAt(double{x}, double{y}).homogeneous();
  return Vec3(-ray.x(), ray.y(), ray.z()).normalized().cast<float>();
}

Vector3f Eye::Moving(const Vector3f& from, const Vector3f& direction) const {
  const Vec3 in_world = axes_.transpose() * direction.cast<double>();
  const Vector4d step = picture_from_world_.leftCols<3>() * in_world;
  // For a metre it is this by the depth, and a pixel shows the depth by the focal length.
  return ((step.head<3>() - step.w() * from.cast<double>()) / focal_px_).cast<float>();
}

}  // namespace tranos::output
