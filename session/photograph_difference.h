// SPDX-License-Identifier: GPL-3.0-or-later
// What differs between two photographs, their cameras, or two traces.
#pragma once

#include <vector>

#include "session/difference.h"

namespace tranos::session {

// In the units of a camera's report; nothing for elements of other types. A parameter that was
// found tells by how much it differs, also in deviations: "40.4 mm (+0.4 mm, 3.1 of its
// deviations)".
std::vector<ParameterChange> PhotographChanges(const model::Element& before,
                                               const model::Element& after);

}  // namespace tranos::session
