// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/orthophoto.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "camera/facade_view.h"
#include "output/facets.h"
#include "output/pasting.h"
#include "output/picture_plane.h"
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
  const auto split = pasting.Split(wall.mesh, Affine::Identity(), false);
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
  const auto bears = [&](const Vec3& corner, const Affine& place) {
    return pasting.Split(FacetsOf(*WallOf(corner, 6, 5), {})->mesh, place, false).has_value();
  };
  EXPECT_TRUE(bears({0, 0, 0}, Affine::Identity()));
  EXPECT_FALSE(bears({0, 0.1, 0}, Affine::Identity()));
  EXPECT_FALSE(bears({5, 0, 0}, Affine::Identity()));
  Affine turned = Affine::Identity();
  turned.rotate(Eigen::AngleAxisd(geom::kPi / 2, Vec3::UnitZ()));
  EXPECT_FALSE(bears({0, 0, 0}, turned));
}

// A shape in the plane of the facade, with its front to the camera.
geom::Mesh ShapeOf(std::vector<Vec3> corners) {
  const auto region = geom::RegionOf({geom::Polyline{std::move(corners), true}});
  return FacetsOf(*ElementOf(std::make_shared<const geom::Region>(*region)), {})->mesh;
}
double AreaOf(const SplitMesh& split) {
  double area = AreaOf(split.plain);
  for (const BearingMesh& bearing : split.bearing) area += AreaOf(bearing.mesh);
  return area;
}

TEST(Pasting, AVertexOnTheBorderTakesNothingAway) {
  // A gable whose ridge, foot and eaves lie on the borders of orthophotos of many sizes.
  const geom::Mesh gable = ShapeOf({{0, 0, 0}, {10, 0, 0}, {10, 0, 6}, {5, 0, 9}, {0, 0, 6}});
  for (const double width_m : {2.5, 5.0, 7.5, 10.0}) {
    for (const double height_m : {3.0, 6.0, 7.5, 9.0}) {
      const Pasting pasting(ModelOf({Borne(width_m, height_m)}));
      const auto split = pasting.Split(gable, Affine::Identity(), false);
      ASSERT_TRUE(split);
      EXPECT_NEAR(AreaOf(*split), AreaOf(gable), 1e-9) << width_m << " by " << height_m;
    }
  }
}

TEST(Pasting, AFaceThatLooksAwayBearsNothingIfItHasAnOuterSide) {
  const Pasting pasting(ModelOf({Borne(4, 3)}));
  const geom::Mesh towards = ShapeOf({{0, 0, 0}, {4, 0, 0}, {4, 0, 3}, {0, 0, 3}});
  geom::Mesh away = towards;
  for (Vec3& normal : away.normals) normal = -normal;
  EXPECT_TRUE(pasting.Split(towards, Affine::Identity(), true));
  EXPECT_FALSE(pasting.Split(away, Affine::Identity(), true));
  EXPECT_TRUE(pasting.Split(away, Affine::Identity(), false));
  // A mirrored one looks where its mirrored normals point.
  const Affine mirrored(Eigen::DiagonalMatrix<double, 3>(1, -1, 1));
  EXPECT_FALSE(pasting.Split(towards, mirrored, true));
  EXPECT_TRUE(pasting.Split(away, mirrored, true));
}

TEST(Pasting, WhatALaterOneCoversIsBorneToo) {
  const Pasting pasting(ModelOf({Borne(4, 3), Borne(4, 3)}));
  const geom::Mesh wall = FacetsOf(*WallOf({-1, 0, -1}, 6, 5), {})->mesh;
  const auto split = pasting.Split(wall, Affine::Identity(), false);
  ASSERT_TRUE(split);
  EXPECT_EQ(split->borne, (std::vector<std::size_t>{0, 1}));
  ASSERT_EQ(split->bearing.size(), 1U);
  EXPECT_EQ(split->bearing[0].orthophoto, 1U);
  EXPECT_NEAR(AreaOf(*split), 30, 1e-9);
}

