// SPDX-License-Identifier: GPL-3.0-or-later
// Each folder of pairs/ holds two scripts and what differs in effect between them, as a person
// would say it. A first line `# run: …` gives -D and --hypothesis.
#include <gmock/gmock.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "runs.h"

namespace tranos::session {

namespace {

std::string Short(double number) {
  char buffer[32];
  const auto [end, error] =
      std::to_chars(buffer, buffer + sizeof buffer, number + 0.0, std::chars_format::general, 6);
  return std::string(buffer, end);
}

std::pair<std::string, std::string> Halves(const ElementChange& change) {
  static constexpr const char* kWords[] = {"added ", "removed ", "moved ", "changed "};
  std::string head = kWords[change.kind] + change.type;
  if (!change.name.empty()) head += " `" + change.name + "`";
  if (change.by_m)
    head += " by " + Short(change.by_m->x()) + "," + Short(change.by_m->y()) + "," +
            Short(change.by_m->z());
  std::string names;
  for (const ParameterChange& parameter : change.parameters)
    names += (names.empty() ? ": " : ", ") + parameter.name;
  return {head, names};
}

}  // namespace

std::string Summary(const Difference& difference) {
  std::vector<std::pair<std::pair<std::string, std::string>, int>> lines;
  for (const ElementChange& change : difference.changes) {
    const auto halves = Halves(change);
    const auto same = std::find_if(lines.begin(), lines.end(),
                                   [&](const auto& line) { return line.first == halves; });
    if (same == lines.end())
      lines.emplace_back(halves, 1);
    else
      ++same->second;
  }
  std::string out;
  for (const auto& [halves, count] : lines) {
    out += halves.first + (count > 1 ? " x" + std::to_string(count) : "") + halves.second + "\n";
  }
  return out.empty() ? "equal\n" : out;
}

namespace {

namespace fs = std::filesystem;

std::string ReadAll(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

RunRecord RunOf(const fs::path& path) {
  const std::string text = ReadAll(path);
  RunSettings settings;
  std::istringstream first(text.substr(0, text.find('\n')));
  std::string word;
  first >> word >> word;
  if (word == "run:") {
    while (first >> word) {
      const bool is_parameter = word == "-D";
      first >> word;
      if (is_parameter)
        settings.parameters.emplace_back(word.substr(0, word.find('=')),
                                         word.substr(word.find('=') + 1));
      else
        settings.hypothesis = word;
    }
  }
  return RecordOf(path.filename().string(), text, settings);
}

std::string Mirrored(std::string summary) {
  std::vector<std::string> lines;
  std::istringstream in(summary);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("added"))
      line.replace(0, 5, "removed");
    else if (line.starts_with("removed"))
      line.replace(0, 7, "added");
    lines.push_back(line.substr(0, line.find(' ')));
  }
  std::sort(lines.begin(), lines.end());
  std::string out;
  for (const std::string& line : lines) out += line + "\n";
  return out;
}

std::vector<std::string> PairNames() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(TRANOS_SESSION_PAIRS))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

class EditPair : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const fs::path folder = fs::path(TRANOS_SESSION_PAIRS) / GetParam();
    a_ = RunOf(folder / "a.trn");
    b_ = RunOf(folder / "b.trn");
    ASSERT_EQ(ProblemsOf(a_.result), "");
    ASSERT_EQ(ProblemsOf(b_.result), "");
    expected_ = ReadAll(folder / "expect");
  }
  RunRecord a_, b_;
  std::string expected_;
};

TEST_P(EditPair, DiffersAsAPersonWouldSay) { EXPECT_EQ(Summary(Diff(a_, b_)), expected_); }

TEST_P(EditPair, IsMirroredTheOtherWayRound) {
  EXPECT_EQ(Mirrored(Summary(Diff(b_, a_))), Mirrored(Mirrored(Summary(Diff(a_, b_)))));
}

TEST_P(EditPair, IsEqualToItself) {
  EXPECT_TRUE(Diff(a_, a_).changes.empty());
  EXPECT_TRUE(Diff(b_, b_).changes.empty());
}

INSTANTIATE_TEST_SUITE_P(Pairs, EditPair, testing::ValuesIn(PairNames()),
                         [](const auto& pair) { return "Pair" + pair.param; });

TEST(EditPairs, AreManyAndHalfOfThemNameNothing) {
  const auto names = PairNames();
  std::size_t unnamed = 0;
  for (const std::string& name : names) {
    if (ReadAll(fs::path(TRANOS_SESSION_PAIRS) / name / "a.trn").find(" as ") == std::string::npos)
      ++unnamed;
  }
  EXPECT_GE(names.size(), 40U);
  EXPECT_GE(unnamed * 2, names.size());
}

}  // namespace

}  // namespace tranos::session
