// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/orthophoto.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>

#include "camera/facade_view.h"
#include "output/parallel.h"
#include "output/parts.h"

namespace tranos::output {
namespace {

using camera::Mat3;
using camera::Photo;
using geom::Vec2;
using geom::Vec3;
using model::Orthophoto;

constexpr int kBand_px = 64;  // rows that are made at a time
constexpr int kSpan_px = 64;  // pixels of a row that are sampled from one size of the photograph
constexpr int kShift = 8;     // bits of a weight
constexpr double kChord_m = 0.005;  // facets of what hides the facade deviate by this at most

// The photograph at full size, a half, a quarter …
std::vector<Photo> SizesOf(const Photo& photo, int count, int threads) {
  std::vector<Photo> sizes;
  const Photo* whole = &photo;
  for (int k = 1; k < count; ++k) {
    Photo half{std::max(whole->width_px / 2, 1), std::max(whole->height_px / 2, 1), {}};
    half.rgb.resize(std::size_t{3} * half.width_px * half.height_px);
    const auto at = [&](int x, int y, int c) -> int {
      const int column = std::min(x, whole->width_px - 1), row = std::min(y, whole->height_px - 1);
      return whole->rgb[3 * (static_cast<std::size_t>(row) * whole->width_px + column) + c];
    };
    ParallelFor(static_cast<std::size_t>(half.height_px), threads, [&](std::size_t row) {
      const int y = static_cast<int>(row);
      std::uint8_t* to = &half.rgb[row * 3 * half.width_px];
      for (int x = 0; x < half.width_px; ++x) {
        for (int c = 0; c < 3; ++c) {
          const int sum = at(2 * x, 2 * y, c) + at(2 * x + 1, 2 * y, c) + at(2 * x, 2 * y + 1, c) +
                          at(2 * x + 1, 2 * y + 1, c);
          *to++ = static_cast<std::uint8_t>((sum + 2) / 4);
        }
      }
    });
    sizes.push_back(std::move(half));
    whole = &sizes.back();
  }
  return sizes;
}

// The convex outline of a triangle's shadow on the orthophoto, in its pixels.
struct Shadow {
  std::array<Vec2, 5> corners;
  int count = 0;
  double top, bottom;
};

// The part of a polygon, in the plane's coordinates, that is at least `low` above it, or, with
// `sign` −1, at most −`low`.
void Cut(std::vector<Vec3>& polygon, double low, double sign) {
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double over_a = sign * a.z() - low, over_b = sign * b.z() - low;
    if (over_a >= 0) kept.push_back(a);
    if ((over_a >= 0) != (over_b >= 0)) {
      kept.push_back(a + over_a / (over_a - over_b) * (b - a));
    }
  }
  polygon = std::move(kept);
}

// Casts shadows onto the plane from the camera.
class Caster {
 public:
  Caster(const Orthophoto& orthophoto, const Vec3& camera_m)
      : orthophoto_(orthophoto), eye_(orthophoto.plane.ToLocal(camera_m)) {}

  // Nothing if it falls beside the orthophoto.
  std::optional<Shadow> Of(const std::array<Vec3, 3>& triangle) const {
    std::vector<Vec3> polygon;
    for (const Vec3& p : triangle) polygon.push_back(orthophoto_.plane.ToLocal(p));
    Cut(polygon, orthophoto_.tolerance_m, 1);
    // What is as high as the camera casts none onto the plane.
    Cut(polygon, -eye_.z() * (1 - 1e-9), -1);
    if (polygon.size() < 3 || polygon.size() > 5) return std::nullopt;
    Shadow shadow;
    Vec2 least = Vec2::Constant(1e300), most = -least;
    for (const Vec3& p : polygon) {
      const Vec2 cast = (eye_ + eye_.z() / (eye_.z() - p.z()) * (p - eye_)).head<2>();
      const Vec2 pixel(cast.x() / orthophoto_.pixel_m - 0.5,
                       orthophoto_.size_px.y() - cast.y() / orthophoto_.pixel_m - 0.5);
      shadow.corners[static_cast<std::size_t>(shadow.count++)] = pixel;
      least = least.cwiseMin(pixel), most = most.cwiseMax(pixel);
    }
    shadow.top = least.y(), shadow.bottom = most.y();
    const Eigen::Vector2i size = orthophoto_.size_px;
    const bool meets =
        most.x() >= 0 && most.y() >= 0 && least.x() < size.x() && least.y() < size.y();
    return meets ? std::optional(shadow) : std::nullopt;
  }
  bool is_before_plane() const { return eye_.z() > orthophoto_.tolerance_m; }