TEST(Orthophoto, TheEarlierOneIsSeenThroughTheHolesOfTheLater) {
  model::Orthophoto later = OrthophotoOf(SkewedCamera(), kFrame);
  const auto earlier = std::make_shared<model::Orthophoto>(OrthophotoOf(SkewedCamera(), kFrame));
  earlier->pixels = Taken(SkewedCamera(), kFrame, kFront, ToneAt);
  earlier->pixel_m = 0.05;
  earlier->size_px = {200, 120};
  const PicturePlane plane = *PlaneOf(earlier, 2);
  Picture picture{later.size_px.x(), later.size_px.y(), {}, {}};
  picture.alpha.resize(static_cast<std::size_t>(picture.width_px) * picture.height_px);
  picture.rgb.resize(3 * picture.alpha.size());
  picture.alpha[0] = 255;
  ShowBehind(plane, later, 2, &picture);
  EXPECT_EQ(picture.rgb[0], 0);  // it shows something itself
  std::size_t filled = 0;
  ForPixels(later, [&](const Vec2& place, std::size_t i) {
    if (i == 0 || picture.alpha[i] == 0) return;
    EXPECT_NEAR(picture.rgb[3 * i], ToneAt(place.x(), place.y()), 4);
    ++filled;
  });
  EXPECT_GT(filled, 90'000U);
}

TEST(Orthophoto, AtThePhotographsBorderAsManyDotsAreAveragedAsElsewhere) {
  // Black and white dots in turn, seen from far: grey, wherever the photograph ends.
  camera::Camera straight;
  straight.parameters << 36, 1, 0, 0, 90 * kDegree, 0, 0, 0, 4, -10, 2.5;
  const camera::Frame frame{{36, 24}, {3000, 2000}};
  model::Orthophoto made = OrthophotoOf(straight, frame);
  made.plane.origin = {-8, 0, -4};
  made.pixel_m = 0.1;
  made.size_px = {240, 130};
  camera::Photo photo{3000, 2000, {}};
  for (int i = 0; i < 3000 * 2000; ++i) {
    const bool is_white = (i % 3000 + i / 3000) % 2 == 0;
    photo.rgb.insert(photo.rgb.end(), 3, is_white ? 255 : 0);
  }
  made.pixels = std::make_shared<const camera::Photo>(std::move(photo));
  const RectifiedFacade rectified = *Rectify(made, 2);
  std::size_t seen = 0;
  ForPixels(made, [&](const Vec2&, std::size_t i) {
    if (rectified.seen.why[i] != Unseen::kSeen) return;
    ++seen;
    EXPECT_NEAR(rectified.picture.rgb[3 * i], 128, 2) << i % 240 << ", " << i / 240;
  });
  EXPECT_GT(seen, 5000U);
}

model::Hash128 HashOf(const std::vector<model::ElementPtr>& standing,
                      std::vector<std::string> hidden_levels = {}) {
  model::Orthophoto made = OrthophotoOf(SkewedCamera(), kFrame);
  model::Model model = ModelOf(standing);
  model.hidden_levels = std::make_shared<const std::vector<std::string>>(std::move(hidden_levels));
  made.standing = std::make_shared<const model::Model>(std::move(model));
  model::Hasher hasher;
  AddToHash(hasher, made);
  return hasher.Finish();
}

TEST(Orthophoto, OnlyWhatCouldHideItChangesWhatItIs) {
  const model::ElementPtr pier = WallOf({3, -2, 0}, 0.7, 3.3);
  const model::Hash128 alone = HashOf({pier});
  EXPECT_NE(alone, HashOf({}));
  EXPECT_NE(alone, HashOf({WallOf({3, -1.9, 0}, 0.7, 3.3)}));
  // Behind it, far aside of it, behind the camera; and what has no faces.
  EXPECT_EQ(alone, HashOf({pier, WallOf({0, 1, 0}, 8, 5)}));
  EXPECT_EQ(alone, HashOf({pier, WallOf({60, -2, 0}, 8, 5)}));
  EXPECT_EQ(alone, HashOf({pier, WallOf({3, -30, 0}, 8, 5)}));
  EXPECT_EQ(alone, HashOf({LineOf({3, -2, 0}, {4, -2, 3}), pier}));
  EXPECT_EQ(HashOf({pier}, {"1"}), HashOf({}));
}

}  // namespace
}  // namespace tranos::output
