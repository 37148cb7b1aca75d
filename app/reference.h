// SPDX-License-Identifier: GPL-3.0-or-later
// Help and the reference, both made from the tables of commands, settings, functions and
// diagnostics.
#pragma once

#include <string>

#include "interp/command.h"

namespace tranos::app {

std::string HelpOf(const interp::Command& command);
std::string CommandList();  // every command with its sentence, by family
std::string FunctionList();
std::string SettingList();
// docs/reference.md.
std::string Reference();

}  // namespace tranos::app
