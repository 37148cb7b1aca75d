// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace tranos::output {

void ParallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failing;
  // An exception (memory has a limit) ends the work and is passed on to the caller.
  const auto take = [&] {
    try {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    } catch (...) {
      next = count;
      const std::lock_guard lock(failing);
      failure = std::current_exception();
    }
  };
  const std::size_t helper_count =
      std::min<std::size_t>(static_cast<std::size_t>(std::max(threads, 1)), count);
  std::vector<std::jthread> helpers;
  try {
    for (std::size_t i = 1; i < helper_count; ++i) helpers.emplace_back(take);
  } catch (const std::system_error&) {
    // The machine gives no more threads: those that run do the work.
  }
  take();
  helpers.clear();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace tranos::output
