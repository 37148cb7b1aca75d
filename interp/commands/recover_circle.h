// SPDX-License-Identifier: GPL-3.0-or-later
// Circles and arcs that are seen on a facade, fitted to dots.
#pragma once

#include "interp/command.h"

namespace tranos::interp {

CommandResult RecoverCircle(const model::State& state, const Answers& answers);
// From its first dot to its last, the way that the dots go.
CommandResult RecoverArc(const model::State& state, const Answers& answers);

}  // namespace tranos::interp
