// SPDX-License-Identifier: GPL-3.0-or-later
// How an error travels inside this room: thrown without a place by what computes, caught and given
// its span by the machine. Neither leaves the room.
#pragma once

#include <string>

#include "interp/diagnostic.h"

namespace tranos::interp {

// An operation that cannot be done. `operand` is the argument at fault, −1 for the whole.
struct OpFailure {
  Code code;
  std::string message;
  std::string label = {};
  std::string help = {};
  int operand = -1;
};

// A run that stops here.
struct RunFailure {
  Diagnostic diagnostic;
};

}  // namespace tranos::interp
