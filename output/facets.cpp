// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/facets.h"

#include <utility>

#include "model/faces.h"

namespace tranos::output {
namespace {

geom::Result<Facets> Made(const model::Element& leaf, const geom::Tolerance& tolerance) {
  Facets facets;
  if (model::HasFaces(leaf)) {
    auto mesh = model::FacesOf(leaf, tolerance);
    if (!mesh) return tl::unexpected(mesh.error());
    facets.mesh = *std::move(mesh);
  } else if (const auto* point = std::get_if<model::Point>(&leaf.geometry)) {
    facets.points.push_back(point->position);
  } else if (const auto* curve = std::get_if<model::CurvePtr>(&leaf.geometry)) {
    auto vertices = geom::Tessellate(**curve, tolerance);
    if (!vertices) return tl::unexpected(vertices.error());
    if (geom::IsClosed(**curve) && !vertices->empty()) vertices->push_back(vertices->front());
    facets.strokes.push_back(*std::move(vertices));
  } else if (const auto* text = std::get_if<model::TextPtr>(&leaf.geometry)) {
    facets.strokes = geom::Strokes(**text);
  }
  return facets;
}

}  // namespace

Result<Facets> FacetsOf(const model::Element& leaf, const geom::Tolerance& tolerance) {
  geom::Result<Facets> facets = Made(leaf, tolerance);
  if (!facets) {
    return tl::unexpected(Error{
        "a " + model::TypeOf(leaf) + " cannot be turned into facets: " + facets.error().detail,
        leaf.id});
  }
  std::erase_if(facets->strokes, [](const auto& stroke) { return stroke.size() < 2; });
  return *std::move(facets);
}

}  // namespace tranos::output
