// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "output/orthophoto.h"

namespace tranos::app {

// What is to be known of an orthophoto's picture: the facade, the length of a pixel, the ground
// sampling distance of its photograph, where its lower left corner lies and its axes point in the
// world (metres), and the shares of it that are hidden or outside the photograph.
std::string OrthophotoJson(const model::Orthophoto& made, const output::SeenPixels& seen,
                           const std::string& picture);

}  // namespace tranos::app
