// SPDX-License-Identifier: GPL-3.0-or-later
// From exact pieces to a mesh of doubles. Internal to geom.
#pragma once

#include <unordered_map>

#include "geom/plane_regions.h"
#include "geom/triangle_mesh.h"

namespace tranos::geom {

inline bool HasTwice(const std::array<std::uint32_t, 3>& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

// Numbers for positions; those nearer than the reach to one that is there have its number.
class PositionIndex {
 public:
  explicit PositionIndex(double reach_m = kCoincident_m) : reach_m_(reach_m) {}
  // The position's number in the list, where it is put if it is new.
  std::uint32_t Of(const Vec3& position, std::vector<Vec3>* list);

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& cell) const {
      std::uint64_t h = 0;
      for (const std::int64_t i : cell) {
        h = (h ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15u;
        h ^= h >> 32;
      }
      return h;
    }
  };
  double reach_m_;
  std::unordered_multimap<Cell, std::uint32_t, Hash> numbers_;
};

// The same surface with corners nearer to one another than the reach merged.
TriangleMesh Merged(TriangleMesh mesh, double reach_m);

// The same surface without what is too narrow to have two sides: corners nearer to one another than
// kCoincident_m are merged, triangles narrower than that taken out. A closed one stays closed.
TriangleMesh Tidied(TriangleMesh mesh);

// The mesh of the pieces. Corners that become one point are merged, triangles that become lines
// taken out; where rounding has made facets cross, by less than a billionth of a metre, they are
// cut there. kDegenerate if that does not come to an end.
Result<TriangleMesh> Rounded(const Arrangement& arrangement,
                             const std::vector<SurfacePiece>& pieces);

// The surface of what a mesh encloses that crosses itself: once or more often, and what it encloses
// turned inside out, too.
Result<TriangleMesh> Uncrossed(const TriangleMesh& mesh);

}  // namespace tranos::geom
