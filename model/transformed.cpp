// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/element.h"

namespace tranos::model {

namespace {

struct TransformedGeometry {
  const geom::Affine& target_from_source;

  Geometry operator()(const Point& point) const {
    return Point{target_from_source * point.position};
  }
  Geometry operator()(const CurvePtr& curve) const {
    return std::make_shared<const geom::Curve>(geom::Transformed(*curve, target_from_source));
  }
  Geometry operator()(const SurfacePtr& surface) const {
    return std::make_shared<const geom::Surface>(geom::Transformed(*surface, target_from_source));
  }
  Geometry operator()(const SolidPtr& solid) const {
    return std::make_shared<const geom::Solid>(solid->Transformed(target_from_source));
  }
  Geometry operator()(const RegionPtr& region) const {
    return std::make_shared<const geom::Region>(geom::Transformed(*region, target_from_source));
  }
  Geometry operator()(const TextPtr& text) const {
    return std::make_shared<const geom::Text>(geom::Transformed(*text, target_from_source));
  }
  Geometry operator()(const GroupPtr& group) const {
    return MapMembers(
        *group, [&](const ElementPtr& member) { return Transformed(*member, target_from_source); });
  }
  Geometry operator()(const InstancePtr& instance) const {
    return std::make_shared<const Instance>(
        Instance{instance->prototype, target_from_source * instance->world_from_prototype});
  }
  // What is on a picture stays there.
  Geometry operator()(const PhotographPtr& photograph) const { return photograph; }
  Geometry operator()(const TracePtr& trace) const { return trace; }
  Geometry operator()(const FacadePtr& facade) const { return facade; }
  Geometry operator()(const OrthophotoPtr& made) const { return made; }
};

}  // namespace

ElementPtr Transformed(const Element& element, const geom::Affine& target_from_source) {
  const auto transformed = [&](const Geometry& geometry) {
    return std::visit(TransformedGeometry{target_from_source}, geometry);
  };
  const ElementPtr target = WithGeometry(element, transformed(element.geometry));
  if (!element.moved) return target;
  std::vector<Moved> moved;
  for (const auto& [source, step, forward, back] : *element.moved) {
    moved.push_back({source, step, transformed(forward), transformed(back)});
  }
  return WithMoved(*target, std::move(moved));
}

}  // namespace tranos::model
