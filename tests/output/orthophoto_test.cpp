// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/orthophoto.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "camera/facade_view.h"
#include "output/facets.h"
#include "output/pasting.h"
#include "tests/output/models.h"

namespace tranos::output {
namespace {

using geom::Affine;
using geom::Box;
using geom::Frame;
using geom::Vec2;
using geom::Vec3;

constexpr double kDegree = geom::kPi / 180;
const Frame kFront{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitZ()};

camera::Camera SkewedCamera() {
  camera::Camera camera;
  camera.parameters << 33.33, 1.03, 0.4, -0.3, 88 * kDegree, 8 * kDegree, 25 * kDegree,
      1.5 * kDegree, 12, -14, 2;
  return camera;
}
constexpr double kPatternWidth_m = 2;
// A tone for each place of a facade, that changes slowly.
double ToneAt(double x_m, double y_m) {
  return 128 + 60 * std::sin(2 * geom::kPi * x_m / kPatternWidth_m) *
                   std::cos(2 * geom::kPi * y_m / kPatternWidth_m);
}

// What the camera would take of a plane that bears tones.
camera::PhotoPtr Taken(const camera::Camera& camera, const camera::Frame& frame, const Frame& plane,
                       const std::function<double(double, double)>& tone) {
  const camera::Mat3 plane_from_dot = camera::DotFromPlane(camera, frame, plane).inverse();
  camera::Photo photo{frame.size_px.x(), frame.size_px.y(), {}};
  for (int v = 0; v < photo.height_px; ++v) {
    for (int u = 0; u < photo.width_px; ++u) {
      const Vec2 place = (plane_from_dot * Vec3(u, v, 1)).hnormalized();
      const double value = std::clamp(tone(place.x(), place.y()), 0.0, 255.0);
      for (int c = 0; c < 3; ++c) photo.rgb.push_back(static_cast<std::uint8_t>(value + 0.5));
    }
  }
  return std::make_shared<const camera::Photo>(std::move(photo));
}

model::Orthophoto OrthophotoOf(const camera::Camera& camera, const camera::Frame& frame,
                               std::vector<model::ElementPtr> standing = {}) {
  model::Photograph photograph;
  photograph.frame = frame;
  camera::Estimate estimate;
  estimate.camera = camera;
  photograph.estimate = std::make_shared<const camera::Estimate>(estimate);
  model::Orthophoto made;
  made.facade = "front";
  made.photograph = ElementOf(std::make_shared<const model::Photograph>(photograph));
  made.plane = kFront;
  made.pixel_m = 0.02;
  made.size_px = {400, 250};
  made.tolerance_m = 0.02;
  made.standing = std::make_shared<const model::Model>(ModelOf(std::move(standing)));
  return made;
}
const camera::Frame kFrame{{40.5, 26.7}, {1200, 791}};

// The middle of a pixel on the facade.
Vec2 PlaceOf(const model::Orthophoto& made, int x, int y) {
  return made.pixel_m * Vec2(x + 0.5, made.size_px.y() - y - 0.5);
}
template <class F>
void ForPixels(const model::Orthophoto& made, F&& visit) {
  for (int y = 0; y < made.size_px.y(); ++y) {
    for (int x = 0; x < made.size_px.x(); ++x) {
      visit(PlaceOf(made, x, y), static_cast<std::size_t>(y) * made.size_px.x() + x);
    }
  }
}

TEST(Orthophoto, ShowsAtEachPlaceWhatIsThereOnTheFacade) {
  model::Orthophoto made = OrthophotoOf(SkewedCamera(), kFrame);
  made.pixels = Taken(SkewedCamera(), kFrame, kFront, ToneAt);
  const RectifiedFacade rectified = *Rectify(made, 2);
  std::size_t seen = 0;
  double worst = 0, squares = 0;
  ForPixels(made, [&](const Vec2& place, std::size_t i) {
    if (rectified.seen.why[i] != Unseen::kSeen) return;
    const double off = rectified.picture.rgb[3 * i] - ToneAt(place.x(), place.y());
    worst = std::max(worst, std::abs(off)), squares += off * off, ++seen;
  });
  EXPECT_EQ(seen + rectified.seen.outside + rectified.seen.hidden, 400U * 250);
  EXPECT_GT(seen, 90'000U);
  // 8 bits, and what lies between two pixels of the photograph.
  EXPECT_LT(worst, 2.0);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(seen)), 0.6);
}

TEST(Orthophoto, AFinerPhotographIsAveragedAndNotPickedFrom) {
  camera::Camera straight;
  straight.parameters << 36, 1, 0, 0, 90 * kDegree, 0, 0, 0, 4, -10, 2.5;
  const camera::Frame frame{{36, 24}, {3000, 2000}};
  model::Orthophoto made = OrthophotoOf(straight, frame);
  made.pixel_m = 0.1;
  made.size_px = {80, 40};
  // Squares of 1 cm, black and white: on average grey.
  made.pixels = Taken(straight, frame, kFront, [](double x, double y) {
    return (std::lround(std::floor(100 * x)) + std::lround(std::floor(100 * y))) % 2 == 0 ? 255 : 0;
  });
  const RectifiedFacade rectified = *Rectify(made, 2);
  ForPixels(made, [&](const Vec2&, std::size_t i) {
    if (rectified.seen.why[i] != Unseen::kSeen) return;
    EXPECT_NEAR(rectified.picture.rgb[3 * i], 128, 40);
  });
}

// Whether the way from one point to another goes through the box.
bool Meets(const Box& box, const Vec3& from, const Vec3& to) {
  double enter = 0, leave = 1;
  for (int i = 0; i < 3; ++i) {
    const double way = to[i] - from[i];
    double a = (box.min[i] - from[i]) / way, b = (box.max[i] - from[i]) / way;
    if (a > b) std::swap(a, b);
    enter = std::max(enter, a), leave = std::min(leave, b);
  }
  return enter < leave;
}
std::vector<model::ElementPtr> FacesOf(const Box& box) {
  const auto corner = [&](int i) {
    return Vec3(i & 1 ? box.max.x() : box.min.x(), i & 2 ? box.max.y() : box.min.y(),
                i & 4 ? box.max.z() : box.min.z());
  };
  const auto face = [&](int from, int right, int up) {
    return ElementOf(std::make_shared<const geom::Surface>(
        *geom::Extrusion(geom::Line{corner(from), corner(right)}, corner(up) - corner(from))));
  };
  return {face(0, 1, 4), face(1, 3, 5), face(0, 1, 2), face(4, 5, 6), face(2, 3, 6), face(0, 2, 4)};
}

TEST(Orthophoto, WhatStandsBeforeTheFacadeHidesJustWhatItHides) {
  Box pier;
  pier.Add(Vec3(3, -2, 0));
  pier.Add(Vec3(3.7, -1, 3.3));
  model::Orthophoto made = OrthophotoOf(SkewedCamera(), kFrame, FacesOf(pier));
  made.pixels = Taken(SkewedCamera(), kFrame, kFront, ToneAt);
  const RectifiedFacade rectified = *Rectify(made, 2);
  std::size_t differ = 0, hidden = 0;
  ForPixels(made, [&](const Vec2& place, std::size_t i) {
    const bool is_hidden =
        Meets(pier, SkewedCamera().position_m(), kFront.ToWorld({place.x(), place.y(), 0}));
    hidden += is_hidden;
    differ += is_hidden != (rectified.seen.why[i] == Unseen::kHidden);
    EXPECT_EQ(rectified.picture.alpha[i], rectified.seen.why[i] == Unseen::kSeen ? 255 : 0);
  });
  EXPECT_GT(hidden, 4000U);
  EXPECT_EQ(differ, 0U);
  EXPECT_EQ(rectified.seen.hidden, hidden);
}

TEST(Orthophoto, WhatLiesInItsPlaneOrBehindItHidesNothing) {
  Box wall;
  wall.Add(Vec3(0, 0, 0));
  wall.Add(Vec3(8, 0.6, 5));
  model::Orthophoto made = OrthophotoOf(SkewedCamera(), kFrame, FacesOf(wall));
  made.pixels = Taken(SkewedCamera(), kFrame, kFront, ToneAt);
  EXPECT_EQ(Rectify(made, 2)->seen.hidden, 0U);
}

TEST(Orthophoto, WhatIsBehindTheCameraOrBesideThePictureIsLeftOut) {
  // A wall that runs from before the camera past it.
  camera::Camera along;
  along.parameters << 36, 1, 0, 0, 90 * kDegree, 0, 90 * kDegree, 0, 4, -1, 2;
  model::Orthophoto made = OrthophotoOf(along, kFrame);
  made.pixels = Taken(along, kFrame, kFront, ToneAt);
  const RectifiedFacade rectified = *Rectify(made, 2);
  std::size_t seen = 0;
  ForPixels(made, [&](const Vec2& place, std::size_t i) {
    const camera::Image image = camera::Project(along, {place.x(), 0, place.y()});
    const bool is_in =
        image.depth_m > 0 &&
        (image.point_mm.cwiseAbs().array() < kFrame.size_mm.array() / 2 - 1e-9).all();
    EXPECT_EQ(rectified.seen.why[i] == Unseen::kSeen, is_in) << place.transpose();
    seen += is_in;
  });
  EXPECT_GT(seen, 1000U);
  EXPECT_LT(seen, 50'000U);
}

TEST(Orthophoto, IsTheSameWithAnyNumberOfThreads) {
  Box pier;
  pier.Add(Vec3(3, -2, 0));
  pier.Add(Vec3(3.7, -1, 3.3));
  model::Orthophoto made = OrthophotoOf(SkewedCamera(), kFrame, FacesOf(pier));
  made.pixels = Taken(SkewedCamera(), kFrame, kFront, ToneAt);
  const RectifiedFacade one = *Rectify(made, 1);
  const RectifiedFacade eight = *Rectify(made, 8);
  EXPECT_EQ(one.picture.rgb, eight.picture.rgb);
  EXPECT_EQ(one.picture.alpha, eight.picture.alpha);
}

TEST(Orthophoto, WithoutPixelsThereIsNone) {
  EXPECT_FALSE(Rectify(OrthophotoOf(SkewedCamera(), kFrame), 1));
}

model::ElementPtr Borne(double width_m, double height_m) {
  model::Orthophoto made = OrthophotoOf(SkewedCamera(), kFrame);
  made.pixels = Taken(SkewedCamera(), kFrame, kFront, ToneAt);
  made.pixel_m = 0.1;
  made.size_px = {static_cast<int>(10 * width_m), static_cast<int>(10 * height_m)};
  return ElementOf(std::make_shared<const model::Orthophoto>(made), {}, "front");
}
double AreaOf(const geom::Mesh& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangles) {
    area += (mesh.positions[t[1]] - mesh.positions[t[0]])
                .cross(mesh.positions[t[2]] - mesh.positions[t[0]])
                .norm() /
            2;
  }
  return area;
}

TEST(Pasting, AFaceIsCutAlongTheOrthophotosBorder) {
  const Pasting pasting(ModelOf({Borne(4, 3)}));
  // A wall of 6 m by 5 m that begins 1 m left of the orthophoto and 1 m below it.
  const Facets wall = *FacetsOf(*WallOf({-1, 0, -1}, 6, 5), {});
  const auto split = pasting.Split(wall.mesh, Affine::Identity());
  ASSERT_TRUE(split);
  ASSERT_EQ(split->bearing.size(), 1U);
  EXPECT_NEAR(AreaOf(split->bearing[0].mesh), 12, 1e-9);
  EXPECT_NEAR(AreaOf(split->plain), 18, 1e-9);
  for (std::size_t i = 0; i < split->bearing[0].places.size(); ++i) {
    const Vec3& p = split->bearing[0].mesh.positions[i];
    EXPECT_NEAR(split->bearing[0].places[i].x(), p.x() / 4, 1e-9);
    EXPECT_NEAR(split->bearing[0].places[i].y(), 1 - p.z() / 3, 1e-9);
  }
}
TEST(Pasting, FacesThatLieElsewhereBearNothing) {
  const Pasting pasting(ModelOf({Borne(4, 3)}));
  EXPECT_FALSE(pasting.Split(FacetsOf(*WallOf({0, 0.1, 0}, 6, 5), {})->mesh, Affine::Identity()));
  EXPECT_FALSE(pasting.Split(FacetsOf(*WallOf({5, 0, 0}, 6, 5), {})->mesh, Affine::Identity()));
  Affine turned = Affine::Identity();
  turned.rotate(Eigen::AngleAxisd(geom::kPi / 2, Vec3::UnitZ()));
  EXPECT_FALSE(pasting.Split(FacetsOf(*WallOf({0, 0, 0}, 6, 5), {})->mesh, turned));
}

}  // namespace
}  // namespace tranos::output
