// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/photograph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "output/exposure.h"
#include "tests/output/models.h"

namespace tranos::output {
namespace {

using geom::Vec2;
using geom::Vec3;

constexpr double kDegree = geom::kPi / 180;

// A box in the air, 8 m by 6 m by 5 m, so that its corners stand before the sky.
constexpr double kLow = 3, kHigh = 8;
Vec3 Corner(int i) { return {i & 1 ? 8.0 : 0.0, i & 2 ? 6.0 : 0.0, i & 4 ? kHigh : kLow}; }
// It is dark, and the light is measured on a white wall beside it that stands on the ground.
model::Model DarkBoxInTheAir() {
  const auto face = [](int from, int right, int up) {
    model::Attributes attributes;
    attributes.colour = model::Colour{model::Colour::kRgb | 0x585858};
    return ElementOf(std::make_shared<const geom::Surface>(*geom::Extrusion(
                         geom::Line{Corner(from), Corner(right)}, Corner(up) - Corner(from))),
                     std::move(attributes));
  };
  return ModelOf({face(0, 1, 4), face(1, 3, 5), face(0, 1, 2), face(4, 5, 6), face(2, 3, 6),
                  face(0, 2, 4), WallOf({-50, 32, 0}, 19, 10)});
}

model::PhotoRequest RequestOf(double k1, double k2) {
  model::PhotoRequest request;
  request.model = DarkBoxInTheAir();
  request.taken = request.model.Current(0);
  request.camera.parameters << 33.33, 1.03, 0.4, -0.3, 88 * kDegree, 20 * kDegree, 25 * kDegree,
      1.5 * kDegree, 13, -14, -2;
  request.frame = {{40.5, 26.7}, {968, 638}};
  request.distortion = {{0.4, -0.3}, Vec2::Constant(request.frame.size_mm.norm() / 2), k1, k2};
  request.towards_sun = Vec3(-0.2, -0.8, 0.55).normalized();
  return request;
}

Vec2 Seen(const model::PhotoRequest& request, const Vec3& point) {
  const Vec3 dot = camera::DotFromWorld(request.camera, request.frame) * point.homogeneous();
  return camera::DistortDot(request.distortion, request.frame, dot.hnormalized());
}

// A picture of one channel, by the centres of its pixels.
struct Plane {
  std::function<double(int x, int y)> at;

