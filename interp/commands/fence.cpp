// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/commands/fence.h"

#include "interp/commands/firing.h"

namespace tranos::interp {

using geom::Vec2;
using geom::Vec3;
using model::Element;

namespace {

// Straight pieces that stand for an element, seen in the fence's plane.
struct Outline {
  std::vector<std::pair<Vec2, Vec2>> pieces;
};

class Outliner {
 public:
  Outliner(const geom::Frame& plane, const geom::Affine& world_from_leaf,
           const geom::Tolerance& tolerance, Outline* outline)
      : plane_(plane), world_from_leaf_(world_from_leaf), tolerance_(tolerance), out_(outline) {}

  void operator()(const model::Point& point) const { Add(point.position, point.position); }
  void operator()(const model::CurvePtr& curve) const {
    const auto points = geom::Tessellate(*curve, tolerance_);
    if (!points || points->empty()) return;
    AddRun(*points);
    if (geom::IsClosed(*curve)) Add(points->back(), points->front());
  }
  void operator()(const model::SurfacePtr& surface) const {
    if (const auto mesh = geom::Tessellate(*surface, tolerance_)) AddTriangles(*mesh);
  }
  void operator()(const model::SolidPtr& solid) const {
    if (const auto mesh = solid->Facets()) AddTriangles(**mesh);
  }
  void operator()(const model::RegionPtr& region) const {
    const auto facets = geom::Triangulate(*region, tolerance_);
    if (!facets) return;
    for (const auto& [a, b, c] : facets->triangles) {
      Add(facets->positions[a], facets->positions[b]);
      Add(facets->positions[b], facets->positions[c]);
      Add(facets->positions[c], facets->positions[a]);
    }
  }
  void operator()(const model::TextPtr& text) const {
    for (const std::vector<Vec3>& stroke : geom::Strokes(*text)) AddRun(stroke);
  }
  void operator()(const model::GroupPtr&) const {}     // no leaf
  void operator()(const model::InstancePtr&) const {}  // no leaf
  void operator()(const model::PhotographPtr&) const {}
  void operator()(const model::TracePtr&) const {}
  void operator()(const model::FacadePtr&) const {}
  void operator()(const model::OrthophotoPtr&) const {}

 private:
  Vec2 Seen(const Vec3& p) const { return plane_.ToLocal(world_from_leaf_ * p).head<2>(); }
  void Add(const Vec3& a, const Vec3& b) const { out_->pieces.emplace_back(Seen(a), Seen(b)); }
  template <class Mesh>
  void AddTriangles(const Mesh& mesh) const {
    for (const auto& [a, b, c] : mesh.triangles) {
      Add(mesh.positions[a], mesh.positions[b]);
      Add(mesh.positions[b], mesh.positions[c]);
      Add(mesh.positions[c], mesh.positions[a]);
    }
  }
  void AddRun(const std::vector<Vec3>& points) const {
    for (std::size_t i = 1; i < points.size(); ++i) Add(points[i - 1], points[i]);
  }

  const geom::Frame& plane_;
  const geom::Affine& world_from_leaf_;
  const geom::Tolerance& tolerance_;
  Outline* out_;
};

double Cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

bool Cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto sides_differ = [](const Vec2& p, const Vec2& q, const Vec2& r, const Vec2& s) {
    return (Cross(q - p, r - p) > 0) != (Cross(q - p, s - p) > 0);
  };
  return sides_differ(a, b, c, d) && sides_differ(c, d, a, b);
}

// By the parity of crossings of a ray along x.
bool Inside(const std::vector<Vec2>& outline, const Vec2& p) {
  bool inside = false;
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const Vec2 &a = outline[i], &b = outline[j];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y())) inside = !inside;
  }
  return inside;
}

bool CrossesOutline(const std::vector<Vec2>& outline, const Vec2& a, const Vec2& b) {
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    if (Cross(a, b, outline[j], outline[i])) return true;
  }
  return false;
}

}  // namespace

bool Fence::Takes(const Element& element, bool overlap) const {
  Outline seen;
  model::ForEachLeaf(element, [&](const Element& leaf, const geom::Affine& world_from_leaf,
                                  const model::Attributes&) {
    std::visit(Outliner(plane, world_from_leaf, leaf.tolerance, &seen), leaf.geometry);
  });
  for (const auto& [a, b] : seen.pieces) {
    const bool crosses = CrossesOutline(outline, a, b);
    if (overlap && (crosses || Inside(outline, a))) return true;
    if (!overlap && (crosses || !Inside(outline, a) || !Inside(outline, b))) return false;
  }
  return !overlap && !seen.pieces.empty();
}

tl::expected<Fence, CommandError> MakeFence(const std::vector<Vec3>& points,
                                            const geom::Frame& plane) {
  Fence fence{plane, {}};
  for (const Vec3& point : points) fence.outline.emplace_back(plane.ToLocal(point).head<2>());
  if (points.size() == 2) {
    const Vec2 a = fence.outline[0], b = fence.outline[1];
    fence.outline = {a, {b.x(), a.y()}, b, {a.x(), b.y()}};
  }
  double area = 0;
  for (std::size_t i = 0, j = fence.outline.size() - 1; i < fence.outline.size(); j = i++) {
    area += Cross(fence.outline[j] - fence.outline[0], fence.outline[i] - fence.outline[0]);
  }
  if (std::abs(area) > 1e-18) return fence;
  return Fail({.code = Code::kDegenerate,
               .message = "a fence that encloses nothing",
               .where = {Where::kPoint, static_cast<int>(points.size()) - 1, {}}});
}

}  // namespace tranos::interp
