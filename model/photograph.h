// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs with their cameras, and what was traced on them. They are elements, so that names,
// undo, the journal and the comparison of runs take them as they take walls; but they are no part
// of the building: they have no place in space and are not picked.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "camera/estimate.h"
#include "camera/photo_file.h"
#include "model/hash.h"
#include "model/value.h"

namespace tranos::model {

struct Element;

// A photograph, or a camera that was stated without one.
struct Photograph {
  std::string file;      // as the script gives it; "" for a stated camera, or one made by rendering
  Hash128 content = {};  // of the file's bytes, or of all that a rendered one was made from
  // Null for a stated camera, and in a replay, which needs no pixels.
  std::shared_ptr<const camera::PhotoFile> picture = nullptr;
  bool attached = false;  // what `calibrate` adjusts; a rendered one is not until it is attached
  camera::Frame frame = {};
  std::string camera_file = {};  // that the estimate was read from; "" if it was not
  bool format_is_stated = true;  // else the longer side is taken for 36 mm
  camera::Prior priors[camera::kIntrinsics] = {};
  // What `calibrate` found, or the camera as it was stated or read; null until then.
  std::shared_ptr<const camera::Estimate> estimate = nullptr;
  std::vector<Dimension> unknown_dimensions = {};  // of each of the estimate's unknowns
};

struct Trace {
  enum class Kind : std::uint8_t {
    kDirection,  // an edge along an axis
    kEdge,       // from, to
    kElement,    // an edge that is an element of the model
    kPoint,      // at
    kRectangle,  // a, b
    kRatio,      // the first edge's length by the second's
    kCircle,
  };
  Kind kind;
  std::uint32_t photograph = 0;  // id of the photograph's element, of a run
  std::vector<geom::Vec2> dots_px = {};
  int axis = 0;                     // of kDirection: 0, 1, 2 for X, Y, Z; −1: not known yet
  std::vector<Value> numbers = {};  // in SI, with their derivatives: 6 of kEdge, 3 of kPoint, …
  std::shared_ptr<const Element> of = nullptr;
  std::string facade = {};
  double noise_px = 0.5;  // of each coordinate of a dot
  double samples = 0;     // pixels that the line was fitted to; 0: its dots alone
};

// Whether it is a camera that was stated, with no picture to it.
bool IsStatedCamera(const Photograph& photograph);
// Whether every number of its camera is known, if only with priors: it can be drawn, seen and
// exported through.
bool HasCamera(const Photograph& photograph);
void AddToHash(Hasher& hasher, const Photograph& photograph);
void AddToHash(Hasher& hasher, const Trace& trace);
std::string TypeOf(const Trace& trace);  // "trace edge", "trace rectangle", …

}  // namespace tranos::model
