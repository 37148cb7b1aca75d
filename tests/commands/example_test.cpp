// SPDX-License-Identifier: GPL-3.0-or-later
// Every example of every command does what it says: help and the reference show them.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

#include "interp/run.h"

namespace tranos::interp {
namespace {

bool IsCode(std::string_view expect) { return FindCode(expect).has_value(); }
bool IsCarriedOut(const Command& row) { return row.exists(); }

// The examples' photographs, and a camera.
tl::expected<std::string, HostError> ReadExampleFile(std::string_view path) {
  if (path != "facade.png" && path != "house.png" && path != "facade.camera.json") {
    return tl::make_unexpected(HostError{HostError::kMissing, "no such file"});
  }
  std::ifstream file(TRANOS_TEST_PHOTOGRAPHS + std::string(path), std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

ScriptResult RunExample(const std::string& text) {
  return RunScript("example.trn", text, {}, {}, {ReadExampleFile, [](std::string_view) {}});
}

std::string Rendered(const ScriptResult& result) {
  std::string out;
  for (const Diagnostic& diagnostic : result.diagnostics.list()) {
    out += RenderText(diagnostic, *result.sources, false);
  }
  for (const AssertResult& assertion : result.outcome.asserts) {
    if (!assertion.passed) {
      out +=
          assertion.text + ": it is " + assertion.value + ", expected " + assertion.expected + "\n";
    }
  }
  return out;
}

class EachCommand : public testing::TestWithParam<const Command*> {};

TEST_P(EachCommand, ExamplesDoWhatTheySay) {
  const Command& row = *GetParam();
  for (const Example& example : row.examples) {
    const bool fails = IsCode(example.expect);
    std::string text(example.script);
    if (!fails) text += "\nassert " + std::string(example.expect);
    const ScriptResult result = RunExample(text);
    std::set<std::string_view> codes;
    for (const Diagnostic& diagnostic : result.diagnostics.list()) {
      if (diagnostic.severity() == Severity::kError) codes.insert(InfoOf(diagnostic.code).code);
    }
    const std::set<std::string_view> wanted =
        fails ? std::set{example.expect} : std::set<std::string_view>{};
    EXPECT_EQ(codes, wanted) << text << "\n" << Rendered(result);
    if (fails) continue;
    ASSERT_EQ(result.outcome.asserts.size(), 1u) << text;
    EXPECT_TRUE(result.outcome.asserts[0].passed) << text << "\n" << Rendered(result);
  }
}

TEST_P(EachCommand, HasExamplesOfBothKinds) {
  const Command& row = *GetParam();
  int passing = 0, failing = 0;
  for (const Example& example : row.examples) ++(IsCode(example.expect) ? failing : passing);
  EXPECT_GE(failing, 1) << row.words;
  EXPECT_EQ(passing > 0, IsCarriedOut(row)) << row.words;
}

TEST_P(EachCommand, HasEveryKeyInAnExampleThatWorks) {
  const Command& row = *GetParam();
  for (const Key& key : row.keys) {
    // A bare string stands for its key.
    if (key.name == row.string_key) continue;
    bool found = false;
    for (const Example& example : row.examples) {
      const bool used =
          example.script.find(" " + std::string(key.name) + "=") != std::string_view::npos;
      found = found || (used && !IsCode(example.expect));
    }
    EXPECT_TRUE(found) << row.words << " " << key.name << "=";
  }
}

TEST_P(EachCommand, OfALaterVersionSaysSo) {
  const Command& row = *GetParam();
  if (IsCarriedOut(row)) return;
  const ScriptResult result = RunExample(std::string(row.words));
  ASSERT_EQ(result.diagnostics.list().size(), 1u) << Rendered(result);
  EXPECT_EQ(result.diagnostics.list()[0].code, Code::kNotYet);
  EXPECT_FALSE(result.ran);
}

std::vector<const Command*> Rows() {
  std::vector<const Command*> rows;
  for (const Command& row : AllCommands()) rows.push_back(&row);
  return rows;
}

std::string NameOf(const testing::TestParamInfo<const Command*>& info) {
  std::string name(info.param->words);
  for (char& c : name) c = c == ' ' ? '_' : c;
  return name;
}

INSTANTIATE_TEST_SUITE_P(Table, EachCommand, testing::ValuesIn(Rows()), NameOf);

}  // namespace
}  // namespace tranos::interp
