// SPDX-License-Identifier: GPL-3.0-or-later
// From exact pieces to a mesh of doubles. Internal to geom.
#pragma once

#include <cstring>
#include <unordered_map>

#include "geom/plane_regions.h"
#include "geom/triangle_mesh.h"

namespace tranos::geom {

inline bool HasTwice(const std::array<std::uint32_t, 3>& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

// Numbers for positions; equal ones have one.
class PositionIndex {
 public:
  // The position's number in the list, where it is put if it is new.
  std::uint32_t Of(const Vec3& position, std::vector<Vec3>* list) {
    const Vec3 p = position.array() + 0.0;  // −0 is 0
    const auto [at, is_new] = numbers_.try_emplace(p, static_cast<std::uint32_t>(list->size()));
    if (is_new) list->push_back(p);
    return at->second;
  }

 private:
  struct Hash {
    std::size_t operator()(const Vec3& p) const {
      std::uint64_t h = 0;
      for (int k = 0; k < 3; ++k) {
        std::uint64_t bits;
        std::memcpy(&bits, &p[k], sizeof bits);
        h = (h ^ bits) * 0x9e3779b97f4a7c15u;
        h ^= h >> 32;
      }
      return h;
    }
  };
  std::unordered_map<Vec3, std::uint32_t, Hash> numbers_;
};

// The mesh of the pieces. Corners that become one point are merged, triangles that become lines
// taken out; where rounding has made facets cross, by less than a billionth of a metre, they are
// cut there. kDegenerate if that does not come to an end.
Result<TriangleMesh> Rounded(const Arrangement& arrangement,
                             const std::vector<SurfacePiece>& pieces);

// Adds the mesh's facets; its surfaces are others than those that are there.
void Append(const TriangleMesh& mesh, TriangleMesh* to);

}  // namespace tranos::geom
