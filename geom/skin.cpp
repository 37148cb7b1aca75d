// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/skin.h"

#include <algorithm>
#include <cmath>

#include "geom/equal_positions.h"

namespace tranos::geom {
namespace {

class Skinner {
 public:
  Skinner(const Outline& outline, const Stations& stations)
      : outline_(outline),
        stations_(stations),
        count_(static_cast<std::uint32_t>(outline.points.size())) {}

  TriangleMesh Make() {
    for (const std::vector<Vec3>& station : stations_.points) {
      mesh_.positions.insert(mesh_.positions.end(), station.begin(), station.end());
    }
    const auto rows = static_cast<std::uint32_t>(stations_.points.size());
    for (std::uint32_t k = 0; k < stations_.runs.size(); ++k) AddSpan(k, (k + 1) % rows);
    if (!stations_.closed) AddCaps((rows - 1) * count_);
    return std::move(mesh_);
  }

 private:
  void AddCaps(std::uint32_t last) {
    const std::uint32_t sides = outline_.surface_count * stations_.run_count;
    for (const auto& [a, b, c] : outline_.triangles) AddTriangle({c, b, a}, sides);
    const bool same = stations_.last_triangles.empty();
    for (const auto& [a, b, c] : same ? outline_.triangles : stations_.last_triangles) {
      AddTriangle({last + a, last + b, last + c}, sides + 1);
    }
  }
  void AddSpan(std::uint32_t k, std::uint32_t next) {
    for (const Outline::Side& side : outline_.sides) {
      const std::uint32_t a = k * count_ + side.from, b = k * count_ + side.to,
                          c = next * count_ + side.to, d = next * count_ + side.from;
      const std::uint32_t surface = side.surface * stations_.run_count + stations_.runs[k];
      const auto& p = mesh_.positions;
      const bool along_ac = (p[a] - p[c]).squaredNorm() <= (p[b] - p[d]).squaredNorm();
      AddTriangle(along_ac ? std::array{a, b, c} : std::array{a, b, d}, surface);
      AddTriangle(along_ac ? std::array{a, c, d} : std::array{b, c, d}, surface);
    }
  }
  void AddTriangle(const std::array<std::uint32_t, 3>& corners, std::uint32_t surface) {
    mesh_.triangles.push_back(corners);
    mesh_.surfaces.push_back(surface);
  }

  const Outline& outline_;
  const Stations& stations_;
  std::uint32_t count_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh Welded(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> first = FirstOfEqual(mesh.positions);
  constexpr std::uint32_t kNone = 0xffffffff;
  std::vector<std::uint32_t> target(mesh.positions.size(), kNone);
  TriangleMesh result;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    std::array<std::uint32_t, 3> corners = {first[t[0]], first[t[1]], first[t[2]]};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    for (std::uint32_t& corner : corners) {
      if (target[corner] == kNone) {
        target[corner] = static_cast<std::uint32_t>(result.positions.size());
        result.positions.push_back(mesh.positions[corner]);
      }
      corner = target[corner];
    }
    result.triangles.push_back(corners);
    result.surfaces.push_back(mesh.surfaces[i]);
  }
  return result;
}

Result<TriangleMesh> FacingOutward(TriangleMesh mesh) {
  const double volume_m3 = Volume(mesh);
  const Box box = BoundingBox(mesh);
  const double reach_m = box.empty() ? 0 : (box.max - box.min).norm();
  if (!(std::abs(volume_m3) > 1e-15 * reach_m * reach_m * reach_m)) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "it encloses nothing"});
  }
  if (volume_m3 < 0) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

Result<TriangleMesh> SkinOf(const Outline& outline, const Stations& stations) {
  return FacingOutward(Welded(Skinner(outline, stations).Make()));
}

}  // namespace tranos::geom
