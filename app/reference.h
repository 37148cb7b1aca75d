// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace tranos::app {

// docs/reference.md, made from the tables of commands, settings, functions and diagnostics.
std::string Reference();

}  // namespace tranos::app
