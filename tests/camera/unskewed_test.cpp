// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/unskewed.h"

#include <gtest/gtest.h>

namespace tranos::camera {
namespace {

constexpr double kRounding_px = 1e-9;

FramedCamera Skewed(double skew_deg, double aspect) {
  Camera camera;
  const double d = kPi / 180;
  camera.parameters << 35, aspect, 0.9, -0.7, skew_deg * d, 4 * d, 15 * d, 2 * d, 8, -14, 2;
  return {{{36, 27}, {320, 240}}, camera};
}

// A wall y = 0 with waves of a metre or so on it, in the three channels: some ten pixels a wave.
std::array<double, 3> LevelsAt(const Vec3& point) {
  const auto wave = [](double x) { return 127.5 + 100 * std::sin(x); };
  return {wave(3 * point.x()), wave(3 * point.z() + 1), wave(2 * (point.x() + point.z()))};
}

// Where the ray of a dot meets the wall.
Vec3 OnWall(const FramedCamera& framed, const Vec2& dot_px) {
  const Vec3 in_camera = DotFromCamera(framed).inverse() * dot_px.homogeneous();
  const Vec3 ray = CameraFromWorld(framed.camera.parameters).transpose() * in_camera;
  const Vec3 from = framed.camera.position_m();
  return from - from.y() / ray.y() * ray;
}

Photo Taken(const FramedCamera& framed) {
  const auto [width, height] = std::pair(framed.frame.size_px.x(), framed.frame.size_px.y());
  Photo photo{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (const double level : LevelsAt(OnWall(framed, Vec2(x, y)))) {
        photo.rgb.push_back(static_cast<std::uint8_t>(std::lround(level)));
      }
    }
  }
  return photo;
}

class UnskewedCameras : public testing::TestWithParam<std::tuple<double, double, PixelShape>> {
 protected:
  FramedCamera framed() const { return Skewed(std::get<0>(GetParam()), std::get<1>(GetParam())); }
  Unskewed unskewed() const { return *UnskewedOf(framed(), std::get<2>(GetParam())); }
};

TEST_P(UnskewedCameras, HaveRightAnglesAndStandWhereTheyStood) {
  const Unskewed made = unskewed();
  const Camera& seen = made.view.camera;
  EXPECT_EQ(seen[kSkew], kPi / 2);
  EXPECT_EQ(seen.position_m(), framed().camera.position_m());
  EXPECT_EQ(CameraFromWorld(seen.parameters), CameraFromWorld(framed().camera.parameters));
  const Mat3 k = DotFromCamera(made.view), before = DotFromCamera(framed());
  EXPECT_NEAR(k(1, 1), before(1, 1), kRounding_px);
  const bool square = std::get<2>(GetParam()) == PixelShape::kSquare;
  EXPECT_NEAR(k(0, 0), square ? before(1, 1) : before(0, 0), kRounding_px);
  EXPECT_LT((made.new_dot_from_dot * before - k).cwiseAbs().maxCoeff(), kRounding_px);
}

TEST_P(UnskewedCameras, HoldTheWholeOldFrameAndNoMoreThanAPixelBesides) {
  const Unskewed made = unskewed();
  const Eigen::Vector2i size = framed().frame.size_px;
  double left = 1e9, right = -1e9;
  for (const double x : {-0.5, size.x() - 0.5}) {
    for (const double y : {-0.5, size.y() - 0.5}) {
      const Vec2 corner = (made.new_dot_from_dot * Vec3(x, y, 1)).hnormalized();
      EXPECT_NEAR(corner.y(), y, kRounding_px);
      left = std::min(left, corner.x());
      right = std::max(right, corner.x());
    }
  }
  EXPECT_NEAR(left, -0.5, kRounding_px);
  EXPECT_LE(right, made.view.frame.size_px.x() - 0.5 + 1e-6);
  EXPECT_GT(right, made.view.frame.size_px.x() - 1.5 - 1e-6);
}

// The warped picture is what the new camera sees, to what rounding to whole levels and resampling
// of waves of ten pixels leave.
TEST_P(UnskewedCameras, SeeTheWarpedPicture) {
  const Unskewed made = unskewed();
  const Photo warped = Warped(Taken(framed()), made), taken = Taken(made.view);
  ASSERT_EQ(warped.rgb.size(), taken.rgb.size());
  const Mat3 back = made.new_dot_from_dot.inverse();
  int inside = 0;
  for (int y = 0; y < taken.height_px; ++y) {
    for (int x = 0; x < taken.width_px; ++x) {
      const double old_x = (back * Vec3(x, y, 1)).x();
      const std::size_t at = std::size_t{3} * (y * taken.width_px + x);
      if (old_x > 2 && old_x < framed().frame.size_px.x() - 3) {
        ++inside;
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(warped.rgb[at + c], taken.rgb[at + c], 3);
      } else if (old_x < -1 || old_x > framed().frame.size_px.x()) {
        for (int c = 0; c < 3; ++c) ASSERT_EQ(warped.rgb[at + c], 0);
      }
    }
  }
  EXPECT_GT(inside, 60'000);
}

INSTANTIATE_TEST_SUITE_P(
    OfManyShapes, UnskewedCameras,
    testing::Combine(testing::Values(80.0, 89.0, 92.5), testing::Values(0.94, 1.0, 1.06),
                     testing::Values(PixelShape::kRectangular, PixelShape::kSquare)));

TEST(Unskewed, WithoutSkewNothingChanges) {
  const FramedCamera framed = Skewed(90, 1.03);
  const auto same = UnskewedOf(framed, PixelShape::kRectangular);
  ASSERT_TRUE(same.has_value());
  EXPECT_FALSE(same->changed);
  EXPECT_TRUE(UnskewedOf(framed, PixelShape::kSquare)->changed);
  const Photo photo = Taken(framed);
  EXPECT_EQ(Warped(photo, *same).rgb, photo.rgb);
}

TEST(Unskewed, ASkewThatMakesThePictureTooLargeIsRefused) {
  FramedCamera framed = Skewed(2, 1);
  framed.frame.size_px = {12'000, 9'000};
  const auto refused = UnskewedOf(framed, PixelShape::kRectangular);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, geom::ErrorCode::kTooLarge);
}

}  // namespace
}  // namespace tranos::camera
