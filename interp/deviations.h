// SPDX-License-Identifier: GPL-3.0-or-later
// Deviations of what is made from what was drawn through a photograph. A command is a function from
// a state and answers to an edit: carried out again with each source a little to either side, it
// tells how what it makes hangs on that source, whatever the command is.
#pragma once

#include <span>

#include "interp/arithmetic.h"
#include "interp/commands/drawing.h"

namespace tranos::interp {

// Gives the elements that the edit adds or replaces their `moved`, from the points' terms (by the
// answers' points) and from the elements that were chosen or given. Returns how often the command
// was carried out for it; nothing where it cannot be carried out beside the values, so that what it
// makes has no deviations.
std::optional<int> CarryDeviations(const Command& row, const model::State& before,
                                   const Answers& answers, std::span<const PointTerms> terms,
                                   const SourceList& sources, model::Edit* edit);

}  // namespace tranos::interp
