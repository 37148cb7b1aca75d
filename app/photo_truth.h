// SPDX-License-Identifier: GPL-3.0-or-later
// What is true of a photograph that the program made, for whoever tests what is recovered from it.
#pragma once

#include <string>

#include "model/photo_request.h"

namespace tranos::app {

// JSON: the camera as `run --json` tells cameras, with the photograph's own size; the lens's
// distortion, the sun, the effects and the seed. Angles in degrees.
std::string PhotoTruthJson(const model::PhotoRequest& request, const std::string& picture);

}  // namespace tranos::app
