// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles cut along one another, exactly: where two of them cross or lie in one another, they are
// cut, so that the pieces meet in common corners and edges only (Q. Zhou, E. Grinspun, D. Zorin,
// A. Jacobson: Mesh Arrangements for Solid Geometry, 2016). Internal to geom.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geom/primitives.h"

namespace tranos::geom {

// A triangle of one of the meshes.
struct SoupFacet {
  std::array<std::uint32_t, 3> corners;
  std::uint32_t mesh;
  bool is_idle = false;  // neither cut nor kept; it only tells inside from outside
};
// Meshes in one list; no two positions are equal.
struct Soup {
  std::vector<Vec3> positions;
  std::vector<SoupFacet> facets;
};

// That a piece is a part of the facet, and whether it is turned round against it.
struct PieceLabel {
  std::uint32_t facet;
  bool opposite;
};
struct Piece {
  std::array<std::uint32_t, 3> corners;
  std::uint32_t first_label, label_count;  // for Arrangement::LabelsOf
};

class Arrangement {
 public:
  // `within_meshes`: facets of one mesh may cross, too.
  Arrangement(Soup soup, bool within_meshes);
  ~Arrangement();
  Arrangement(const Arrangement&) = delete;
  Arrangement& operator=(const Arrangement&) = delete;

  const Soup& soup() const;
  const std::vector<Piece>& pieces() const;
  std::span<const PieceLabel> LabelsOf(const Piece& piece) const;
  // Corners: those of the soup, and those that were made where facets meet.
  std::uint32_t corner_count() const;
  // To the nearest doubles, but for the last bit.
  Vec3 Rounded(std::uint32_t corner) const;
  bool IsRounded(std::uint32_t corner) const;  // the doubles are not the place itself
  // Facets found to lie in one plane, because they share an edge or overlap, have one number.
  std::uint32_t PlaneOf(std::uint32_t facet) const;

  // How often the mesh encloses the middle of the piece; of a mesh that the piece itself is a part
  // of, the place just in front of it. kDegenerate if no ray could tell, which no input is known
  // for.
  Result<int> Winding(const Piece& piece, std::uint32_t mesh) const;

  // An edge of a plane region: what lies on its two sides is the region and something else, or,
  // `within`, the region both times. From a corner to itself: a corner inside the region.
  struct RegionEdge {
    std::uint32_t from, to;
    bool within;
  };
  // The region of the facet's plane that the edges bound, as triangles that look as the facet does.
  std::vector<std::array<std::uint32_t, 3>> Triangulated(
      std::uint32_t facet, const std::vector<RegionEdge>& edges) const;

 private:
  struct Exact;
  std::unique_ptr<Exact> exact_;
};

// Whether two triangles of the soup, one of them suspect (where nothing is said of that: any two),
// meet anywhere but in common corners and edges; exact.
bool HasCrossing(const Soup& soup, const std::vector<bool>& is_suspect = {});

// Whether a corner lies nearer than kCoincident_m to a triangle, but not in it.
bool HasNearMiss(const Soup& soup);

}  // namespace tranos::geom
