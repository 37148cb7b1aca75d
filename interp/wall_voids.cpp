// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/wall_voids.h"

#include <algorithm>

namespace tranos::interp {

using model::Edit;
using model::Element;
using model::ElementId;
using model::ElementPtr;
using model::Instance;
using model::Model;

namespace {

const Instance* InstanceOf(const Element& element) {
  const auto* instance = std::get_if<model::InstancePtr>(&element.geometry);
  return instance ? instance->get() : nullptr;
}

// The solid of a wall, in its prototype's frame; null for another element.
model::SolidPtr SolidOfWall(const Element& element) {
  const Instance* instance = InstanceOf(element);
  if (!instance || instance->prototype->words != "wall") return nullptr;
  if (instance->prototype->parts.size() != 1) return nullptr;
  const auto* solid = std::get_if<model::SolidPtr>(&instance->prototype->parts[0]->geometry);
  return solid ? *solid : nullptr;
}

// What the element takes out of its wall, moved by `target_from_world`.
void AddVoids(const Element& element, const geom::Affine& target_from_world,
              std::vector<geom::Solid>* voids) {
  const Instance* instance = InstanceOf(element);
  if (!instance) return;
  const geom::Affine target_from_part = target_from_world * instance->world_from_prototype;
  for (const model::NamedElements& named : instance->prototype->names) {
    if (named.name != "void") continue;
    for (const ElementPtr& part : named.elements) {
      model::ForEachLeaf(*part, [&](const Element& leaf, const geom::Affine& part_from_leaf,
                                    const model::Attributes&) {
        if (const auto* solid = std::get_if<model::SolidPtr>(&leaf.geometry)) {
          voids->push_back((*solid)->Transformed(target_from_part * part_from_leaf));
        }
      });
    }
  }
}

// The wall with another solid.
ElementPtr WithSolid(const Element& wall, geom::Solid solid) {
  const Instance& instance = *InstanceOf(wall);
  model::Prototype prototype = *instance.prototype;
  prototype.parts[0] = model::WithGeometry(*prototype.parts[0],
                                           std::make_shared<const geom::Solid>(std::move(solid)));
  return model::WithGeometry(
      wall, std::make_shared<const Instance>(Instance{model::MakePrototype(std::move(prototype)),
                                                      instance.world_from_prototype}));
}

// By the boxes of its facets: a wall with corners fills little of its own. A void as deep as the
// wall ends where they are.
bool MeetsFacets(const geom::Solid& wall, const geom::Box& box) {
  const auto facets = wall.Facets();
  if (!facets) return true;
  const geom::Vec3 low = box.min.array() - geom::kCoincident_m;
  const geom::Vec3 high = box.max.array() + geom::kCoincident_m;
  return std::any_of((*facets)->triangles.begin(), (*facets)->triangles.end(),
                     [&](const std::array<std::uint32_t, 3>& triangle) {
                       geom::Box facet;
                       for (const std::uint32_t i : triangle) facet.Add((*facets)->positions[i]);
                       return (facet.min.array() <= high.array()).all() &&
                              (low.array() <= facet.max.array()).all();
                     });
}

bool StandsElsewhere(const Instance& a, const Instance& b) {
  return a.world_from_prototype.matrix() != b.world_from_prototype.matrix();
}

}  // namespace

bool WallVoids::Place(const Model& model, ElementId wall, ElementId guest, const Element& element,
                      Edit* edit) {
  const ElementPtr host = model.InModel(wall) ? model.Current(wall) : nullptr;
  const model::SolidPtr solid = host ? SolidOfWall(*host) : nullptr;
  if (!solid) return true;
  std::vector<geom::Solid> voids;
  AddVoids(element, InstanceOf(*host)->world_from_prototype.inverse(), &voids);
  if (voids.empty()) return true;
  if (std::none_of(voids.begin(), voids.end(), [&](const geom::Solid& hollow) {
        return MeetsFacets(*solid, hollow.Bounds());
      })) {
    return false;
  }
  Wall& entry = walls_.try_emplace(wall, Wall{solid, {}}).first->second;
  entry.guests.push_back(guest);
  Recut(model, wall, entry, {{guest, edit->added.back()}}, edit);
  return true;
}

void WallVoids::Recut(const Model& model, ElementId id, const Wall& wall,
                      const std::map<ElementId, ElementPtr>& changed, Edit* edit) const {
  const ElementPtr element = model.Current(id);
  const geom::Affine wall_from_world = InstanceOf(*element)->world_from_prototype.inverse();
  std::vector<geom::Solid> voids;
  for (const ElementId guest : wall.guests) {
    const auto found = changed.find(guest);
    const bool stands = found == changed.end() && model.InModel(guest);
    const ElementPtr now = stands                   ? model.Current(guest)
                           : found == changed.end() ? nullptr
                                                    : found->second;
    if (now) AddVoids(*now, wall_from_world, &voids);
  }
  edit->replaced.push_back(
      WithSolid(*element, voids.empty() ? *wall.uncut
                                        : geom::Solid::Difference(*wall.uncut, std::move(voids))));
  edit->following.push_back(id);
}

void WallVoids::Follow(const Model& model, Edit* edit) const {
  if (walls_.empty()) return;
  std::map<ElementId, ElementPtr> changed;  // null where deleted
  for (const ElementPtr& element : edit->replaced) changed[element->id] = element;
  for (const ElementId id : edit->deleted) changed[id] = nullptr;
  for (const ElementId id : edit->consumed) changed[id] = nullptr;
  for (const auto& [id, wall] : walls_) {
    if (!model.InModel(id)) continue;
    const auto moved = changed.find(id);
    if (moved == changed.end()) {
      bool affected = false;
      for (const ElementId guest : wall.guests) affected = affected || changed.contains(guest);
      if (affected) Recut(model, id, wall, changed, edit);
      continue;
    }
    if (!moved->second) continue;
    const Instance &before = *InstanceOf(*model.Current(id)), &after = *InstanceOf(*moved->second);
    if (!StandsElsewhere(before, after)) continue;
    const geom::Affine motion = after.world_from_prototype * before.world_from_prototype.inverse();
    for (const ElementId guest : wall.guests) {
      if (changed.contains(guest) || !model.InModel(guest)) continue;
      edit->replaced.push_back(model::Transformed(*model.Current(guest), motion));
      edit->following.push_back(guest);
    }
  }
}

}  // namespace tranos::interp
