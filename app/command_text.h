// SPDX-License-Identifier: GPL-3.0-or-later
// What help and the reference say alike of a row of the command table. Words and keys are in
// backticks.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "interp/command.h"

namespace tranos::app {

// How it runs, in a sentence or two.
std::string MannerOf(const interp::Command& command);
// "`a`, `b`" of "a|b".
std::string QuotedWords(std::string_view list);
// Of a key without its name: what it takes, what it means, and what it is when not given.
std::string TellKey(const interp::Key& key, const interp::Command& command);
// The families in the table's order.
std::vector<std::string_view> Families();

// A statement that is no command.
struct Statement {
  std::string_view word, usage, summary;
};
const std::vector<Statement>& AllStatements();

}  // namespace tranos::app
