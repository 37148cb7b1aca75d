// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <exception>

#include "app/command_line.h"
#include "app/console.h"
#include "app/status.h"

int main(int argc, char** argv) {
  using namespace tranos::app;
  int status = kOurFault;
  try {
    status = RunCommandLine(argc, argv);
  } catch (const std::exception& fault) {
    PrintFailure(std::string("a fault of ours: ") + fault.what());
  }
  // What was said to standard output must have arrived.
  if (std::fflush(stdout) != 0 && status == kFine) {
    PrintFailure("standard output cannot be written");
    status = kFileFailed;
  }
  return status;
}
