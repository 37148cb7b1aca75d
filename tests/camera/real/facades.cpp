// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/camera/real/facades.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tranos::camera::real {
namespace {

constexpr std::size_t kLeastDots = 100;

bool IsWindow(const Photo& labels, int x, int y) {
  const std::uint8_t* dot = &labels.rgb[3 * (static_cast<std::size_t>(y) * labels.width_px + x)];
  return dot[0] == 255 && dot[1] == 0 && dot[2] == 0;
}

// Dots of windows that hang together by their sides.
std::vector<std::vector<Eigen::Vector2i>> WindowsOf(const Photo& labels) {
  std::vector<bool> seen(static_cast<std::size_t>(labels.width_px) * labels.height_px, false);
  const auto place = [&](int x, int y) {
    return static_cast<std::size_t>(y) * labels.width_px + x;
  };
  std::vector<std::vector<Eigen::Vector2i>> windows;
  for (int y = 0; y < labels.height_px; ++y) {
    for (int x = 0; x < labels.width_px; ++x) {
      if (seen[place(x, y)] || !IsWindow(labels, x, y)) continue;
      std::vector<Eigen::Vector2i> window{{x, y}};
      seen[place(x, y)] = true;
      bool is_cut = false;
      for (std::size_t i = 0; i < window.size(); ++i) {
        const Eigen::Vector2i at = window[i];
        for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
          const int u = at.x() + dx, v = at.y() + dy;
          const bool inside = u >= 0 && v >= 0 && u < labels.width_px && v < labels.height_px;
          is_cut |= !inside;
          if (!inside || seen[place(u, v)] || !IsWindow(labels, u, v)) continue;
          seen[place(u, v)] = true;
          window.emplace_back(u, v);
        }
      }
      if (!is_cut && window.size() >= kLeastDots) windows.push_back(std::move(window));
    }
  }
  return windows;
}

}  // namespace

std::vector<Front> Fronts(const std::filesystem::path& data) {
  std::vector<Front> fronts;
  for (const char* name : {"IMG_5504", "IMG_5505", "IMG_5717", "IMG_5718"}) {
    Front front;
    front.photograph.name = name;
    front.photograph.file = data / "facade" / "images" / (std::string(name) + ".jpg");
    Known labels;
    labels.file = data / "facade" / "labels" / (std::string(name) + ".png");
    const Photo labelled = PhotoOf(labels);
    front.photograph.frame = {{36, 36.0 * labelled.height_px / labelled.width_px},
                              {labelled.width_px, labelled.height_px}};
    front.windows = WindowsOf(labelled);
    fronts.push_back(std::move(front));
  }
  return fronts;
}

Mat3 FrontFromDot(const Known& photograph, const Found& found, std::span<const ImageLine> lines,
                  std::span<const int> axis) {
  std::array<double, 3> length{};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (axis[i] != kNoAxis) length[static_cast<std::size_t>(axis[i])] += lines[i].length_px();
  }
  const int along = length[0] >= length[1] ? 0 : 1;
  const Mat3 dot_from_world = found.dot_from_camera * found.camera_from_world;
  Mat3 dot_from_front;  // with the middle of the picture for its origin
  dot_from_front << dot_from_world.col(along), dot_from_world.col(2),
      photograph.frame.centre_px().homogeneous();
  return dot_from_front.inverse();
}

double BoxFilled(const std::vector<Eigen::Vector2i>& window, const Mat3& front_from_dot) {
  double area = 0;
  Vec2 least = Vec2::Constant(1e30), most = -least;
  for (const Eigen::Vector2i& dot : window) {
    std::array<Vec2, 4> corner;
    for (int i = 0; i < 4; ++i) {
      const Vec2 at = dot.cast<double>() + Vec2(i == 1 || i == 2 ? 0.5 : -0.5, i > 1 ? 0.5 : -0.5);
      corner[i] = (front_from_dot * at.homogeneous()).hnormalized();
      least = least.cwiseMin(corner[i]), most = most.cwiseMax(corner[i]);
    }
    const Vec2 p = corner[2] - corner[0], q = corner[3] - corner[1];
    area += 0.5 * std::abs(p.x() * q.y() - p.y() * q.x());
  }
  return area / (most - least).prod();
}

}  // namespace tranos::camera::real
