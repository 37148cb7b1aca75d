// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/picture_plane.h"

#include <algorithm>
#include <cmath>

#include "output/orthophoto.h"
#include "output/parallel.h"
#include "output/pasting.h"

namespace tranos::output {
namespace {

using geom::Vec2;
using geom::Vec3;

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

std::optional<Shade> PicturePlane::At(const Vec3& point) const {
  const Vec3 place = place_from_world * point.homogeneous();
  return Sample(*picture, place.x() * picture->width_px - 0.5,
                place.y() * picture->height_px - 0.5);
}

Result<PicturePlane> PlaneOf(const model::OrthophotoPtr& orthophoto, int threads) {
  Result<RectifiedFacade> rectified = Rectify(*orthophoto, threads);
  if (!rectified) return tl::unexpected(rectified.error());
  const geom::Frame& plane = orthophoto->plane;
  const Vec2 size = orthophoto->size_m();
  return PicturePlane{PlacesOf(plane.origin, size.x() * plane.x, size.y() * plane.y),
                      std::make_shared<const Picture>(std::move(rectified->picture)), orthophoto};
}

Result<std::vector<PicturePlane>> OrthophotoPlanes(const model::Model& model, int threads) {
  const Pasting pasting(model);
  std::vector<PicturePlane> planes;
  for (std::size_t i = pasting.elements().size(); i-- > 0;) {
    Result<PicturePlane> plane = PlaneOf(pasting.Shared(i), threads);
    if (!plane) return tl::unexpected(plane.error());
    planes.push_back(*std::move(plane));
  }
  return planes;
}

void ShowBehind(const PicturePlane& plane, const model::Orthophoto& orthophoto, int threads,
                Picture* picture) {
  ParallelFor(static_cast<std::size_t>(picture->height_px), threads, [&](std::size_t row) {
    for (int x = 0; x < picture->width_px; ++x) {
      const std::size_t pixel = row * static_cast<std::size_t>(picture->width_px) + x;
      if (picture->alpha[pixel] != 0) continue;
      const double up = picture->height_px - static_cast<double>(row) - 0.5;
      const auto shade =
          plane.At(orthophoto.plane.ToWorld(orthophoto.pixel_m * Vec3(x + 0.5, up, 0)));
      if (!shade) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        picture->rgb[3 * pixel + c] =
            static_cast<std::uint8_t>(255 * (*shade)[static_cast<Eigen::Index>(c)] + 0.5f);
      }
      picture->alpha[pixel] = 255;
    }
  });
}

Picture OverColour(const Picture& picture, const model::Rgb& colour) {
  Picture over{picture.width_px, picture.height_px, picture.rgb, {}};
  for (std::size_t i = 0; i < picture.alpha.size(); ++i) {
    if (picture.alpha[i] != 0) continue;
    over.rgb[3 * i] = colour.r, over.rgb[3 * i + 1] = colour.g, over.rgb[3 * i + 2] = colour.b;
  }
  return over;
}

std::shared_ptr<const Picture> PictureOf(const model::Photograph& photograph) {
  if (!photograph.picture) return nullptr;
  const auto pixels = photograph.picture->Pixels();
  if (!pixels) return nullptr;
  return std::make_shared<const Picture>(
      Picture{(*pixels)->width_px, (*pixels)->height_px, (*pixels)->rgb});
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
  return {PlacesOf(corners[0], along, up), std::move(picture)};
}

double FrameDepth_m(const model::Photograph& photograph, const geom::Box& built) {
  if (built.empty()) return 1;
  const Vec3 way = built.centre() - photograph.estimate->camera.position_m();
  return std::max(way.norm() / 7, kNearestFrame_m);
}

}  // namespace tranos::output
