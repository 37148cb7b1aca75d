// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "interp/run.h"

namespace tranos::app {

// Reads "steps=1000,memory=500M": k, M and G stand for thousands, millions and thousands of
// millions. Gives what is wrong with the text, or nothing.
std::string ReadLimits(const std::string& text, interp::Limits* limits);

}  // namespace tranos::app
