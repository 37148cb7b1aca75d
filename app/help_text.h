// SPDX-License-Identifier: GPL-3.0-or-later
// Help for a terminal, made from the same tables as the reference.
#pragma once

#include <string>

#include "interp/command.h"

namespace tranos::app {

std::string HelpOf(const interp::Command& command);
std::string CommandList();  // every command with its sentence, by family
// The commands whose words begin so; "" if there are none.
std::string CommandsFrom(const std::string& beginning);
// The commands and functions that speak of a word; "" if none does.
std::string CommandsAbout(const std::string& word);
std::string StatementList();
std::string PointList();
std::string SettingList();
std::string FunctionList();
// Of a statement's word, a setting, a data point's key or a function; "" if it is none.
std::string HelpOfWord(const std::string& word);

}  // namespace tranos::app
