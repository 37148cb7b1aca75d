// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/solid.h"

#include <algorithm>

#include "geom/boolean.h"
#include "geom/solid_rounding.h"

namespace tranos::geom {

namespace {

using Node = Solid::Node;

Box BoxOf(Solid::Kind kind, const std::vector<Solid>& parts) {
  Box box = parts[0].Bounds();
  if (kind == Solid::Kind::kDifference) return box;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const Box part = parts[i].Bounds();
    if (kind == Solid::Kind::kUnion) {
      box.Add(part);
    } else {
      box.min = box.min.cwiseMax(part.min);
      box.max = box.max.cwiseMin(part.max);
    }
  }
  return (box.min.array() <= box.max.array()).all() ? box : Box{};
}

}  // namespace

Solid::Node::~Node() {
  std::vector<Solid> open = std::move(parts);
  while (!open.empty()) {
    Solid part = std::move(open.back());
    open.pop_back();
    // Only its last owner takes a node apart, and its parts wait their turn here.
    if (part.node_.use_count() != 1) continue;
    auto& below = const_cast<Node&>(*part.node_).parts;
    for (Solid& solid : below) open.push_back(std::move(solid));
    below.clear();
  }
}

Result<Solid> Solid::FromMesh(TriangleMesh mesh) {
  mesh = Tidied(std::move(mesh));
  if (!IsClosed(mesh)) {
    return tl::unexpected(Error{ErrorCode::kNotClosed, "the surface of the solid is open"});
  }
  if (!(Volume(mesh) > 0)) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "a solid that encloses nothing"});
  }
  auto node = std::make_shared<Node>();
  node->kind = Solid::Kind::kMesh;
  node->bounds = BoundingBox(mesh);
  node->mesh = std::move(mesh);
  return Solid(std::move(node));
}

Solid Solid::Combined(Kind kind, std::vector<Solid> parts) {
  if (parts.size() == 1) return std::move(parts[0]);
  auto node = std::make_shared<Node>();
  node->kind = kind;
  node->bounds = BoxOf(kind, parts);
  node->parts = std::move(parts);
  return Solid(std::move(node));
}

Solid Solid::Union(std::vector<Solid> parts) {
  return Combined(Solid::Kind::kUnion, std::move(parts));
}
Solid Solid::Intersection(std::vector<Solid> parts) {
  return Combined(Solid::Kind::kIntersection, std::move(parts));
}
Solid Solid::Difference(Solid of, std::vector<Solid> by) {
  by.insert(by.begin(), std::move(of));
  return Combined(Solid::Kind::kDifference, std::move(by));
}

Solid Solid::Transformed(const Affine& target_from_source) const {
  auto node = std::make_shared<Node>();
  node->kind = Solid::Kind::kTransformed;
  node->target_from_source = target_from_source;
  node->parts = {*this};
  node->bounds = Carried(node_->bounds, target_from_source);
  return Solid(std::move(node));
}

Result<std::shared_ptr<const TriangleMesh>> Solid::Facets() const {
  std::shared_ptr<const TriangleMesh> facets = node_->facets;
  if (!facets) {
    auto mesh = Evaluate(*this);
    if (!mesh) return tl::unexpected(mesh.error());
    facets = std::make_shared<const TriangleMesh>(std::move(*mesh));
    node_->facets = facets;
  }
  return facets;
}

Box Solid::Bounds() const {
  const std::shared_ptr<const TriangleMesh> facets = node_->facets;
  return facets ? BoundingBox(*facets) : node_->bounds;
}

}  // namespace tranos::geom
