// SPDX-License-Identifier: GPL-3.0-or-later
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>

#include "app/command_line.h"
#include "app/console.h"
#include "app/status.h"

int main(int argc, char** argv) {
  using namespace tranos::app;
  // A reader that went away or a file that grew too large is an error of the write, not our end:
  // what was begun is cleared away, and the status tells.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  int status = kOurFault;
  try {
    status = RunCommandLine(argc, argv);
  } catch (const std::exception& fault) {
    PrintFailure(std::string("a fault of ours: ") + fault.what());
  }
  // What was said to standard output must have arrived.
  const bool failed_before = std::ferror(stdout) != 0;
  if ((std::fflush(stdout) != 0 || failed_before) &&
      (status == kFine || status == kAssertionFailed)) {
    if (errno != EPIPE) PrintFailure("standard output cannot be written");
    status = kFileFailed;
  }
  return status;
}
