// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/unskewed.h"

#include <algorithm>
#include <array>

namespace tranos::camera {

namespace {

// What rounding leaves of no skew and square pixels, of the frame's size.
constexpr double kNoChange = 1e-9;

// Catmull and Rom's cubic (Keys 1981, a = −1/2).
double Kernel(double x) {
  x = std::abs(x);
  if (x < 1) return (1.5 * x - 2.5) * x * x + 1;
  if (x < 2) return ((-0.5 * x + 2.5) * x - 4) * x + 2;
  return 0;
}

std::uint8_t Level(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

// The row's colour at x, from the pixels that `scale` widens the kernel over.
std::array<std::uint8_t, 3> ColourAt(const std::uint8_t* row, int width_px, double x,
                                     double scale) {
  if (x < -0.5 || x > width_px - 0.5) return {0, 0, 0};
  const int first = std::max(0, static_cast<int>(std::ceil(x - 2 * scale)));
  const int last = std::min(width_px - 1, static_cast<int>(std::floor(x + 2 * scale)));
  double weight = 0;
  std::array<double, 3> sum{};
  for (int i = first; i <= last; ++i) {
    const double w = Kernel((x - i) / scale);
    weight += w;
    for (int c = 0; c < 3; ++c) sum[c] += w * row[3 * i + c];
  }
  return {Level(sum[0] / weight), Level(sum[1] / weight), Level(sum[2] / weight)};
}

}  // namespace

geom::Result<Unskewed> UnskewedOf(const FramedCamera& framed, PixelShape shape) {
  const auto& [frame, camera] = framed;
  const Mat3 k = DotFromCamera(framed);
  const bool square = shape == PixelShape::kSquare;
  const double a = square ? k(1, 1) / k(0, 0) : 1;
  const double b = -k(0, 1) / k(0, 0) * (square ? 1 : k(0, 0) / k(1, 1));
  const double width = frame.size_px.x(), height = frame.size_px.y();
  if (std::abs(a - 1) < kNoChange && std::abs(b) * height < kNoChange * width) {
    return Unskewed{framed};
  }
  const double spread = a * width + std::abs(b) * height;
  if (spread * height > static_cast<double>(kMaxPhotoPixels)) {
    return tl::unexpected(
        geom::Error{geom::ErrorCode::kTooLarge, "without skew the photograph would be too large"});
  }
  // The leftmost corner goes to the left border, half a pixel before the first one's centre.
  const double c = -0.5 + 0.5 * a + std::max(b * 0.5, -b * (height - 0.5));
  Unskewed unskewed;
  unskewed.changed = true;
  unskewed.new_dot_from_dot << a, b, c, 0, 1, 0, 0, 0, 1;
  Frame& taken = unskewed.view.frame;
  const Vec2 pitch = frame.pitch_mm();
  taken.size_px = {static_cast<int>(std::ceil(spread - kNoChange * width)), frame.size_px.y()};
  taken.size_mm = {taken.size_px.x() * (square ? pitch.y() : pitch.x()), frame.size_mm.y()};
  const Vec3 principal = unskewed.new_dot_from_dot * k.col(2);
  Camera& seen = unskewed.view.camera = camera;
  seen[kSkew] = kPi / 2;
  if (square) {
    seen[kFocal] = camera[kFocal] * camera[kAspect];
    seen[kAspect] = 1;
  }
  seen.parameters.segment<2>(kPrincipalX) = taken.PointFromDot(principal.head<2>());
  return unskewed;
}

Photo Warped(const Photo& photo, const Unskewed& unskewed) {
  if (!unskewed.changed) return photo;
  const Eigen::Vector2i size_px = unskewed.view.frame.size_px;
  Photo warped{size_px.x(), size_px.y(), {}};
  warped.rgb.resize(std::size_t{3} * size_px.x() * size_px.y());
  const Mat3& m = unskewed.new_dot_from_dot;
  const double scale = std::max(1.0, 1 / m(0, 0));
  for (int y = 0; y < size_px.y(); ++y) {
    const std::uint8_t* from = photo.rgb.data() + std::size_t{3} * photo.width_px * y;
    std::uint8_t* to = warped.rgb.data() + std::size_t{3} * size_px.x() * y;
    for (int x = 0; x < size_px.x(); ++x, to += 3) {
      const double source = (x - m(0, 1) * y - m(0, 2)) / m(0, 0);
      const auto colour = ColourAt(from, photo.width_px, source, scale);
      std::copy(colour.begin(), colour.end(), to);
    }
  }
  return warped;
}

}  // namespace tranos::camera
