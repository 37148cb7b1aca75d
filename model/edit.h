// SPDX-License-Identifier: GPL-3.0-or-later
// What one firing does to the state, as a value; only Apply makes a new state.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "model/photo_request.h"
#include "model/state.h"

namespace tranos::model {

struct RenderRequest {
  Model model;  // as it stood when asked for
  View view;
  std::string file;  // "" for the next numbered picture
  int width_px = 1280, height_px = 960;
};
struct ExportRequest {
  Model model;
  std::string file;          // its extension chooses the format
  bool photographs = false;  // as planes at their frames, where the format can hold them
};
// A photograph that is taken, and beside it, as JSON, how it came to be.
struct PhotoFileRequest {
  std::shared_ptr<const PhotoRequest> taken_as;
  std::shared_ptr<const camera::PhotoFile> picture;
  std::string file;
};
// An orthophoto, and beside it, as JSON, where it lies and what is not seen of it.
struct OrthophotoRequest {
  OrthophotoPtr made;
  std::string file;
};
// How other programs keep a camera.
enum class CameraFormat : std::uint8_t {
  kFspyProject,
  kFspyJson,
  kOpenCv,
  kColmap,
  kBlender,
  kExact
};
struct CameraRequest {
  ElementPtr photograph;     // with a camera that is determined
  camera::PhotoPtr picture;  // what is seen on it; null for a stated camera
  CameraFormat format;
  std::string file;  // of COLMAP a folder
};
using OutputRequest =
    std::variant<RenderRequest, ExportRequest, CameraRequest, PhotoFileRequest, OrthophotoRequest>;
// The model that it shows or tells of; null if it is of none.
const Model* ModelOf(const OutputRequest& request);

// That the traces which an edit adds were found in a photograph's pixels, which a journal does not
// keep: with what it is found by, a replay finds them again.
struct Detection {
  Hash128 content;           // of the photograph
  double min_length_px = 0;  // of the edges asked for
};

struct Edit {
  std::vector<ElementPtr> added;     // Apply gives them their ids, in order
  std::vector<ElementPtr> replaced;  // new content under the same id
  std::vector<ElementId> following;  // those of `replaced` that only follow others: not in `last`
  std::vector<ElementId> consumed;   // made into something else: out of the model, geometry kept
  std::vector<ElementId> deleted;
  // With the first of `added` a group: these go into it (they leave the model as its members).
  std::vector<ElementId> grouped;
  // Members of dropped groups that stand in the model by themselves again, with their ids.
  std::vector<ElementPtr> released;
  std::optional<Selection> selection;  // ids; kAddedBase + i stands for the i-th of `added`
  std::optional<SettingsPtr> settings;
  std::optional<View> view;
  std::optional<std::vector<std::string>> hidden_levels;
  std::optional<geom::Vec3> last_point;
  std::optional<ElementId> photograph;  // the one that traces go to; kAddedBase + i as above
  std::vector<OutputRequest> outputs;   // no part of the state: app runs them after the script
  std::optional<Detection> detection;   // likewise: for the journal

  bool ChangesModel() const {
    return !added.empty() || !replaced.empty() || !consumed.empty() || !deleted.empty() ||
           !released.empty();
  }
};
inline constexpr ElementId kAddedBase = 0x80000000;

struct Applied {
  State state;
  std::vector<ElementId> made_or_changed;  // added (with their ids), replaced and released
};
// The state after the edit. What is consumed or deleted leaves the selection; `last` becomes what
// was made or changed, if anything was.
Applied Apply(State state, const Edit& edit);

}  // namespace tranos::model
