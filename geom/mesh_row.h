// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geom/triangle_mesh.h"

namespace tranos::geom {

// Meshes put side by side; the surfaces of each are others than those of the ones before.
class MeshRow {
 public:
  void Append(const TriangleMesh& mesh);
  TriangleMesh Take() { return std::move(row_); }

 private:
  TriangleMesh row_;
  std::uint32_t surfaces_ = 0;  // numbers that are taken
};

}  // namespace tranos::geom
