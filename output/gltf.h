// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "model/state.h"
#include "output/result.h"

namespace tranos::output {

struct GltfOptions {
  // A GLB counts its bytes in 32 bits; beyond this the export is an error, not a torn file.
  std::uint64_t max_bytes = 0xfffff000;
  bool photographs = false;  // with cameras, as planes at their frames
  int threads = 1;
};

// The visible part of the model as the bytes of a GLB (glTF 2.0, binary): metres, one root node
// that turns Z up into Y up, below it a node for each element in model coordinates. Faces in the
// plane of an orthophoto bear it. The same model gives the same bytes, with any number of threads.
Result<std::string> GlbOf(const model::Model& model, const GltfOptions& options);

}  // namespace tranos::output