  double At(const Vec2& p) const {
    const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
    const double u = p.x() - x, v = p.y() - y;
    return (1 - v) * ((1 - u) * at(x, y) + u * at(x + 1, y)) +
           v * ((1 - u) * at(x, y + 1) + u * at(x + 1, y + 1));
  }
};

// How far along `across` from a dot the step between two tones is: where a sharp one with the same
// sum of light would be.
double StepFrom(const Plane& plane, const Vec2& dot, const Vec2& across) {
  constexpr int kReach = 20;  // tenths of a pixel, fourfold
  const auto tone = [&](int i) { return plane.At(dot + 0.2 * i * across); };
  const double before = tone(-kReach), after = tone(kReach);
  double sum = 0;
  for (int i = -kReach; i < kReach; ++i) sum += 0.1 * (tone(i) + tone(i + 1));
  return (sum - 4 * (before + after)) / (before - after);
}

// By how much the corner of the picture is aside of where it should be: from the edges that meet
// in it, each measured from 16 to 40 pixels away.
Vec2 CornerOffset(const Plane& plane, const model::PhotoRequest& request, int corner,
                  const std::vector<int>& neighbours) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Vec2 right = Vec2::Zero();
  const Vec2 dot = Seen(request, Corner(corner));
  for (const int neighbour : neighbours) {
    const Vec3 way = Corner(neighbour) - Corner(corner);
    const double per_pixel = 1e-3 / (Seen(request, Corner(corner) + 1e-3 * way) - dot).norm();
    double sum = 0;
    int count = 0;
    Vec2 across;
    for (double away_px = 16; away_px <= 40; away_px += 0.5, ++count) {
      const double t = away_px * per_pixel;
      const Vec2 here = Seen(request, Corner(corner) + t * way);
      const Vec2 along = (Seen(request, Corner(corner) + (t + 1e-4) * way) - here).normalized();
      across = {-along.y(), along.x()};
      sum += StepFrom(plane, here, across);
    }
    normal += across * across.transpose();
    right += across * (sum / count);
  }
  return normal.inverse() * right;
}

// The corners that the camera sees, with the ends of the edges that meet there.
struct SeenCorner {
  int corner;
  std::vector<int> neighbours;
};
const SeenCorner kSeen[] = {{0, {4, 2}}, {1, {0, 5}}, {2, {0, 3}}, {3, {2, 7}},
                            {4, {0, 5}}, {5, {4, 7}}, {7, {3, 5}}};

double WorstCorner(const Plane& plane, const model::PhotoRequest& request) {
  double worst = 0;
  for (const auto& [corner, neighbours] : kSeen) {
    const Vec2 dot = Seen(request, Corner(corner));
    EXPECT_TRUE(dot.x() > 30 && dot.x() < 938 && dot.y() > 30 && dot.y() < 608)
        << corner << " at " << dot.transpose();
    worst = std::max(worst, CornerOffset(plane, request, corner, neighbours).norm());
  }
  return worst;
}

Plane PlaneOf(const Tones& tones) {
  return {[&tones](int x, int y) { return double{tones.At(x, y)}; }};
}

TEST(Photograph, CornersOfABoxAreExposedWhereTheCameraProjectsThem) {
  for (const auto& [k1, k2] : {std::pair{0.0, 0.0}, {-0.04, 0.0}, {0.05, -0.02}}) {
    const model::PhotoRequest request = RequestOf(k1, k2);
    const Tones plate = *Expose(request, 2);
    EXPECT_LT(WorstCorner(PlaneOf(plate), request), 0.2) << k1 << ", " << k2;
  }
}

TEST(Photograph, WithoutItsSkewOrDistortionTheyWouldBeElsewhere) {
  const model::PhotoRequest request = RequestOf(-0.04, 0);
  const Tones plate = *Expose(request, 2);
  model::PhotoRequest other = request;
  other.distortion.k1 = -0.02;
  EXPECT_GT(WorstCorner(PlaneOf(plate), other), 0.5);
  other = request;
  other.camera[camera::kSkew] = 89.5 * kDegree;
  EXPECT_GT(WorstCorner(PlaneOf(plate), other), 0.5);
}

TEST(Photograph, ThePrintKeepsThemThere) {
  const model::PhotoRequest request = RequestOf(-0.04, 0);
  const camera::Photo photo = *TakePhotograph(request, 2);
  const Plane plane{[&](int x, int y) {
    return double{photo.rgb[3 * (static_cast<std::size_t>(y) * photo.width_px + x)] * 1.0};
  }};
  EXPECT_LT(WorstCorner(plane, request), 0.25);
}

model::PhotoRequest AgedOf(double strength) {
  model::PhotoRequest request = RequestOf(0, 0);
  request.model =
      ModelOf({WallOf({-5, 0, 0}, 12, 8)});  // a light one, under a sky that is as light
  request.taken = request.model.Current(0);
  request.frame.size_px = {484, 319};
  request.effects = {strength, strength, strength, strength,
                     strength, strength, strength, strength};
  return request;
}

TEST(Photograph, IsTheSameWithAnyNumberOfThreads) {
  const model::PhotoRequest request = AgedOf(0.5);
  const camera::Photo one = *TakePhotograph(request, 1);
  EXPECT_EQ(one.rgb, TakePhotograph(request, 3)->rgb);
  EXPECT_EQ(one.rgb, TakePhotograph(request, 8)->rgb);
}

TEST(Photograph, AnotherSeedIsAnotherPrint) {
  model::PhotoRequest request = AgedOf(0.5);
  const camera::Photo one = *TakePhotograph(request, 2);
  request.seed = 2;
  EXPECT_NE(one.rgb, TakePhotograph(request, 2)->rgb);
  EXPECT_NE(model::HashOf(AgedOf(0.5)), model::HashOf(request));
}

double Mean(const camera::Photo& photo, int left, int top, int size) {
  double sum = 0;
  for (int y = top; y < top + size; ++y) {
    for (int x = left; x < left + size; ++x) {
      sum += photo.rgb[3 * (static_cast<std::size_t>(y) * photo.width_px + x)];
    }
  }
  return sum / (size * size);
}
double Deviation(const camera::Photo& photo, int left, int top, int size) {
  const double mean = Mean(photo, left, top, size);
  double sum = 0;
  for (int y = top; y < top + size; ++y) {
    for (int x = left; x < left + size; ++x) {
      const double off = photo.rgb[3 * (static_cast<std::size_t>(y) * photo.width_px + x)] - mean;
      sum += off * off;
    }
  }
  return std::sqrt(sum / (size * size));
}

// Each effect alone, against the same photograph without any.
class Effect : public testing::Test {
 protected:
  static camera::Photo With(double model::PrintEffects::*effect) {
    model::PhotoRequest request = AgedOf(0);
    request.effects.*effect = 1;
    return *TakePhotograph(request, 2);
  }
  static int Changed(const camera::Photo& a, int by) {
    int count = 0;
    for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
      count += std::abs(a.rgb[i] - Clean().rgb[i]) > by;
    }
    return count;
  }
  static const camera::Photo& Clean() {
    static const camera::Photo clean = *TakePhotograph(AgedOf(0), 2);
    return clean;
  }
  static constexpr int kSky = 40;  // a square of it is at the top left
};

