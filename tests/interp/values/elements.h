// SPDX-License-Identifier: GPL-3.0-or-later
// Elements for tests: they stand in no model, unless it is said.
#pragma once

#include "model/edit.h"
#include "values.h"

namespace tranos::interp {

inline model::ElementPtr Made(model::Geometry geometry) {
  return model::MakeElement(model::kNoElement, std::move(geometry),
                            std::make_shared<const model::Attributes>(), nullptr, {});
}
inline Value ElementOf(geom::Curve curve) {
  return Value::OfElement(Made(std::make_shared<const geom::Curve>(std::move(curve))));
}
inline Value LineOf(const geom::Vec3& a, const geom::Vec3& b) {
  return ElementOf(geom::Line{a, b});
}
inline Value ShapeOf(std::vector<geom::Vec3> vertices) {
  return ElementOf(geom::Polyline{std::move(vertices), true});
}
inline geom::Frame At(const geom::Vec3& origin) {
  geom::Frame frame;
  frame.origin = origin;
  return frame;
}
inline Value CircleOf(const geom::Vec3& centre, double radius) {
  return ElementOf(geom::Circle{At(centre), radius});
}
inline Value ArcOf(const geom::Vec3& centre, double radius, double sweep_rad) {
  return ElementOf(geom::Arc{At(centre), radius, sweep_rad});
}
inline Value PointOfElement(const geom::Vec3& position) {
  return Value::OfElement(Made(model::Point{position}));
}
inline Value RuledOf(const geom::Line& a, const geom::Line& b) {
  const geom::Result<geom::Surface> surface = geom::Ruled(a, b);
  EXPECT_TRUE(surface.has_value());
  return Value::OfElement(Made(std::make_shared<const geom::Surface>(*surface)));
}
inline Value GroupOf(const std::vector<std::pair<std::string, Value>>& members) {
  model::Group group;
  for (const auto& [name, member] : members) {
    group.members.push_back(member.element());
    group.names.push_back({name, {member.element()}, false});
  }
  return Value::OfElement(Made(std::make_shared<const model::Group>(std::move(group))));
}

}  // namespace tranos::interp
