// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace tranos::app {

// Reads the command line and runs its verb; gives the exit status.
int RunCommandLine(int argc, char** argv);

}  // namespace tranos::app
