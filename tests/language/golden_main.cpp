// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the goldens of the folders given: each as it is written, and those without errors also as
// `tranos fmt` lays them out.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/language/golden.h"

namespace tranos::language {
namespace {

class Runs : public testing::Test {
 public:
  explicit Runs(std::string path) : path_(std::move(path)) {}
  void TestBody() override {
    const std::string difference = Difference(ReadGolden(path_));
    if (!difference.empty()) FAIL() << path_ << "\n" << difference;
  }

 private:
  std::string path_;
};

class RunsFormatted : public testing::Test {
 public:
  explicit RunsFormatted(std::string path) : path_(std::move(path)) {}
  void TestBody() override {
    const std::string difference = FormattedDifference(ReadGolden(path_));
    if (!difference.empty()) FAIL() << path_ << "\n" << difference;
  }

 private:
  std::string path_;
};

int Register(const std::string& folder) {
  int count = 0;
  for (const std::string& path : GoldensIn(folder)) {
    testing::RegisterTest("Runs", path.c_str(), nullptr, nullptr, path.c_str(), 1,
                          [path]() -> testing::Test* { return new Runs(path); });
    ++count;
    if (ReadGolden(path).expects_error()) continue;
    testing::RegisterTest("RunsFormatted", path.c_str(), nullptr, nullptr, path.c_str(), 1,
                          [path]() -> testing::Test* { return new RunsFormatted(path); });
  }
  return count;
}

}  // namespace
}  // namespace tranos::language

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  for (int i = 1; i < argc; ++i) {
    if (tranos::language::Register(argv[i]) > 0) continue;
    std::fprintf(stderr, "%s holds no scripts\n", argv[i]);
    return 1;
  }
  return RUN_ALL_TESTS();
}
