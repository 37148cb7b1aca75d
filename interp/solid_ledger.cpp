// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/solid_ledger.h"

#include <string>
#include <vector>

#include "interp/failure.h"
#include "interp/geometry_error.h"

namespace tranos::interp {

namespace {

using Kind = geom::Solid::Kind;

// The solid under what has only moved it.
const geom::Solid& Unmoved(const geom::Solid& solid) {
  const geom::Solid* base = &solid;
  while (base->node().kind == Kind::kTransformed) base = &base->node().parts[0];
  return *base;
}

// Of the meshes that the solid begins with, each as often as it occurs; what is beyond counting is
// beyond every limit.
std::uint64_t FacetCount(const geom::Solid& solid) {
  constexpr std::uint64_t kMost = 1'000'000'000'000;
  constexpr std::size_t kMostNodes = 10'000'000;
  std::uint64_t facets = 0;
  std::size_t nodes = 0;
  std::vector<const geom::Solid*> open{&solid};
  while (!open.empty()) {
    const geom::Solid::Node& node = open.back()->node();
    open.pop_back();
    facets += node.mesh.triangles.size();
    if (facets > kMost || ++nodes > kMostNodes) return kMost;
    for (const geom::Solid& part : node.parts) open.push_back(&part);
  }
  return facets;
}

Diagnostic EmptySolid(const geom::Solid& solid, Span span) {
  switch (Unmoved(solid).node().kind) {
    case Kind::kIntersection:
      return {Code::kEmptySolid, span, "these solids have nothing in common",
              "their intersection is empty", ""};
    case Kind::kDifference:
      return {Code::kEmptySolid, span, "the difference leaves nothing",
              "what is cut by covers all of what is cut", ""};
    default:
      return {Code::kEmptySolid, span, "the solid is empty", "", ""};
  }
}

}  // namespace

void SolidLedger::Note(const std::vector<model::ElementPtr>& elements, Span statement) {
  for (const model::ElementPtr& element : elements) {
    if (const auto* group = std::get_if<model::GroupPtr>(&element->geometry)) {
      Note((*group)->members, statement);
    } else if (const auto* instance = std::get_if<model::InstancePtr>(&element->geometry)) {
      // Those that a definition's body made are known; a wall's is made where it is placed.
      Note((*instance)->prototype->parts, statement);
    } else if (const auto* solid = std::get_if<model::SolidPtr>(&element->geometry)) {
      const geom::Solid::Node& node = (*solid)->node();
      const bool is_new = made_.try_emplace(&node, Made{*solid, statement}).second;
      if (is_new && node.kind == Kind::kMesh) charge_(node.mesh.triangles.size(), statement);
    }
  }
}

void SolidLedger::Force(const model::Element& element, Span fallback) const {
  model::ForEachLeaf(
      element, [&](const model::Element& leaf, const geom::Affine&, const model::Attributes&) {
        const auto* solid = std::get_if<model::SolidPtr>(&leaf.geometry);
        if (!solid) return;
        if (!(*solid)->node().facets.load()) charge_(FacetCount(**solid), fallback);
        const auto facets = (*solid)->Facets();
        if (facets && !(*facets)->triangles.empty()) return;
        auto found = made_.find(&Unmoved(**solid).node());
        if (found == made_.end()) found = made_.find(&(*solid)->node());
        const Span span = found == made_.end() ? fallback : found->second.statement;
        if (facets) throw RunFailure{EmptySolid(**solid, span)};
        throw RunFailure{{CodeOf(facets.error().code), span,
                          "this solid cannot be evaluated: " + facets.error().detail, "", ""}};
      });
}

}  // namespace tranos::interp
