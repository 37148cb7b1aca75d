// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace tranos::app {

// From here on the process's live heap may grow to this many bytes; past it an allocation throws
// std::bad_alloc, which the interpreter turns into a diagnostic. Counting is in this program's
// operator new alone.
void LimitMemory(std::uint64_t bytes);

}  // namespace tranos::app
