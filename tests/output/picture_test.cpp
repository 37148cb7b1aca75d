// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/picture.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "output/gltf.h"
#include "output/png.h"
#include "tests/output/models.h"

namespace tranos::output {
namespace {

using geom::Vec3;
using model::RenderMode;

Picture FrontOf(std::vector<model::ElementPtr> elements, RenderMode mode, bool antialias = false) {
  model::RenderRequest request;
  request.model = ModelOf(std::move(elements));
  request.view.mode = mode;
  request.view.antialias = antialias;
  request.view.direction = "front";
  request.width_px = 400;
  request.height_px = 300;
  return *Render(request, 2);
}
int At(const Picture& picture, int x, int y, int channel = 0) {
  return picture.rgb[3 * (static_cast<std::size_t>(y) * picture.width_px + x) + channel];
}
bool IsWhite(const Picture& picture, int x, int y) {
  return At(picture, x, y) + At(picture, x, y, 1) + At(picture, x, y, 2) == 3 * 255;
}
// The ground of shaded pictures is bluish or neutral; light stone is redder than it is blue.
int StonePixels(const Picture& picture) {
  int count = 0;
  for (int y = 0; y < picture.height_px; ++y) {
    for (int x = 0; x < picture.width_px; ++x)
      count += At(picture, x, y) > At(picture, x, y, 2) + 6;
  }
  return count;
}

TEST(Picture, SphereHasTheSilhouetteOfACircleWithMargin) {
  const Picture picture = FrontOf({SphereOf()}, RenderMode::kPhong);
  const double radius_px = 0.5 * 0.9 * 300;
  EXPECT_NEAR(StonePixels(picture), geom::kPi * radius_px * radius_px, 0.01 * 57000);
  EXPECT_GT(At(picture, 200, 18), At(picture, 200, 18, 2) + 6);
  EXPECT_LE(At(picture, 200, 12), At(picture, 200, 12, 2) + 6);
}

TEST(Picture, HiddenLineIsLeftOutAndWireframeShowsIt) {
  // A wall in front (smaller y) of a level line that is wider than the wall.
  const std::vector<model::ElementPtr> elements = {WallOf({2, 0, 0}, 4, 6),
                                                   LineOf({0, 5, 2}, {8, 5, 2})};
  const auto dark_in_column = [&](const Picture& picture, int x) {
    int count = 0;
    for (int y = 100; y < 250; ++y) count += At(picture, x, y) < 200;
    return count;
  };
  const Picture wire = FrontOf(elements, RenderMode::kWireframe);
  const Picture hidden = FrontOf(elements, RenderMode::kHidden);
  EXPECT_GT(dark_in_column(wire, 200), 0);
  EXPECT_EQ(dark_in_column(hidden, 200), 0);
  EXPECT_GT(dark_in_column(hidden, 50), 0);
}

model::RenderRequest ThroughFirst(std::vector<model::ElementPtr> elements, RenderMode mode) {
  model::RenderRequest request;
  request.model = ModelOf(std::move(elements));
  request.view.mode = mode;
  request.view.camera = 0;
  request.width_px = 600, request.height_px = 400;
  return request;
}

TEST(Picture, AHiddenLineThroughACameraIsLeftOutWhereverTheModelsMiddleIs) {
  // A wall at 10 m, a line half a metre behind it, and what moves the middle of the model beside
  // the camera or behind it.
  for (const Vec3& far_off : {Vec3(0, 0, 0), Vec3(0, -60, 0), Vec3(300, -9, 0), Vec3(0, 900, 0)}) {
    const auto request =
        ThroughFirst({CameraAt({0, -10, 2}), WallOf({-3, 0, -1}, 6, 6),
                      LineOf({-8, 0.5, 2}, {8, 0.5, 2}), LineOf(far_off, far_off + Vec3(0, 1, 0))},
                     RenderMode::kHidden);
    const Picture picture = *Render(request, 2);
    const auto dark_in_column = [&](int x) {
      int count = 0;
      for (int y = 100; y < 250; ++y) count += At(picture, x, y) < 200;
      return count;
    };
    EXPECT_EQ(dark_in_column(300), 0) << far_off.transpose();
    EXPECT_GT(dark_in_column(60), 0) << far_off.transpose();
  }
}

TEST(Picture, AViewThroughACameraFollowsItWhenItIsMoved) {
  const auto wall_at = [](double x) {
    model::RenderRequest request =
        ThroughFirst({CameraAt({0, -10, 2}), WallOf({-1, 0, 0}, 2, 4)}, RenderMode::kPhong);
    model::Edit edit;
    edit.replaced = {model::WithId(*CameraAt({x, -10, 2}), 0)};
    request.model = model::Apply({request.model, {}}, edit).state.model;
    const Picture picture = *Render(request, 2);
    for (int i = 0; i < 600; ++i) {
      if (At(picture, i, 200) > At(picture, i, 200, 2) + 6) return i;
    }
    return -1;
  };
  const double focal_px = 25 / 40.5 * 600;
  EXPECT_NEAR(wall_at(0), 300 - focal_px / 10, 2);
  EXPECT_NEAR(wall_at(2), 300 - 3 * focal_px / 10, 2);
}

TEST(Picture, AFaceShowsThePhotographAsItIs) {
  model::RenderRequest request;
  request.model = ModelOf({EvenOrthophoto(100), WallOf({0, 0.01, 0}, 4, 3)});
  request.view.textured = true;
  request.width_px = 400, request.height_px = 300;
  for (const char* direction : {"front", "iso"}) {
    request.view.direction = direction;
    const Picture picture = *Render(request, 2);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(At(picture, 200, 150, c), 100) << direction;
  }
}

TEST(Picture, AFaceABitAslantBearsThePhotographAsInTheModelsFile) {
  // Within the tolerance over all its length, and beyond it at one end.
  for (const auto& [aside_m, bears] : {std::pair{0.015, true}, {0.04, false}}) {
    const auto aslant = ElementOf(std::make_shared<const geom::Surface>(
        *geom::Extrusion(geom::Line{{1, 0, 0}, {1.6, aside_m, 0}}, Vec3(0, 0, 2))));
    model::RenderRequest request;
    request.model = ModelOf({EvenOrthophoto(100), aslant});
    request.view.textured = true;
    request.view.direction = "front";
    request.width_px = 400, request.height_px = 300;
    const Picture picture = *Render(request, 2);
    EXPECT_EQ(At(picture, 200, 150) == 100, bears) << aside_m;
    const std::string glb = *GlbOf(request.model, {});
    const std::string textured = "\"name\":\"surface\"";
    EXPECT_NE(glb.find(textured), std::string::npos);
    const bool stands_alone = glb.find("\"name\":\"orthophoto\"") != std::string::npos;
    EXPECT_EQ(stands_alone, !bears) << aside_m;
  }
}

TEST(Picture, LineStylesLeaveGapsAndWeightsWiden) {
  const auto ink = [&](int linestyle, int weight) {
    model::Attributes attributes;
    attributes.linestyle = linestyle;
    attributes.weight = weight;
    const Picture picture =
        FrontOf({LineOf({0, 0, 0}, {8, 0, 0}, attributes)}, RenderMode::kWireframe);
    double sum = 0;
    for (int y = 0; y < picture.height_px; ++y) {
      for (int x = 0; x < picture.width_px; ++x) sum += 255 - At(picture, x, y);
    }
    return sum;
  };
  EXPECT_NEAR(ink(2, 1) / ink(0, 1), 8.0 / 13, 0.12);
  EXPECT_NEAR(ink(0, 4) / ink(0, 1), 4, 0.1);
}

TEST(Picture, AntialiasingLeavesFlatAreasAsTheyAre) {
  const std::vector<model::ElementPtr> wall = {WallOf({0, 0, 0}, 4, 3)};
  const Picture plain = FrontOf(wall, RenderMode::kPhong);
  const Picture smooth = FrontOf(wall, RenderMode::kPhong, true);
  for (int x : {5, 100, 200, 300}) {
    EXPECT_EQ(At(plain, x, 150), At(smooth, x, 150));
  }
}

TEST(Picture, SameBytesWithOneThreadAndWithEight) {
  model::RenderRequest request;
  // Two equal spheres: every ray meets a tie.
  request.model = ModelOf({SphereOf(), SphereOf(), LineOf({-2, 0, 0}, {2, 0, 0})});
  request.view.shadows = true;
  request.width_px = 200;
  request.height_px = 150;
  for (const RenderMode mode : {RenderMode::kWireframe, RenderMode::kHidden, RenderMode::kPhong}) {
    request.view.mode = mode;
    EXPECT_EQ(Render(request, 1)->rgb, Render(request, 8)->rgb);
  }
}

TEST(Picture, InstancesOverInstancesWithShadowsComeToAnEnd) {
  const auto prototype = std::make_shared<model::Prototype>();
  prototype->words = "ball";
  prototype->parts = {SphereOf()};
  std::vector<model::ElementPtr> elements;
  for (int i = 0; i < 5; ++i) {
    const auto instance = std::make_shared<model::Instance>();
    instance->prototype = prototype;
    instance->world_from_prototype = Eigen::Translation3d(0.7 * i, 0.2 * i, 0);
    elements.push_back(ElementOf(model::InstancePtr(instance)));
  }
  model::RenderRequest request;
  request.model = ModelOf(elements);
  request.view.shadows = true;
  EXPECT_GT(StonePixels(*Render(request, 2)), 10000);
}

TEST(Picture, OfNothingIsWhite) {
  const Picture picture = FrontOf({}, RenderMode::kHidden);
  EXPECT_TRUE(std::all_of(picture.rgb.begin(), picture.rgb.end(), [](int v) { return v == 255; }));
  EXPECT_TRUE(IsWhite(picture, 0, 0));
}

TEST(Picture, TooManyPixelsAreAnError) {
  model::RenderRequest request;
  request.width_px = kMaxSide_px + 1;
  EXPECT_FALSE(Render(request, 1).has_value());
}

TEST(Png, ReadsBackToTheSamePicture) {
  const Picture picture = FrontOf({SphereOf()}, RenderMode::kPhong);
  const std::string png = *PngOf(picture);
  EXPECT_EQ(png.find("tIME"), std::string::npos);
  const Picture back = *PictureOfPng(png);
  EXPECT_EQ(back.width_px, 400);
  EXPECT_EQ(back.rgb, picture.rgb);
  EXPECT_FALSE(PictureOfPng("no picture").has_value());
}

}  // namespace
}  // namespace tranos::output
