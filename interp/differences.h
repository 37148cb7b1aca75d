// SPDX-License-Identifier: GPL-3.0-or-later
// Values read off elements that hang on sources of uncertainty: read once more with each source a
// little to either side, so that every measure, whatever it is of, carries its derivatives.
#pragma once

#include <functional>
#include <span>

#include "interp/functions.h"

namespace tranos::interp {

// `read` of the element, its numbers with their derivatives by what the element hangs on.
model::Value ReadOff(const model::ElementPtr& element,
                     const std::function<model::Value(const model::ElementPtr&)>& read);

// The function's result; where arguments are elements, with the derivatives by what they hang on.
model::Value CallBuiltin(const Builtin& row, const CallContext& context,
                         std::span<const model::Value> arguments);

}  // namespace tranos::interp
