// SPDX-License-Identifier: GPL-3.0-or-later
// Elements for the tests of model.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model/edit.h"

namespace tranos::model {

inline AttributesPtr PlainAttributes() { return std::make_shared<const Attributes>(); }

inline ElementPtr MakePoint(double x, double y = 0, double z = 0) {
  return MakeElement(kNoElement, Point{geom::Vec3(x, y, z)}, PlainAttributes(), nullptr, {});
}

inline ElementPtr MakeCurve(geom::Curve curve) {
  return MakeElement(kNoElement, std::make_shared<const geom::Curve>(std::move(curve)),
                     PlainAttributes(), nullptr, {});
}

inline ElementPtr MakeRegion(const std::vector<geom::Curve>& outlines) {
  return MakeElement(kNoElement, std::make_shared<const geom::Region>(*geom::RegionOf(outlines)),
                     PlainAttributes(), nullptr, {});
}

inline ElementPtr MakeGroupOf(std::vector<ElementPtr> members,
                              std::vector<NamedElements> names = {}) {
  Group group;
  group.members = std::move(members);
  group.names = std::move(names);
  return MakeElement(kNoElement, MakeGroup(std::move(group)), PlainAttributes(), nullptr, {});
}

inline ElementPtr MakeInstance(std::vector<ElementPtr> parts, const geom::Affine& world,
                               AttributesPtr attributes = PlainAttributes()) {
  Prototype prototype;
  prototype.words = "arch";
  prototype.parts = std::move(parts);
  return MakeElement(
      kNoElement,
      std::make_shared<const Instance>(Instance{MakePrototype(std::move(prototype)), world}),
      std::move(attributes), nullptr, {});
}

inline geom::Affine Translation(double x, double y = 0, double z = 0) {
  geom::Affine affine = geom::Affine::Identity();
  affine.translation() = geom::Vec3(x, y, z);
  return affine;
}

// The state after an edit that adds these.
inline State With(State state, std::vector<ElementPtr> added) {
  Edit edit;
  edit.added = std::move(added);
  return Apply(std::move(state), edit).state;
}

}  // namespace tranos::model
