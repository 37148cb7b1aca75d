// SPDX-License-Identifier: GPL-3.0-or-later
// Where facets meet. Internal to the files that are exact.
#pragma once

#include <algorithm>

#include "geom/box_tree.h"
#include "geom/exact_corners.h"
#include "geom/union_find.h"

namespace tranos::geom {

inline std::vector<Box> BoxesOf(const Soup& soup) {
  std::vector<Box> boxes(soup.facets.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (const std::uint32_t corner : soup.facets[i].corners) boxes[i].Add(soup.positions[corner]);
  }
  return boxes;
}

// Pairs of facets whose boxes meet, of different meshes unless `within_meshes`.
template <class Visit>
void ForEachNearPair(const Soup& soup, bool within_meshes, Visit&& visit) {
  const std::vector<Box> boxes = BoxesOf(soup);
  std::vector<Box> mesh_boxes;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    const std::uint32_t mesh = soup.facets[i].mesh;
    if (soup.facets[i].is_idle) continue;
    if (mesh >= mesh_boxes.size()) mesh_boxes.resize(mesh + 1);
    mesh_boxes[mesh].Add(boxes[i]);
  }
  // Only facets that reach into another mesh's box can meet it.
  const BoxTree meshes(mesh_boxes);
  std::vector<std::uint32_t> near;
  std::vector<Box> near_boxes;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    bool is_near = within_meshes;
    if (soup.facets[i].is_idle) continue;
    if (!is_near) {
      meshes.ForEachMeeting(boxes[i],
                            [&](std::uint32_t mesh) { is_near |= mesh != soup.facets[i].mesh; });
    }
    if (!is_near) continue;
    near.push_back(i);
    near_boxes.push_back(boxes[i]);
  }
  const BoxTree tree(near_boxes);
  for (std::uint32_t k = 0; k < near.size(); ++k) {
    std::vector<std::uint32_t> others;
    tree.ForEachMeeting(near_boxes[k], [&](std::uint32_t other) {
      if (other <= k) return;
      if (within_meshes || soup.facets[near[k]].mesh != soup.facets[near[other]].mesh) {
        others.push_back(near[other]);
      }
    });
    std::sort(others.begin(), others.end());
    for (const std::uint32_t other : others) {
      visit(near[k], other);
    }
  }
}

// What two facets have in common where they cross: a point, or a segment of a line.
struct FacetCrossing {
  std::uint32_t facet, from, to;
};

// Finds where pairs of facets meet.
class CrossingFinder {
 public:
  // Facets with one number in `planes` lie in one plane.
  CrossingFinder(const Soup& soup, const UnionFind& planes, CornerTable* corners)
      : soup_(soup), planes_(planes), corners_(*corners) {}

  enum class Meeting { kApart, kInPlane, kCross };
  // Whether the facets meet other than in common corners and edges; of kCross, where.
  Meeting Meet(std::uint32_t s, std::uint32_t t, std::uint32_t* from, std::uint32_t* to);

 private:
  struct Side {
    std::uint32_t facet;
    std::array<int, 3> sides;  // of its corners, against the other's plane
  };
  std::vector<std::uint32_t> Ends(const Side& of, std::uint32_t plane);
  std::uint32_t EdgeAtPlane(std::uint32_t a, std::uint32_t b, std::uint32_t plane);
  bool Cross(const Side& s, const Side& t, std::uint32_t* from, std::uint32_t* to);
  bool Before(std::uint32_t a, std::uint32_t b, const Vec3& along) const;

  using Key = std::array<std::uint32_t, 3>;
  struct KeyHash {
    std::size_t operator()(const Key& k) const {
      std::uint64_t h = k[0];
      h = (h ^ (h >> 31) ^ (std::uint64_t{k[1]} << 32)) * 0x9e3779b97f4a7c15u;
      h = (h ^ (h >> 29) ^ k[2]) * 0xbf58476d1ce4e5b9u;
      return h ^ (h >> 32);
    }
  };
  const Soup& soup_;
  const UnionFind& planes_;
  CornerTable& corners_;
  std::unordered_map<Key, std::uint32_t, KeyHash> at_planes_;
};

}  // namespace tranos::geom
