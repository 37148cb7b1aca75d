// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/state.h"

#include <algorithm>

namespace tranos::model {

Hash128 ContentOf(const Entry& entry) {
  if (!entry.element) return {};  // as if nothing stood there
  const auto standing = static_cast<std::uint64_t>(entry.standing);
  return entry.element->hash + Hash128{standing, standing};
}

ElementPtr Model::Current(ElementId id) const {
  return id < entries.size() ? entries[id].element : nullptr;
}

bool Model::LevelIsOn(const std::string& level) const {
  return !hidden_levels ||
         std::find(hidden_levels->begin(), hidden_levels->end(), level) == hidden_levels->end();
}

Model Apart(const Model& model) {
  Model apart = model;
  apart.entries = {};
  model.entries.ForEach([&](const Entry& entry) { apart.entries.Append(entry); });
  return apart;
}

Hash128 HashOf(const Settings& settings) {
  Hasher hasher;
  AddToHash(hasher, *settings.attributes);
  hasher.Tag(settings.attributes->own).Angle(settings.angle_rad);
  hasher.Ratio(settings.scale.x()).Ratio(settings.scale.y()).Ratio(settings.scale.z());
  hasher.Length(settings.depth_m).Length(settings.tolerance.chord_m);
  hasher.Integer(settings.tolerance.facets_per_turn).Length(settings.locate_tolerance_m);
  hasher.Ratio(settings.noise_px).Text(settings.unit);
  hasher.Point(settings.plane.origin).Direction(settings.plane.x).Direction(settings.plane.y);
  if (settings.facade) hasher.Hash(settings.facade->hash);
  return hasher.Finish();
}

static void AddToHash(Hasher& hasher, const View& view, const Model& model) {
  hasher.Tag(static_cast<std::uint8_t>(view.mode)).Tag(view.antialias).Tag(view.shadows);
  hasher.Tag(view.textured).Tag(view.photo).Text(view.direction);
  if (const ElementPtr camera = model.Current(view.camera)) hasher.Hash(camera->hash);
}

Hash128 HashOf(const State& state) {
  const auto& [model, drawing] = state;
  Hasher hasher;
  hasher.Hash(model.hash).Hash(HashOf(*drawing.settings)).Point(drawing.last_point);
  hasher.Hash(drawing.selection.HashIn(model.entries)).Hash(drawing.last.HashIn(model.entries));
  hasher.Hash(drawing.names.hash());
  AddToHash(hasher, *drawing.view, model);
  if (const ElementPtr photograph = model.Current(drawing.photograph))
    hasher.Hash(photograph->hash);
  if (model.hidden_levels) {
    for (const std::string& level : *model.hidden_levels) hasher.Text(level);
  }
  return hasher.Finish();
}

}  // namespace tranos::model