TEST_F(Effect, GrainMakesEvenTonesUneven) {
  const camera::Photo grainy = With(&model::PrintEffects::grain);
  EXPECT_LT(Deviation(Clean(), 8, 8, kSky), 3);
  EXPECT_GT(Deviation(grainy, 8, 8, kSky), 8);
  EXPECT_NEAR(Mean(grainy, 8, 8, kSky), Mean(Clean(), 8, 8, kSky), 5);
}
TEST_F(Effect, VignettingDarkensTheCornersAndNotTheMiddle) {
  const camera::Photo dark = With(&model::PrintEffects::vignette);
  EXPECT_LT(Mean(dark, 0, 0, 16), 0.8 * Mean(Clean(), 0, 0, 16));
  EXPECT_LT(Mean(dark, 468, 0, 16), 0.8 * Mean(Clean(), 468, 0, 16));
  EXPECT_NEAR(Mean(dark, 234, 152, 16), Mean(Clean(), 234, 152, 16), 4);
}
TEST_F(Effect, FadingLightensShadowsAndTakesContrast) {
  const camera::Photo faded = With(&model::PrintEffects::fade);
  const auto darkest = [](const camera::Photo& photo) {
    return *std::min_element(photo.rgb.begin(), photo.rgb.end());
  };
  EXPECT_GT(darkest(faded), darkest(Clean()) + 15);
}
TEST_F(Effect, DustScratchesAndStainsCoverSomeOfIt) {
  for (const auto effect : {&model::PrintEffects::dust, &model::PrintEffects::scratches,
                            &model::PrintEffects::stains}) {
    const int changed = Changed(With(effect), 6);
    EXPECT_GT(changed, 150);
    EXPECT_LT(changed, 0.5 * 484 * 319);
  }
}
TEST_F(Effect, PaperAndScannerLeaveTraces) {
  EXPECT_GT(Deviation(With(&model::PrintEffects::paper), 8, 8, kSky), 2);
  EXPECT_GT(Deviation(With(&model::PrintEffects::scan), 8, 8, kSky), 5);
}

// A white wall with its back to the sun, which fills the picture.
model::PhotoRequest ShadeOf(const Vec3& place_m, const char* material) {
  model::PhotoRequest request;
  model::Attributes attributes;
  attributes.colour = model::Colour{model::Colour::kRgb | 0xe0e0e0};
  attributes.material = material;
  const Vec3 corner = place_m + Vec3(-30, 0, -2);
  request.model =
      ModelOf({ElementOf(std::make_shared<const geom::Surface>(*geom::Extrusion(
                             geom::Line{corner, corner + Vec3(60, 0, 0)}, Vec3(0, 0, 40))),
                         std::move(attributes))});
  request.taken = request.model.Current(0);
  request.camera.parameters << 36, 1, 0, 0, 90 * kDegree, 0, 0, 0, place_m.x(), place_m.y() - 12,
      place_m.z() + 8;
  request.frame = {{36, 24}, {960, 640}};
  request.distortion.unit_mm = Vec2::Constant(20);
  request.towards_sun = Vec3(0, 0.8, 0.6);
  return request;
}

TEST(Photograph, TheLightOfTheSkyIsEven) {
  const Tones plate = *Expose(ShadeOf({0, 0, 0}, ""), 2);
  // Between neighbours two pixels apart there is little of the pattern, and all of the noise.
  double squares = 0;
  int count = 0;
  for (int y = 100; y < 540; ++y) {
    for (int x = 100; x < 860; ++x, ++count) {
      const double mean = 0.25 * (plate.At(x - 1, y) + plate.At(x + 1, y) + plate.At(x, y - 1) +
                                  plate.At(x, y + 1));
      squares += std::pow(plate.At(x, y) - mean, 2);
    }
  }
  EXPECT_LT(255 * std::sqrt(squares / count), 2.5);
}

TEST(Photograph, IsTheSameInTheCoordinatesOfASurvey) {
  // 122 and 1220 steps of the patterns away, as east and north are.
  const Tones here = *Expose(ShadeOf({0, 0, 0}, "brick"), 2);
  const Tones there = *Expose(ShadeOf({122 * 4096.0, 1220 * 4096.0, 0}, "brick"), 2);
  double sum = 0;
  for (std::size_t i = 0; i < here.values.size(); ++i) {
    sum += std::abs(here.values[i] - there.values[i]);
  }
  EXPECT_LT(255 * sum / static_cast<double>(here.values.size()), 1);
}

TEST(PhotoRequest, DependsOnWhatIsSeenAlone) {
  const model::PhotoRequest request = RequestOf(0, 0);
  const auto with = [&](model::ElementPtr element) {
    model::PhotoRequest more = request;
    model::Edit edit;
    edit.added = {std::move(element)};
    more.model = model::Apply(model::State{request.model, {}}, edit).state.model;
    return HashOf(more);
  };
  model::Attributes brick;
  brick.material = "brick";
  const model::ElementPtr wall = WallOf({20, 5, 0}, 3, 2);
  const model::ElementPtr of_brick = ElementOf(wall->geometry, brick);
  EXPECT_EQ(HashOf(request), with(LineOf({0, 0, 0}, {1, 0, 0})));
  EXPECT_NE(HashOf(request), with(wall));
  EXPECT_NE(with(wall), with(WallOf({21, 5, 0}, 3, 2)));
  EXPECT_NE(with(wall), with(of_brick));
}

TEST(Photograph, ALensThatFoldsThePictureIsRefused) {
  const auto refused = TakePhotograph(RequestOf(-0.3, -0.3), 2);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("fold"), std::string::npos);
}

}  // namespace
}  // namespace tranos::output
