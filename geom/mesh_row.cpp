// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/mesh_row.h"

#include <algorithm>

namespace tranos::geom {

void MeshRow::Append(const TriangleMesh& mesh) {
  row_.may_cross |= mesh.may_cross;
  const auto first = static_cast<std::uint32_t>(row_.positions.size());
  row_.positions.insert(row_.positions.end(), mesh.positions.begin(), mesh.positions.end());
  for (const auto& t : mesh.triangles) {
    row_.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  std::uint32_t taken = surfaces_;
  for (const std::uint32_t s : mesh.surfaces) {
    row_.surfaces.push_back(s + surfaces_);
    taken = std::max(taken, s + surfaces_ + 1);
  }
  surfaces_ = taken;
}

}  // namespace tranos::geom
