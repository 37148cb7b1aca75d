// SPDX-License-Identifier: GPL-3.0-or-later
// Solids as values: closed meshes, and unions, differences and intersections of them that are
// evaluated when their facets are asked for, all at once and exactly: every corner of a result is
// computed from the facets of the meshes it began with, and rounded once.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "geom/triangle_mesh.h"

namespace tranos::geom {

class Solid {
 public:
  enum class Kind : std::uint8_t { kMesh, kTransformed, kUnion, kIntersection, kDifference };

  // A solid with this surface, which is closed and looks outward; kNotClosed if it is not,
  // kDegenerate if it encloses nothing.
  static Result<Solid> FromMesh(TriangleMesh mesh);
  // Of any number of solids, at least one; the first one alone is that one.
  static Solid Union(std::vector<Solid> parts);
  static Solid Intersection(std::vector<Solid> parts);
  static Solid Difference(Solid of, std::vector<Solid> by);

  // A reflection keeps the inside inside.
  Solid Transformed(const Affine& target_from_source) const;

  // The facets of its surface, evaluated at the first call and kept; no triangles for an empty
  // solid. kTooLarge above ten million triangles.
  Result<std::shared_ptr<const TriangleMesh>> Facets() const;
  // m³; what it encloses twice, crossing itself, counts once. Kept, too.
  Result<double> FilledVolume() const;
  // Around everything it could fill, without evaluating it.
  Box Bounds() const;

  // What it is made of.
  struct Node;
  const Node& node() const { return *node_; }

 private:
  explicit Solid(std::shared_ptr<const Node> node) : node_(std::move(node)) {}
  static Solid Combined(Kind kind, std::vector<Solid> parts);
  std::shared_ptr<const Node> node_;
};

struct PlacedSolid {
  Solid solid;
  Affine world_from_solid;
};
// m³ that solids fill together: what lies in several counts once. Those whose boxes only touch are
// not looked at further.
Result<double> FilledVolume(const std::vector<PlacedSolid>& solids);

struct Solid::Node {
  Kind kind;
  std::vector<Solid> parts = {};  // of a difference the first is what the others are cut from
  TriangleMesh mesh = {};         // of kMesh
  Affine target_from_source = Affine::Identity();  // of kTransformed
  Box bounds = {};
  // For whoever hashes contents: kept here, so that a solid of a hundred thousand steps is hashed
  // in as many. Both zero until then.
  mutable std::array<std::uint64_t, 2> content_hash = {};
  // Once evaluated. Solids share their parts, and several threads may ask for the same one's.
  mutable std::atomic<std::shared_ptr<const TriangleMesh>> facets = nullptr;
  mutable std::atomic<double> filled_m3 = -1;  // below zero until it is known
  ~Node();                                     // takes deep trees apart without recursion
};

}  // namespace tranos::geom