 private:
  const Orthophoto& orthophoto_;
  Vec3 eye_;
};

Result<std::vector<Shadow>> ShadowsOn(const Orthophoto& orthophoto, const Vec3& camera_m,
                                      int threads) {
  const Caster caster(orthophoto, camera_m);
  std::vector<Shadow> shadows;
  if (!caster.is_before_plane()) return shadows;
  Parts parts = VisibleParts(*orthophoto.standing, threads);
  if (auto error = MakeFacets(parts, kChord_m, threads)) return tl::unexpected(*std::move(error));
  for (const Placement& placement : parts.placements) {
    const geom::Mesh& mesh = parts.parts[placement.part].facets.mesh;
    for (const auto& triangle : mesh.triangles) {
      std::array<Vec3, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = placement.world_from_part * mesh.positions[triangle[i]];
      }
      if (const auto shadow = caster.Of(corners)) shadows.push_back(*shadow);
    }
  }
  return shadows;
}

// Marks the centres that a shadow covers, in rows from `top` to before `bottom`.
void Fill(const Shadow& shadow, int top, int bottom, int width_px, Unseen* band) {
  const int first = std::max(top, static_cast<int>(std::ceil(std::max(shadow.top, -1.0))));
  const int last = std::min(bottom - 1, static_cast<int>(std::floor(std::min(shadow.bottom, 1e9))));
  for (int y = first; y <= last; ++y) {
    double left = 1e300, right = -1e300;
    for (int i = 0; i < shadow.count; ++i) {
      const Vec2& a = shadow.corners[static_cast<std::size_t>(i)];
      const Vec2& b = shadow.corners[static_cast<std::size_t>((i + 1) % shadow.count)];
      if (std::min(a.y(), b.y()) > y || std::max(a.y(), b.y()) < y) continue;
      // Of an edge along the row both ends count: its other end is the next edge's beginning.
      const double t = a.y() == b.y() ? 0 : (y - a.y()) / (b.y() - a.y());
      const double x = a.x() + t * (b.x() - a.x());
      left = std::min(left, x), right = std::max(right, x);
    }
    const int from =
        static_cast<int>(std::ceil(std::clamp(left, 0.0, static_cast<double>(width_px))));
    const int to = static_cast<int>(std::floor(std::clamp(right, -1.0, width_px - 1.0)));
    Unseen* const row = band + static_cast<std::size_t>(y - top) * width_px;
    if (from <= to) std::fill(row + from, row + to + 1, Unseen::kHidden);
  }
}

// Samples rows of the orthophoto from the photograph.
class Sampler {
 public:
  Sampler(const Orthophoto& orthophoto, const model::Photograph& taken, int threads)
      : photo_(*orthophoto.pixels) {
    const double pixel = orthophoto.pixel_m;
    Mat3 metres_from_pixel;
    metres_from_pixel << pixel, 0, 0.5 * pixel,             //
        0, -pixel, (orthophoto.size_px.y() - 0.5) * pixel,  //
        0, 0, 1;
    dot_from_pixel_ = camera::DotFromPlane(taken.estimate->camera, taken.frame, orthophoto.plane) *
                      metres_from_pixel;
    int count = 1;
    for (double scale = MostDots(orthophoto.size_px); scale >= 2 && count < 12; scale /= 2) ++count;
    smaller_ = SizesOf(photo_, count, threads);
  }

  // Fills a row but for what is hidden. Returns how many pixels of it are outside the photograph.
  std::size_t Row(int y, int width_px, Unseen* why, std::uint8_t* rgb, std::uint8_t* alpha) const {
    std::size_t outside = 0;
    for (int x = 0; x < width_px; x += kSpan_px) {
      const int count = std::min(kSpan_px, width_px - x);
      outside += Span(x, y, count, why + x, rgb + std::size_t{3} * x, alpha + x);
    }
    return outside;
  }

 private:
  // How many dots a pixel covers there along each side, in the mean; 0 behind the camera.
  double DotsAt(double x, double y) const {
    const Vec3 dot = dot_from_pixel_ * Vec3(x, y, 1);
    if (!(dot.z() > 0)) return 0;
    return std::sqrt(std::abs(dot_from_pixel_.determinant()) / (dot.z() * dot.z() * dot.z()));
  }
  double MostDots(const Eigen::Vector2i& size_px) const {
    constexpr int kSteps = 32;
    double most = 0;
    for (int i = 0; i <= kSteps; ++i) {
      for (int k = 0; k <= kSteps; ++k) {
        most = std::max(most,
                        DotsAt(size_px.x() * i / double{kSteps}, size_px.y() * k / double{kSteps}));
      }
    }
    return most;
  }
  bool IsInside(double u, double v) const {
    return u >= -0.5 && v >= -0.5 && u <= photo_.width_px - 0.5 && v <= photo_.height_px - 0.5;
  }

