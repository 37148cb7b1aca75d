// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/report.h"

#include <fmt/format.h>

#include <fstream>
#include <iostream>
#include <sstream>

namespace tranos::bench {
namespace {

bool WriteFile(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  return file.flush().good();
}

}  // namespace

void Report::Add(const std::string& name, std::string text) {
  std::cout << text << std::flush;
  blocks[name] = std::move(text);
}

bool WriteDocs(const std::string& docs, const Report& report) {
  std::ostringstream text;
  text << std::ifstream(docs + "/camera.md", std::ios::binary).rdbuf();
  const auto written = WithBlocks(text.str(), report.blocks);
  if (!written) {
    std::cerr << "a generated block has lost its marks in " << docs << "/camera.md\n";
    return false;
  }
  bool is_written = WriteFile(docs + "/camera.md", *written);
  for (const auto& [name, plot] : report.plots)
    is_written &= WriteFile(fmt::format("{}/camera/{}", docs, name), plot);
  if (!is_written) std::cerr << "could not write below " << docs << "\n";
  return is_written;
}

}  // namespace tranos::bench
