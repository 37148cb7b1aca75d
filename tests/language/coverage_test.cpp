// SPDX-License-Identifier: GPL-3.0-or-later
// What the goldens must show between them: every diagnostic, every function, every setting.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "interp/functions.h"
#include "tests/language/golden.h"

namespace tranos::language {
namespace {

// Codes that no script can bring about by itself, and where they are tested.
const std::map<std::string, std::string>& TestedElsewhere() {
  static const std::map<std::string, std::string> elsewhere = {
      {"E0506", "tests/app: facets are made when something is written"},
      {"E0702", "tests/app: the disk is full, the folder is not writable"},
      {"E0704", "tests/app: a file that the run has read would be written"},
      {"E0801", "tests/session: a journal is read by `tranos replay`, not by a script"},
      {"E0802", "tests/session"},
      {"E0803", "tests/session"},
      {"E0804", "tests/session"},
      {"W0004", "tests/session"},
  };
  return elsewhere;
}

std::vector<Golden> AllGoldens() {
  std::vector<Golden> goldens;
  for (const std::string& path : GoldensIn(".")) goldens.push_back(ReadGolden(path));
  return goldens;
}

TEST(Coverage, EveryDiagnosticOccursInAGolden) {
  std::set<std::string> seen;
  for (const Golden& golden : AllGoldens()) {
    for (const Expected& expected : golden.diagnostics) seen.insert(expected.code);
  }
  for (const interp::Code code : interp::AllCodes()) {
    const std::string name(interp::InfoOf(code).code);
    const bool exempt = TestedElsewhere().contains(name);
    EXPECT_NE(seen.contains(name), exempt)
        << name << " " << interp::InfoOf(code).title
        << (exempt ? ": it is in a golden, so it needs no exemption" : ": no golden expects it");
  }
}

// The text of the goldens that run, without their comments.
std::string RunningText() {
  std::string text;
  for (const Golden& golden : AllGoldens()) {
    if (golden.expects_error()) continue;
    bool comment = false;
    for (const char c : golden.text) {
      comment = c != '\n' && (comment || c == '#');
      if (!comment) text += c;
    }
  }
  return text;
}

bool HasCall(const std::string& text, const std::string& name) {
  const std::string call = name + "(";
  for (std::size_t at = text.find(call); at != std::string::npos; at = text.find(call, at + 1)) {
    const char before = at > 0 ? text[at - 1] : ' ';
    if (!std::isalnum(static_cast<unsigned char>(before)) && before != '_' && before != '.') {
      return true;
    }
  }
  return false;
}

TEST(Coverage, EveryFunctionIsCalledInAGolden) {
  const std::string text = RunningText();
  for (const interp::Builtin& row : interp::AllBuiltins()) {
    EXPECT_TRUE(HasCall(text, std::string(row.name()))) << row.usage;
  }
}

TEST(Coverage, EverySettingStandsInAGolden) {
  const std::string text = RunningText();
  for (const interp::SettingRow& row : interp::AllSettings()) {
    EXPECT_NE(text.find(std::string(row.key) + "="), std::string::npos) << row.key;
  }
}

TEST(Coverage, GoldensAreSmall) {
  for (const Golden& golden : AllGoldens()) {
    EXPECT_LE(std::count(golden.text.begin(), golden.text.end(), '\n'), 24) << golden.path;
  }
}

}  // namespace
}  // namespace tranos::language