  std::size_t Span(int x0, int y, int count, Unseen* why, std::uint8_t* rgb,
                   std::uint8_t* alpha) const {
    // Where the pixels are on the photograph; w is the depth but for a factor above 0.
    std::array<double, kSpan_px> u, v, w;
    const Mat3& h = dot_from_pixel_;
    for (int i = 0; i < count; ++i) {
      const double x = x0 + i;
      w[i] = h(2, 0) * x + h(2, 1) * y + h(2, 2);
      u[i] = (h(0, 0) * x + h(0, 1) * y + h(0, 2)) / w[i];
      v[i] = (h(1, 0) * x + h(1, 1) * y + h(1, 2)) / w[i];
    }
    const double dots = DotsAt(x0 + 0.5 * (count - 1), y);
    const int level = std::clamp(dots >= 2 ? static_cast<int>(std::log2(dots)) : 0, 0,
                                 static_cast<int>(smaller_.size()));
    const Photo& source = level == 0 ? photo_ : smaller_[static_cast<std::size_t>(level) - 1];
    const double share = 1.0 / (1 << level), shift = 0.5 * share - 0.5;
    std::size_t outside = 0;
    for (int i = 0; i < count; ++i) {
      if (why[i] != Unseen::kSeen) continue;
      if (!(w[i] > 0) || !IsInside(u[i], v[i])) {
        why[i] = Unseen::kOutside;
        ++outside;
        continue;
      }
      alpha[i] = 255;
      Blend(source, share * u[i] + shift, share * v[i] + shift, rgb + std::size_t{3} * i);
    }
    return outside;
  }

  static void Blend(const Photo& source, double u, double v, std::uint8_t* to) {
    constexpr int kOne = 1 << kShift;
    const int right = source.width_px - 1, bottom = source.height_px - 1;
    const int fixed_u = std::clamp(static_cast<int>(u * kOne), 0, right * kOne);
    const int fixed_v = std::clamp(static_cast<int>(v * kOne), 0, bottom * kOne);
    const int x = fixed_u >> kShift, y = fixed_v >> kShift;
    const int a = fixed_u & (kOne - 1), b = fixed_v & (kOne - 1);
    const std::size_t across = x < right ? 3 : 0;
    const std::size_t down = y < bottom ? std::size_t{3} * source.width_px : 0;
    const std::uint8_t* p = &source.rgb[3 * (static_cast<std::size_t>(y) * source.width_px +
                                             static_cast<std::size_t>(x))];
    const int w00 = (kOne - a) * (kOne - b), w10 = a * (kOne - b), w01 = (kOne - a) * b,
              w11 = a * b;
    for (int c = 0; c < 3; ++c, ++p) {
      const int sum = w00 * p[0] + w10 * p[across] + w01 * p[down] + w11 * p[down + across];
      to[c] = static_cast<std::uint8_t>((sum + (1 << (2 * kShift - 1))) >> (2 * kShift));
    }
  }

  const Photo& photo_;
  std::vector<Photo> smaller_;  // halves of it, quarters …
  Mat3 dot_from_pixel_;
};

}  // namespace

Result<RectifiedFacade> Rectify(const Orthophoto& orthophoto, int threads) {
  if (!orthophoto.pixels) return tl::unexpected(Error{"the photograph's pixels are not at hand"});
  const auto& taken = *std::get<model::PhotographPtr>(orthophoto.photograph->geometry);
  const auto shadows = ShadowsOn(orthophoto, taken.estimate->camera.position_m(), threads);
  if (!shadows) return tl::unexpected(shadows.error());
  const Sampler sampler(orthophoto, taken, threads);
  const int width = orthophoto.size_px.x(), height = orthophoto.size_px.y();
  const auto count = static_cast<std::size_t>(width) * height;
  RectifiedFacade made{
      {width, height, std::vector<std::uint8_t>(3 * count), std::vector<std::uint8_t>(count)},
      {std::vector<Unseen>(count)}};
  std::atomic<std::size_t> outside = 0, hidden = 0;
  const int bands = (height + kBand_px - 1) / kBand_px;
  ParallelFor(static_cast<std::size_t>(bands), threads, [&](std::size_t band) {
    const int top = static_cast<int>(band) * kBand_px, bottom = std::min(top + kBand_px, height);
    Unseen* const why = &made.seen.why[static_cast<std::size_t>(top) * width];
    for (const Shadow& shadow : *shadows) {
      if (shadow.bottom >= top && shadow.top <= bottom) Fill(shadow, top, bottom, width, why);
    }
    for (int y = top; y < bottom; ++y) {
      const std::size_t at = static_cast<std::size_t>(y) * width;
      outside += sampler.Row(y, width, &made.seen.why[at], &made.picture.rgb[3 * at],
                             &made.picture.alpha[at]);
    }
    hidden += static_cast<std::size_t>(
        std::count(why, why + static_cast<std::ptrdiff_t>(bottom - top) * width, Unseen::kHidden));
  });
  made.seen.outside = outside;
  made.seen.hidden = hidden;
  return made;
}

}  // namespace tranos::output
