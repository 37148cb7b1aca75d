// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/picture_plane.h"

#include <algorithm>
#include <cmath>

#include "output/pasting.h"

namespace tranos::output {
namespace {

using geom::Vec2;
using geom::Vec3;

// The cosine between a face and a plane, from which on it lies in it.
constexpr double kParallel = 0.999;
constexpr double kFrameTolerance_m = 1e-3;
constexpr double kNearestFrame_m = 0.3;

// Columns, rows and height from the corner where columns begin and rows end.
Eigen::Matrix<double, 3, 4> PlacesOf(const Vec3& lower_left, const Vec3& along, const Vec3& up) {
  Eigen::Matrix3d axes;
  axes << along, up, along.cross(up).normalized();
  const Eigen::Matrix3d inverse = axes.inverse();
  Eigen::Matrix<double, 3, 4> places;
  places << inverse, -inverse * lower_left;
  places.row(1) = -places.row(1);
  places(1, 3) += 1;
  return places;
}

}  // namespace

std::optional<Shade> Sample(const Picture& picture, double x, double y) {
  if (!(x >= -0.5 && y >= -0.5 && x <= picture.width_px - 0.5 && y <= picture.height_px - 0.5)) {
    return std::nullopt;
  }
  x = std::clamp(x, 0.0, picture.width_px - 1.0), y = std::clamp(y, 0.0, picture.height_px - 1.0);
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const int right = std::min(left + 1, picture.width_px - 1);
  const int bottom = std::min(top + 1, picture.height_px - 1);
  const auto u = static_cast<float>(x - left), v = static_cast<float>(y - top);
  Shade shade = Shade::Zero();
  for (const auto& [column, row, share] : {std::tuple{left, top, (1 - u) * (1 - v)},
                                           {right, top, u * (1 - v)},
                                           {left, bottom, (1 - u) * v},
                                           {right, bottom, u * v}}) {
    const std::size_t pixel =
        static_cast<std::size_t>(row) * picture.width_px + static_cast<std::size_t>(column);
    if (!picture.alpha.empty() && picture.alpha[pixel] == 0) return std::nullopt;
    const std::uint8_t* rgb = &picture.rgb[3 * pixel];
    shade += share / 255 * Shade(rgb[0], rgb[1], rgb[2]);
  }
  return shade;
}

std::optional<Shade> PicturePlane::At(const Vec3& point, const Vec3& face_normal) const {
  if (std::abs(face_normal.dot(normal)) < kParallel) return std::nullopt;
  const Vec3 place = place_from_world * point.homogeneous();
  if (std::abs(place.z()) > tolerance_m + 1e-3) return std::nullopt;
  return Sample(*picture, place.x() * picture->width_px - 0.5,
                place.y() * picture->height_px - 0.5);
}

Result<std::vector<PicturePlane>> OrthophotoPlanes(const model::Model& model, int threads) {
  const Pasting pasting(model);
  std::vector<PicturePlane> planes;
  for (std::size_t i = pasting.elements().size(); i-- > 0;) {
    const model::Orthophoto& made = pasting.At(i);
    Result<RectifiedFacade> rectified = Rectify(made, threads);
    if (!rectified) return tl::unexpected(rectified.error());
    const geom::Frame& plane = made.plane;
    const Vec2 size = made.size_m();
    planes.push_back({PlacesOf(plane.origin, size.x() * plane.x, size.y() * plane.y), plane.z(),
                      made.tolerance_m,
                      std::make_shared<const Picture>(std::move(rectified->picture))});
  }
  return planes;
}

std::array<Vec3, 4> FrameCorners(const model::Photograph& photograph, double depth_m) {
  const camera::Camera& camera = photograph.estimate->camera;
  const camera::Mat3 world_from_frame =
      (camera::FrameFromCamera(camera.parameters) * camera::CameraFromWorld(camera.parameters))
          .inverse();
  const Vec2 half = photograph.frame.size_mm / 2;
  std::array<Vec3, 4> corners;
  const Vec2 signs[] = {{-1, 1}, {1, 1}, {1, -1}, {-1, -1}};  // y down
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 point = half.cwiseProduct(signs[i]);
    corners[i] = camera.position_m() + depth_m * (world_from_frame * point.homogeneous());
  }
  return corners;
}

PicturePlane PlaneAtFrame(const model::Photograph& photograph, double depth_m,
                          std::shared_ptr<const Picture> picture) {
  const auto corners = FrameCorners(photograph, depth_m);
  const Vec3 along = corners[1] - corners[0], up = corners[3] - corners[0];
  return {PlacesOf(corners[0], along, up), along.cross(up).normalized(), kFrameTolerance_m,
          std::move(picture)};
}

double FrameDepth_m(const model::Photograph& photograph, const geom::Box& built) {
  if (built.empty()) return 1;
  const Vec3 way = built.centre() - photograph.estimate->camera.position_m();
  return std::max(way.norm() / 7, kNearestFrame_m);
}

}  // namespace tranos::output
