// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace tranos::app {

// Exit statuses (docs/language.md, "Evidence and errors").
enum Status : int {
  kFine = 0,
  kScriptIsWrong = 1,
  kCommandLineIsWrong = 2,
  kFileFailed = 3,
  kAssertionFailed = 4,
  kOurFault = 5,
};

}  // namespace tranos::app
