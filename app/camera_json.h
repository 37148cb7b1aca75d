// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "model/element.h"

namespace tranos::app {

// A photograph's camera as docs/language.md, "What a run reports" describes it: millimetres,
// degrees, metres; null for what is not determined.
nlohmann::ordered_json CameraJson(const model::Element& element,
                                  const model::Photograph& photograph);

}  // namespace tranos::app
