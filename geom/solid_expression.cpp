// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/solid_expression.h"

#include <algorithm>
#include <functional>
#include <limits>

namespace tranos::geom {

namespace {

constexpr std::size_t kMostTriangles = 10'000'000;

Box Everywhere() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {Vec3::Constant(-kInfinity), Vec3::Constant(kInfinity)};
}
// By more than a rounding error.
Box Widened(const Box& box) {
  const double hair = 1e-9 * (1 + box.min.cwiseAbs().maxCoeff() + box.max.cwiseAbs().maxCoeff());
  return {box.min.array() - hair, box.max.array() + hair};
}
Box Common(const Box& a, const Box& b) { return {a.min.cwiseMax(b.min), a.max.cwiseMin(b.max)}; }

std::shared_ptr<const TriangleMesh> Carried(const Solid::Node& node, const Affine* into_solid) {
  if (!into_solid) {
    // The node outlives the expression: the solid that is evaluated holds it.
    return {std::shared_ptr<void>(), &node.mesh};
  }
  return std::make_shared<const TriangleMesh>(Transformed(node.mesh, *into_solid));
}

}  // namespace

// The tree is walked with a stack of our own: it may be a hundred thousand steps deep.
struct SolidExpression::Layout {
  struct Visit {
    const Solid::Node* node;
    std::shared_ptr<const Affine> into_solid;  // null where it is the identity
    Place place;
  };
  std::vector<Visit> open;
  std::vector<Step> steps;  // numbered from the root down; turned round at the end

  // Parts that are the same kind of step as what they are parts of are merged into it:
  // (a ∪ b) ∪ c is a ∪ b ∪ c, and (a − b) − c is a − b − c.
  void Expand(const Visit& visit) {
    const Solid::Node& node = *visit.node;
    const bool below = visit.place.parent != kNone;
    const Kind above = below ? steps[visit.place.parent].kind : node.kind;
    const bool merges =
        below && above == node.kind && (node.kind != Kind::kDifference || visit.place.is_first);
    // What is cut off a difference may as well be cut off piece by piece.
    const bool cuts =
        below && above == Kind::kDifference && !visit.place.is_first && node.kind == Kind::kUnion;
    std::uint32_t step = visit.place.parent;
    if (merges || cuts) {
      --steps[step].parts;
    } else {
      step = static_cast<std::uint32_t>(steps.size());
      steps.push_back({node.kind, 0, visit.place.parent, visit.place.is_first});
    }
    steps[step].parts += static_cast<std::uint32_t>(node.parts.size());
    const auto box_of = [&](const Solid& part) {
      const Box box = part.node().bounds;
      return Widened(visit.into_solid ? Carried(box, *visit.into_solid) : box);
    };
    Box common = visit.place.relevant;
    if (node.kind == Kind::kIntersection) {
      for (const Solid& part : node.parts) common = Common(common, box_of(part));
    }
    for (std::size_t i = node.parts.size(); i-- > 0;) {
      const bool is_cut_off = node.kind == Kind::kDifference && i > 0;
      const Box relevant = is_cut_off ? Common(common, box_of(node.parts[0])) : common;
      open.push_back({&node.parts[i].node(), visit.into_solid, {step, i == 0 && !cuts, relevant}});
    }
  }
};

Result<SolidExpression> SolidExpression::Of(const Solid& solid) {
  SolidExpression expression;
  Layout layout;
  std::size_t triangles = 0;
  layout.open.push_back({&solid.node(), nullptr, {kNone, false, Everywhere()}});
  while (!layout.open.empty()) {
    const Layout::Visit visit = std::move(layout.open.back());
    layout.open.pop_back();
    const Solid::Node& node = *visit.node;
    if (node.kind == Kind::kMesh) {
      triangles += node.mesh.triangles.size();
      if (triangles > kMostTriangles) {
        return tl::unexpected(
            Error{ErrorCode::kTooLarge, "the solid is made from more than ten million facets"});
      }
      expression.leaves_.push_back(Carried(node, visit.into_solid.get()));
      expression.leaf_places_.push_back(visit.place);
    } else if (node.kind == Kind::kTransformed) {
      auto into_solid = std::make_shared<const Affine>(
          visit.into_solid ? *visit.into_solid * node.target_from_source : node.target_from_source);
      layout.open.push_back({&node.parts[0].node(), std::move(into_solid), visit.place});
    } else {
      layout.Expand(visit);
    }
  }
  // So that a part has a lower number than what it is a part of.
  const auto count = static_cast<std::uint32_t>(layout.steps.size());
  const auto turned = [&](std::uint32_t step) { return step == kNone ? kNone : count - 1 - step; };
  std::reverse(layout.steps.begin(), layout.steps.end());
  for (Step& step : layout.steps) step.parent = turned(step.parent);
  for (Place& place : expression.leaf_places_) place.parent = turned(place.parent);
  expression.steps_ = std::move(layout.steps);
  return expression;
}

bool SolidExpression::IsInside(const Step& step) const {
  switch (step.kind) {
    case Kind::kUnion:
      return step.parts_inside > 0;
    case Kind::kIntersection:
      return step.parts_inside == step.parts;
    default:
      return step.first_inside && step.parts_inside == 1;
  }
}

void SolidExpression::Tell(std::uint32_t number, bool is_first, std::vector<std::uint32_t>* open) {
  Step& step = steps_[number];
  if (step.parts_inside == 0) {
    open->push_back(number);
    std::push_heap(open->begin(), open->end(), std::greater<>());
  }
  ++step.parts_inside;
  step.first_inside |= is_first;
}

bool SolidExpression::Contains(const std::vector<std::uint32_t>& inside_leaves) {
  if (inside_leaves.empty()) return false;
  if (steps_.empty()) return true;
  // Steps with a part inside, the lowest number first: all its parts have told it by then.
  std::vector<std::uint32_t> open;
  for (const std::uint32_t leaf : inside_leaves) {
    Tell(leaf_places_[leaf].parent, leaf_places_[leaf].is_first, &open);
  }
  while (!open.empty()) {
    std::pop_heap(open.begin(), open.end(), std::greater<>());
    Step& step = steps_[open.back()];
    open.pop_back();
    const bool inside = IsInside(step);
    step.parts_inside = 0;
    step.first_inside = false;
    if (step.parent == kNone) return inside;
    if (inside) Tell(step.parent, step.is_first, &open);
  }
  return false;
}

}  // namespace tranos::geom
