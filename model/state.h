// SPDX-License-Identifier: GPL-3.0-or-later
// State{Model, Drawing}: everything a key-in can read or change. It is made of persistent parts, so
// that keeping an earlier state (undo, the journal, the diff) costs a few words.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geom/primitives.h"
#include "model/entry.h"
#include "model/names.h"
#include "model/selection.h"

namespace tranos::model {

struct Model {
  Entries entries;       // by id
  Hash128 hash;          // sum over the entries in the model
  std::size_t live = 0;  // how many are in the model
  std::shared_ptr<const std::vector<std::string>>
      hidden_levels;  // levels that are off; may be null

  // The element as it is now: of a group's member, the one in the group. Null when deleted.
  ElementPtr Current(ElementId id) const;
  bool InModel(ElementId id) const {
    return id < entries.size() && entries[id].standing == Standing::kInModel;
  }
  // Calls f(element) for every element in the model, in the order of their ids.
  template <class F>
  void ForEach(F&& f) const {
    entries.ForEach([&](const Entry& entry) {
      if (entry.element && entry.standing == Standing::kInModel) f(entry.element);
    });
  }
  bool LevelIsOn(const std::string& level) const;
};

// The same model in storage of its own, for an element to hold: versions of a model share the
// blocks that later elements are appended to, and an element that held them would hold itself.
Model Apart(const Model& model);

// The settings (docs/language.md, "Settings") and the active plane; immutable, shared until one is
// set.
struct Settings {
  AttributesPtr attributes = std::make_shared<const Attributes>();
  double angle_rad = 0;                   // aa
  geom::Vec3 scale = geom::Vec3::Ones();  // as
  double depth_m = 0;                     // az
  geom::Tolerance tolerance;              // tol, fn
  double locate_tolerance_m = 0.01;       // lt
  double noise_px = 0.5;                  // noise; 0: estimated from the residuals
  std::string unit = "m";                 // un, for messages
  geom::Frame plane;                      // the active system
  ElementPtr facade = nullptr;            // the one that dots are drawn on, when it was set
};
using SettingsPtr = std::shared_ptr<const Settings>;
Hash128 HashOf(const Settings& settings);

enum class RenderMode : std::uint8_t { kWireframe, kHidden, kPhong };
// How the next picture looks: the last `set view` and `view`.
struct View {
  RenderMode mode = RenderMode::kPhong;
  bool antialias = false;
  bool shadows = false;
  bool textured = false;  // faces bear the orthophotos that lie in their planes
  bool photo = false;     // photographs are seen: behind all, or as planes at their frames
  std::string direction;  // "front" … "iso"; "" until `view` is used, which renders as iso
  ElementId camera = kNoElement;  // through which it is seen, in place of a direction
};
geom::Frame FrameOf(std::string_view direction);  // x right, y up, z towards the viewer
// The photograph that the view is through, as the model has it now; null where the view is along a
// direction, or the photograph is gone or has no camera.
ElementPtr CameraOf(const View& view, const Model& model);
// The axes of the view; as `otherwise` where none was chosen yet.
geom::Frame FrameOf(const View& view, const Model& model, std::string_view otherwise);

struct Drawing {
  SettingsPtr settings = std::make_shared<const Settings>();
  geom::Vec3 last_point = geom::Vec3::Zero();
  Selection selection;
  Selection last;  // what the most recent firing that made or changed elements made or changed
  Names names;
  std::shared_ptr<const View> view = std::make_shared<const View>();
  ElementId photograph = kNoElement;  // the one last attached or set
};

struct State {
  Model model;
  Drawing drawing;
};

// Over everything in it, by content and never by id. In constant time, but for the levels that are
// off.
Hash128 HashOf(const State& state);

}  // namespace tranos::model
