// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/closed_surface.h"

#include <fmt/format.h>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "geom/mesh_edges.h"
#include "geom/outline.h"
#include "geom/skin.h"
#include "geom/stitch.h"

namespace tranos::geom {
namespace {

Vec3 DoubledNormal(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const Vec3& p = mesh.positions[t[0]];
  return (mesh.positions[t[1]] - p).cross(mesh.positions[t[2]] - p);
}

Mesh MeshOf(const Outline& outline) {
  Mesh mesh;
  mesh.positions = outline.points;
  mesh.normals.assign(mesh.positions.size(), outline.plane.z());
  mesh.triangles = outline.triangles;
  return mesh;
}

Result<std::vector<Mesh>> MeshesOf(const std::vector<Surface>& surfaces,
                                   const std::vector<Face>& faces, const Tolerance& tolerance) {
  std::vector<Mesh> meshes;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    Result<Mesh> mesh = Tessellate(surfaces[i], tolerance);
    if (!mesh) {
      return tl::unexpected(Error{mesh.error().code, mesh.error().detail, static_cast<int>(i)});
    }
    meshes.push_back(*std::move(mesh));
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Result<Outline> outline = OutlineOf(faces[i], tolerance);
    if (!outline) {
      return tl::unexpected(Error{outline.error().code, outline.error().detail,
                                  static_cast<int>(surfaces.size() + i)});
    }
    meshes.push_back(MeshOf(*outline));
  }
  return meshes;
}

// Facets of neighbours may each lie off the common border by the chord tolerance.
double StitchTolerance(const Tolerance& tolerance) { return 2 * tolerance.chord_m; }

// A point of a border that is left open; nothing if there is none.
std::optional<Vec3> OpenAt(const TriangleMesh& mesh) {
  const std::vector<HalfEdge> edges = SortedHalfEdges(mesh);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool before = i > 0 && edges[i].SameEdge(edges[i - 1]);
    const bool after = i + 1 < edges.size() && edges[i].SameEdge(edges[i + 1]);
    if (!before && !after) {
      return 0.5 * (mesh.positions[edges[i].low] + mesh.positions[edges[i].high]);
    }
  }
  return std::nullopt;
}

// The offset by which a corner moves so that every face at it moves by `distance_m` along its
// normal: the shortest such one.
Vec3 OffsetOf(const std::vector<Vec3>& normals, double distance_m) {
  if (normals.size() == 1) return distance_m * normals[0];
  Eigen::Matrix<double, Eigen::Dynamic, 3> rows(static_cast<Eigen::Index>(normals.size()), 3);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) = normals[i].transpose();
  }
  const Eigen::VectorXd distances =
      Eigen::VectorXd::Constant(static_cast<Eigen::Index>(normals.size()), distance_m);
  // What normals within a degree of one another disagree in is not worth a long way.
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(0.02);
  solver.compute(rows);
  return solver.solve(distances);
}

// Where a surface is singular (a dome's pole), the facets that meet there give the normal.
void CompleteNormals(Stitched* stitched) {
  const TriangleMesh& mesh = stitched->mesh;
  std::vector<Vec3> sums(mesh.positions.size(), Vec3::Zero());
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t corner : t) sums[corner] += DoubledNormal(mesh, t);
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (stitched->normals[i].empty()) stitched->normals[i].push_back(sums[i].normalized());
  }
}

// The sides of the surface: whether the way its triangles face is outward.
bool FacesOutward(const TriangleMesh& mesh) {
  const Vec3 middle = BoundingBox(mesh).centre();
  double outward = 0, size = 0;
  Vec3 sum = Vec3::Zero();
  for (const auto& t : mesh.triangles) {
    const Vec3 normal = DoubledNormal(mesh, t);
    const Vec3 from_middle = mesh.positions[t[0]] - middle;
    outward += normal.dot(from_middle);
    size += normal.norm() * from_middle.norm();
    sum += normal;
  }
  if (std::abs(outward) > 1e-9 * size) return outward > 0;
  Eigen::Index largest = 0;
  sum.cwiseAbs().maxCoeff(&largest);
  return sum[largest] > 0;
}

