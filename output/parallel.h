// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

namespace tranos::output {

// Calls work(i) for every i below `count`, on up to `threads` threads, the caller's among them.
// Each i must write to its own place only: then the result is the same for any number of threads.
void ParallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace tranos::output
