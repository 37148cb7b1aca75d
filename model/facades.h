// SPDX-License-Identifier: GPL-3.0-or-later
// The facades of a model, by the names that commands know them by.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model/state.h"

namespace tranos::model {

// The facade of an element that is one.
const Facade& FacadeOf(const Element& element);
// The facade of this name; null if there is none.
ElementPtr FindFacade(const Model& model, std::string_view name);
// The names of all of them, in the order of their making.
std::vector<std::string> FacadeNames(const Model& model);

}  // namespace tranos::model