// Whether no triangle is turned over by moving its corners.
bool KeepsFacing(const TriangleMesh& mesh, const std::vector<Vec3>& moved) {
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& t) {
    const Vec3 normal = (moved[t[1]] - moved[t[0]]).cross(moved[t[2]] - moved[t[0]]);
    return normal.dot(DoubledNormal(mesh, t)) > 0;
  });
}

// Both layers of a thickened surface, and the strips between their borders.
TriangleMesh Layers(const TriangleMesh& mesh, const std::vector<Vec3>& outer,
                    const std::vector<Vec3>& inner) {
  TriangleMesh result;
  const auto count = static_cast<std::uint32_t>(outer.size());
  result.positions = outer;
  result.positions.insert(result.positions.end(), inner.begin(), inner.end());
  std::uint32_t surfaces = 0;
  for (const std::uint32_t surface : mesh.surfaces) surfaces = std::max(surfaces, surface + 1);
  const auto add = [&](const std::array<std::uint32_t, 3>& t, std::uint32_t surface) {
    result.triangles.push_back(t);
    result.surfaces.push_back(surface);
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    add({a, b, c}, mesh.surfaces[i]);
    add({count + c, count + b, count + a}, surfaces + mesh.surfaces[i]);
  }
  const std::vector<HalfEdge> edges = SortedHalfEdges(mesh);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool before = i > 0 && edges[i].SameEdge(edges[i - 1]);
    const bool after = i + 1 < edges.size() && edges[i].SameEdge(edges[i + 1]);
    if (before || after) continue;
    const std::uint32_t from = edges[i].rises ? edges[i].low : edges[i].high,
                        to = edges[i].rises ? edges[i].high : edges[i].low;
    // The facets of a strip are one surface; where the border has a corner they show a crease.
    add({from, count + from, count + to}, 2 * surfaces + mesh.surfaces[edges[i].triangle]);
    add({from, count + to, to}, 2 * surfaces + mesh.surfaces[edges[i].triangle]);
  }
  return result;
}

}  // namespace

Result<TriangleMesh> EnclosedMesh(const std::vector<Surface>& surfaces,
                                  const std::vector<Face>& faces, const Tolerance& tolerance) {
  const Result<std::vector<Mesh>> meshes = MeshesOf(surfaces, faces, tolerance);
  if (!meshes) return tl::unexpected(meshes.error());
  Stitched stitched = Stitch(*meshes, StitchTolerance(tolerance));
  if (const std::optional<Vec3> open = OpenAt(stitched.mesh)) {
    return tl::unexpected(Error{ErrorCode::kNotClosed,
                                fmt::format("they leave a border open at {:.4g}, {:.4g}, {:.4g} m",
                                            open->x(), open->y(), open->z())});
  }
  if (!IsClosed(stitched.mesh)) {
    return tl::unexpected(
        Error{ErrorCode::kNotClosed, "more than two of them meet along one border"});
  }
  return MayCross(FacingOutward(std::move(stitched.mesh)));
}

Result<TriangleMesh> ThickenedMesh(const std::vector<Surface>& surfaces,
                                   const std::vector<Face>& faces, double outward_m,
                                   double inward_m, const Tolerance& tolerance) {
  if (!(outward_m + inward_m > kCoincident_m)) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "the thickness is nothing"});
  }
  const Result<std::vector<Mesh>> meshes = MeshesOf(surfaces, faces, tolerance);
  if (!meshes) return tl::unexpected(meshes.error());
  Stitched stitched = Stitch(*meshes, StitchTolerance(tolerance));
  CompleteNormals(&stitched);
  const TriangleMesh& mesh = stitched.mesh;
  const double sign = FacesOutward(mesh) ? 1 : -1;
  std::vector<Vec3> front = mesh.positions, back = mesh.positions;
  for (std::size_t i = 0; i < front.size(); ++i) {
    front[i] += OffsetOf(stitched.normals[i], sign > 0 ? outward_m : inward_m);
    back[i] -= OffsetOf(stitched.normals[i], sign > 0 ? inward_m : outward_m);
  }
  if (!KeepsFacing(mesh, front) || !KeepsFacing(mesh, back)) {
    return tl::unexpected(
        Error{ErrorCode::kOutOfRange, "somewhere the surface bends more tightly than it is moved"});
  }
  return MayCross(FacingOutward(Layers(mesh, front, back)));
}

}  // namespace tranos::geom
