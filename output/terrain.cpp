// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/terrain.h"

#include <algorithm>
#include <cmath>

#include "output/chance.h"
#include "output/texture_tone.h"

namespace tranos::output {
namespace {

using geom::Vec3;

constexpr double kEyeHeight_m = 1.6;
constexpr double kBelowBuilding_m = 0.01;  // so that a floor at its foot is seen, not the ground
constexpr double kHorizon_m = 4000;
constexpr int kCells = 192;  // along each side

// Of a point in plan from the box; 0 within.
double DistanceFrom(const geom::Box& box, double x, double y) {
  const double dx = std::max({box.min.x() - x, x - box.max.x(), 0.0});
  const double dy = std::max({box.min.y() - y, y - box.max.y(), 0.0});
  return std::hypot(dx, dy);
}

double Smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

RayMesh TerrainOf(const geom::Box& building, const Vec3& camera, const Vec3& origin) {
  const double top_m = building.min.z() - kBelowBuilding_m;
  const double reach_m = 0.9 * DistanceFrom(building, camera.x(), camera.y());
  const double foot_m = reach_m > 0 ? std::min(top_m, camera.z() - kEyeHeight_m) : top_m;
  const Vec3 pattern = PatternOrigin(origin);
  const auto height = [&](double x, double y) {
    const double away = DistanceFrom(building, x, y);
    const double slope = foot_m < top_m ? Smooth((away - 1) / std::max(reach_m - 1, 1.0)) : 0;
    const double bump = 0.05 * Clouds2(11, static_cast<float>(0.3 * (x - pattern.x())),
                                       static_cast<float>(0.3 * (y - pattern.y())), 3);
    return top_m + slope * (foot_m - top_m) + Smooth((away - 0.5) / 2) * bump;
  };
  // Cells grow outward: dense where the building is.
  const double near_m = 1.5 * std::max({building.max.x() - building.min.x(),
                                        building.max.y() - building.min.y(), 10.0}) +
                        reach_m;
  const auto place = [&](int i) {
    const double t = 2.0 * i / kCells - 1;
    return near_m * t + (kHorizon_m - near_m) * std::pow(std::abs(t), 9) * (t < 0 ? -1 : 1);
  };
  RayMesh mesh;
  for (int k = 0; k <= kCells; ++k) {
    for (int i = 0; i <= kCells; ++i) {
      const double x = building.centre().x() + place(i), y = building.centre().y() + place(k);
      const double dx = height(x + 0.2, y) - height(x - 0.2, y);
      const double dy = height(x, y + 0.2) - height(x, y - 0.2);
      const Vec3 normal = Vec3(-dx / 0.4, -dy / 0.4, 1).normalized();
      const Eigen::Vector3f p = (Vec3(x, y, height(x, y)) - origin).cast<float>();
      mesh.positions.push_back({p.x(), p.y(), p.z()});
      mesh.normals.push_back({static_cast<float>(normal.x()), static_cast<float>(normal.y()),
                              static_cast<float>(normal.z())});
    }
  }
  const auto at = [](int i, int k) { return static_cast<std::uint32_t>(k * (kCells + 1) + i); };
  for (int k = 0; k < kCells; ++k) {
    for (int i = 0; i < kCells; ++i) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  return mesh;
}

}  // namespace tranos::output
