// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/facets.h"

#include <utility>

namespace tranos::output {
namespace {

using geom::Vec3;

// A surface has no normal where it is singular (the pole of a dome, say): there the facets that
// meet in the vertex give one.
void CompleteNormals(geom::Mesh& mesh) {
  std::vector<Vec3> sums;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    if (mesh.normals[i].squaredNorm() > 0.5) continue;
    if (sums.empty()) {
      sums.assign(mesh.positions.size(), Vec3::Zero());
      for (const auto& t : mesh.triangles) {
        const Vec3& p = mesh.positions[t[0]];
        const Vec3 n = (mesh.positions[t[1]] - p).cross(mesh.positions[t[2]] - p);
        for (const std::uint32_t corner : t) sums[corner] += n;
      }
    }
    mesh.normals[i] = sums[i];
  }
  for (Vec3& n : mesh.normals) {
    const double length = n.norm();
    n = length > 0 ? Vec3(n / length) : Vec3::UnitZ();
  }
}

bool HasThreeCorners(const std::array<std::uint32_t, 3>& t) {
  return t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
}

struct FacetMaker {
  const geom::Tolerance& tolerance;

  geom::Result<Facets> operator()(const model::Point& point) const {
    Facets facets;
    facets.points.push_back(point.position);
    return facets;
  }
  geom::Result<Facets> operator()(const model::CurvePtr& curve) const {
    auto vertices = geom::Tessellate(*curve, tolerance);
    if (!vertices) return tl::unexpected(vertices.error());
    if (geom::IsClosed(*curve) && !vertices->empty()) vertices->push_back(vertices->front());
    Facets facets;
    facets.strokes.push_back(*std::move(vertices));
    return facets;
  }
  geom::Result<Facets> operator()(const model::SurfacePtr& surface) const {
    auto mesh = geom::Tessellate(*surface, tolerance);
    if (!mesh) return tl::unexpected(mesh.error());
    std::erase_if(mesh->triangles, [](const auto& t) { return !HasThreeCorners(t); });
    CompleteNormals(*mesh);
    Facets facets;
    facets.mesh = *std::move(mesh);
    return facets;
  }
  geom::Result<Facets> operator()(const model::SolidPtr& solid) const {
    const auto mesh = solid->Facets();
    if (!mesh) return tl::unexpected(mesh.error());
    Facets facets;
    facets.mesh = geom::FacetsOf(**mesh);
    return facets;
  }
  geom::Result<Facets> operator()(const model::RegionPtr& region) const {
    auto flat = geom::Triangulate(*region, tolerance);
    if (!flat) return tl::unexpected(flat.error());
    Facets facets;
    facets.mesh.normals.assign(flat->positions.size(), region->plane.z());
    facets.mesh.positions = std::move(flat->positions);
    facets.mesh.triangles = std::move(flat->triangles);
    for (const auto& loop : flat->loops) {
      for (std::uint32_t i = loop.begin; i < loop.end; ++i) {
        facets.mesh.edges.push_back({i, i + 1 < loop.end ? i + 1 : loop.begin});
      }
    }
    return facets;
  }
  geom::Result<Facets> operator()(const model::TextPtr& text) const {
    Facets facets;
    facets.strokes = geom::Strokes(*text);
    return facets;
  }
  geom::Result<Facets> operator()(const model::GroupPtr&) const { return Facets{}; }
  geom::Result<Facets> operator()(const model::InstancePtr&) const { return Facets{}; }
  geom::Result<Facets> operator()(const model::PhotographPtr&) const { return Facets{}; }
  geom::Result<Facets> operator()(const model::TracePtr&) const { return Facets{}; }
  geom::Result<Facets> operator()(const model::FacadePtr&) const { return Facets{}; }
  geom::Result<Facets> operator()(const model::OrthophotoPtr&) const { return Facets{}; }
};

}  // namespace

Result<Facets> FacetsOf(const model::Element& leaf, const geom::Tolerance& tolerance) {
  geom::Result<Facets> facets = std::visit(FacetMaker{tolerance}, leaf.geometry);
  if (!facets) {
    return tl::unexpected(Error{
        "a " + model::TypeOf(leaf) + " cannot be turned into facets: " + facets.error().detail,
        leaf.id});
  }
  std::erase_if(facets->strokes, [](const auto& stroke) { return stroke.size() < 2; });
  return *std::move(facets);
}

}  // namespace tranos::output
