// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>

#include "app/console.h"

namespace tranos::app {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPatience{500};
constexpr milliseconds kBetween{100};

}  // namespace

// The clock is read by a thread of its own, so that a step that takes long does not stop the line,
// and the work itself never waits.
struct Progress::Line {
  std::mutex mutex;
  std::condition_variable_any changed;
  std::string doing;
  bool shown = false;
  std::jthread painter;

  void Paint(const std::stop_token& stop) {
    std::unique_lock lock(mutex);
    for (milliseconds wait = kPatience;
         !changed.wait_for(lock, stop, wait, [&] { return stop.stop_requested(); });
         wait = kBetween) {
      if (doing.empty()) continue;
      PrintError("\r\033[K" + doing);
      std::fflush(stderr);
      shown = true;
    }
  }

  void Hide() {
    const std::lock_guard lock(mutex);
    if (shown) PrintError("\r\033[K");
    shown = false;
  }
};

Progress::Progress() {
  if (!ErrorsAreOnTerminal()) return;
  line_ = std::make_unique<Line>();
  Line* const line = line_.get();
  line->painter = std::jthread([line](const std::stop_token& stop) { line->Paint(stop); });
}

Progress::~Progress() {
  if (!line_) return;
  line_->painter = {};  // ends and joins
  line_->Hide();
}

void Progress::Tell(std::string doing) {
  if (!line_) return;
  const std::lock_guard lock(line_->mutex);
  line_->doing = std::move(doing);
}

void Progress::Hide() {
  if (line_) line_->Hide();
}

}  // namespace tranos::app
