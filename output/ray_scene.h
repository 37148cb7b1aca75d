// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "geom/primitives.h"
#include "output/result.h"

namespace tranos::output {

// Triangles in single precision, near their own origin.
struct RayMesh {
  std::vector<std::array<float, 3>> positions, normals;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};
// A mesh put into picture space (output/view.h). Many surfaces may show the same mesh.
struct RaySurface {
  std::shared_ptr<const RayMesh> mesh;
  Eigen::Matrix<float, 3, 4> picture_from_mesh;
};

inline constexpr int kPacket = 16;  // rays traced at once

// Where rays start.
struct RayPacket {
  alignas(64) std::array<float, kPacket> x{}, y{}, z{};
};
using LanePacket = std::array<bool, kPacket>;
// What they meet first: the surface's index (kNothing: none), the triangle's, the weights u and v
// of its second and third corner, and the depth.
inline constexpr std::uint32_t kNothing = 0xffffffff;
struct HitPacket {
  alignas(64) std::array<std::uint32_t, kPacket> surface, triangle;
  alignas(64) std::array<float, kPacket> u, v, z;
};

// Surfaces to be asked by rays. Where two are met at the same depth the one with the lower index
// counts, and the tree is built in one thread: the answers do not depend on any number of threads.
class RayScene {
 public:
  // An error if the ray tracer finds no memory.
  static Result<RayScene> Of(const std::vector<RaySurface>& surfaces);

  // What rays along −z meet.
  HitPacket FirstHits(const RayPacket& rays) const;
  // What rays from one point meet, in these directions of unit length; z is the distance.
  HitPacket FirstHitsFrom(const Eigen::Vector3f& point, const RayPacket& directions) const;
  // Takes those out of `lanes` whose ray, each in its own direction, meets anything.
  void DropOccluded(const RayPacket& rays, const RayPacket& directions, LanePacket& lanes) const;
  // Whether anything lies beyond `origin` in this direction.
  bool Occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const;

 private:
  struct Trees;
  HitPacket Meet(const RayPacket& rays, const RayPacket& directions) const;
  explicit RayScene(std::shared_ptr<const Trees> trees) : trees_(std::move(trees)) {}
  std::shared_ptr<const Trees> trees_;
};

}  // namespace tranos::output
