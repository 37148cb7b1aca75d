// SPDX-License-Identifier: GPL-3.0-or-later
// A golden: a script whose comments say what it must do. See README.md in this folder.
#pragma once

#include <string>
#include <vector>

#include "interp/run.h"

namespace tranos::language {

// "# expect error E0203: a length" in line 4, or about it.
struct Expected {
  std::string code;      // "E0203", "W0002"
  std::string fragment;  // of its message, label or help; "" for any
  std::string file;      // "" for the golden itself
  std::uint32_t line = 0;
};

struct Golden {
  std::string path;  // from the folder of goldens
  std::string text;
  std::vector<Expected> diagnostics;
  std::vector<std::string> prints;
  std::vector<std::uint32_t> failed;    // lines of assertions that must fail
  std::vector<std::string> undeclared;  // -D names that the script must not know
  interp::BindOptions bind;
  interp::Limits limits;
  std::vector<std::string> mistakes;  // in the expectations themselves
  bool expects_error() const;
};

// All files *.trn in the folder and below, in the order of their paths.
std::vector<std::string> GoldensIn(const std::string& folder);
Golden ReadGolden(const std::string& path);

// What a script did, in lines that can be compared.
struct Result {
  std::vector<std::string> told;  // "line 4: error E0203", "line 6: failed", "print: 3 m", …
  std::string rendered;           // its diagnostics and failed assertions as a person sees them
  bool has_errors = false;
  model::Hash128 hash;
};
// Runs the text with the golden's options; files are read from beside the golden.
Result RunText(const Golden& golden, const std::string& text);
// "" if the golden does what its comments say, otherwise what differs.
std::string Difference(const Golden& golden);
// "" if the script has the same effect in the one layout, and that layout is left as it is.
std::string FormattedDifference(const Golden& golden);

}  // namespace tranos::language
