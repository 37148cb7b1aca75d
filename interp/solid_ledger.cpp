// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/solid_ledger.h"

#include <string>

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
      made_.try_emplace(&(*solid)->node(), Made{*solid, statement});
    }
  }
}

void SolidLedger::Force(const model::Element& element, Span fallback) const {
  model::ForEachLeaf(
      element, [&](const model::Element& leaf, const geom::Affine&, const model::Attributes&) {
        const auto* solid = std::get_if<model::SolidPtr>(&leaf.geometry);
        if (!solid) return;
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
