// SPDX-License-Identifier: GPL-3.0-or-later
// What a benchmark found, as the generated parts of docs/camera.md.
#pragma once

#include <map>
#include <string>

#include "bench/markdown.h"

namespace tranos::bench {

// Blocks by their names, and plots by their files' names.
struct Report {
  std::map<std::string, std::string> blocks;
  std::map<std::string, std::string> plots;

  // Prints it, too.
  void Add(const std::string& name, std::string text);
};

// Rewrites the blocks of DOCS/camera.md and the plots in DOCS/camera; says what failed.
bool WriteDocs(const std::string& docs, const Report&);

}  // namespace tranos::bench
