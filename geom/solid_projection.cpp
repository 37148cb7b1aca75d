// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "geom/skin.h"
#include "geom/swept_solid.h"

namespace tranos::geom {

Result<TriangleMesh> ProjectionMesh(const std::vector<Curve>& outline, const Vec3& vector,
                                    const Tolerance& tolerance) {
  const Result<Outline> face = OutlineOf(outline, tolerance);
  if (!face) return tl::unexpected(face.error());
  const double height_m = vector.dot(face->plane.z());
  if (!(std::abs(height_m) > std::max(kCoincident_m, 1e-9 * vector.norm()))) {
    return tl::unexpected(
        Error{ErrorCode::kDegenerate, "the projection runs within the outline's plane"});
  }
  Stations stations;
  stations.points = {face->points, face->points};
  for (Vec3& point : stations.points[1]) point += vector;
  stations.runs = {0};
  return SkinOf(*face, stations);
}

}  // namespace tranos::geom
