// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/replay.h"

#include <gmock/gmock.h>

#include <rapidcheck/gtest.h>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "runs.h"
#include "session/replay_difference.h"

namespace tranos::session {

namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kScript =
    "place line xy=0,0 dl=10\nplace circle radius=2 xy=1,1\nplace point xy=3,3\n";

ReplayReport ReplayOf(const std::string& text) {
  const auto journal = ReadJournal(text);
  EXPECT_TRUE(journal.has_value());
  return journal ? Replay(*journal) : ReplayReport{ReplayReport::kBroken, 0, {}};
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  if (at != std::string::npos) text.replace(at, from.size(), to);
  return text;
}

TEST(Replay, OfAJournalIsEqual) {
  const ReplayReport report = ReplayOf(JournalOf(kScript));
  EXPECT_EQ(report.verdict, ReplayReport::kEqual);
  EXPECT_EQ(report.steps, 8U);
  EXPECT_THAT(report.findings, IsEmpty());
}

TEST(Replay, ReadsNothingButWhatTheJournalHolds) {
  const std::string journal =
      JournalOf("use \"lib/bay.trn\"\nplace point xy=bay,0", {}, {{"lib/bay.trn", "let bay = 3m"}});
  EXPECT_EQ(ReplayOf(journal).verdict, ReplayReport::kEqual);
}

// A library that is no longer part of the program.
TEST(Replay, HasTheLibraryOfTheRecordedRun) {
  const interp::LibraryFamily huts{"huts", "define place hut { place line xy=0,0,0 dl=3 }"};
  const interp::Library library(std::vector{huts});
  std::string journal;
  JournalWriter writer({}, "1.2.3", [&](std::string_view piece) { journal += piece; });
  interp::BindOptions options;
  options.library = &library;
  writer.Finish(interp::RunScript("test.trn", "place hut xy=0,0", options,
                                  {{}, [&](const interp::Step& step) { writer.Add(step); }}, {}));
  EXPECT_THAT(journal, HasSubstr("\"path\":\"stdlib/huts.trn\""));
  EXPECT_EQ(ReplayOf(journal).verdict, ReplayReport::kEqual);
}

TEST(Replay, OfARunThatFailedFailsAlike) {
  EXPECT_EQ(ReplayOf(JournalOf("place point xy=0,0\nplace circle radius=0 xy=0,0")).verdict,
            ReplayReport::kEqual);
}

TEST(Replay, UsesTheRecordedOptions) {
  RunSettings settings;
  settings.parameters = {{"n", "7"}};
  const std::string script = "parameter n : count = 3\nfor i = 1 to n { place point xy=i,0 }";
  const ReplayReport report = ReplayOf(JournalOf(script, settings));
  EXPECT_EQ(report.verdict, ReplayReport::kEqual);
  EXPECT_EQ(report.steps, 14U);
}

TEST(Replay, StopsAtTheFirstStepThatDiffersAndSaysWhatDiffers) {
  const std::string journal =
      Replaced(JournalOf(kScript), "\"end\":[10,0,0]", "\"end\":[10,0.25,0]");
  const ReplayReport report = ReplayOf(journal);
  EXPECT_EQ(report.verdict, ReplayReport::kDiffers);
  EXPECT_EQ(report.steps, 2U);
  ASSERT_EQ(report.findings.size(), 1U);
  EXPECT_EQ(report.findings[0].line, 4U);
  EXPECT_THAT(report.findings[0].message, HasSubstr("step 3 differs: dl=10m"));
  EXPECT_THAT(report.findings[0].details[0],
              HasSubstr("edit.added[0].geometry.end[1]: recorded 0.25, now 0"));
  EXPECT_THAT(report.findings[0].details[0], HasSubstr("by -0.25"));
}

TEST(Replay, TellsAnotherKeyIn) {
  const ReplayReport report = ReplayOf(Replaced(JournalOf(kScript), "radius=2m\"", "radius=3m\""));
  ASSERT_EQ(report.verdict, ReplayReport::kDiffers);
  EXPECT_THAT(report.findings[0].details[0],
              HasSubstr("key_in: recorded radius=3m, now radius=2m"));
}

TEST(Replay, TellsAHashThatNothingExplains) {
  std::string journal = JournalOf(kScript);
  const std::size_t at = journal.find("\"state\":\"", journal.find("\"n\":2")) + 9;
  journal[at] = journal[at] == '0' ? '1' : '0';
  const ReplayReport report = ReplayOf(journal);
  ASSERT_EQ(report.verdict, ReplayReport::kDiffers);
  EXPECT_THAT(report.findings[0].details[0], HasSubstr("state: the hash differs"));
}

// As another machine might have recorded it: the last bits of a coordinate, and so all hashes after
// it.
TEST(Replay, IsEqualWithinToleranceWhereOnlyLastBitsDiffer) {
  std::string journal = JournalOf(kScript);
  journal = Replaced(journal, "\"end\":[10,0,0]", "\"end\":[10.0000000009,0,0]");
  for (std::size_t at = journal.find("\"n\":3");
       (at = journal.find("\"model\":\"", at)) != std::string::npos; at += 9) {
    char& digit = journal[at + 9];
    digit = digit == '0' ? '1' : '0';
  }
  const ReplayReport report = ReplayOf(journal);
  EXPECT_EQ(report.verdict, ReplayReport::kWithinTolerance);
  EXPECT_EQ(report.steps, 8U);
  ASSERT_EQ(report.findings.size(), 1U);
  EXPECT_EQ(report.findings[0].code, interp::Code::kWithinTolerance);
  EXPECT_EQ(report.findings[0].line, 4U);
}

TEST(Replay, ThatIsWithinToleranceStillStopsAtARealDifference) {
  std::string journal =
      Replaced(JournalOf(kScript), "\"end\":[10,0,0]", "\"end\":[10.0000000009,0,0]");
  journal = Replaced(journal, "\"at\":[3,3,0]", "\"at\":[3,3.1,0]");
  const ReplayReport report = ReplayOf(journal);
  EXPECT_EQ(report.verdict, ReplayReport::kDiffers);
  EXPECT_EQ(report.findings.size(), 2U);
  EXPECT_EQ(report.findings[1].line, 9U);
}

TEST(Replay, TellsALineThatIsNoStep) {
  std::string journal = JournalOf(kScript);
  const std::size_t at = journal.find("{\"n\":4");
  journal[at] = '[';
  const ReplayReport report = ReplayOf(journal);
  EXPECT_EQ(report.verdict, ReplayReport::kBroken);
  EXPECT_EQ(report.findings[0].line, 5U);
}

TEST(Replay, TellsAStepThatIsMissing) {
  std::string journal = JournalOf(kScript);
  const std::size_t at = journal.find("{\"n\":4"), end = journal.find('\n', at);
  journal.erase(at, end + 1 - at);
  journal = Replaced(journal, "\"steps\":8", "\"steps\":7");
  const ReplayReport report = ReplayOf(journal);
  EXPECT_EQ(report.verdict, ReplayReport::kDiffers);
  EXPECT_EQ(report.steps, 3U);
}

TEST(CompareLines, TakesNumbersWithinAKeyInAsNumbers) {
  const auto close = CompareLines(R"({"n":1,"key_in":"xy=0.30000000000000004m,1m"})",
                                  R"({"n":1,"key_in":"xy=0.3m,1m"})");
  EXPECT_THAT(close.differing, IsEmpty());
  EXPECT_EQ(close.close, 1U);
  const auto far =
      CompareLines(R"({"n":1,"key_in":"xy=0.31m,1m"})", R"({"n":1,"key_in":"xy=0.3m,1m"})");
  EXPECT_EQ(far.differing.size(), 1U);
}

TEST(CompareLines, NeverTakesCountsOrIdsForClose) {
  EXPECT_EQ(CompareLines(R"({"n":1,"ids":[4]})", R"({"n":1,"ids":[5]})").differing.size(), 1U);
  EXPECT_EQ(CompareLines(R"({"n":1,"ids":[4]})", R"({"n":1,"ids":[4,5]})").differing.size(), 1U);
  EXPECT_EQ(CompareLines(R"({"n":1})", R"({"n":1,"edit":{}})").differing.size(), 1U);
}

// Whatever a journal holds, reading and replaying it ends with a verdict.
RC_GTEST_PROP(Replay, OfADamagedJournalEndsWithAVerdict, ()) {
  std::string journal = JournalOf(kScript);
  const int damages = *rc::gen::inRange(1, 5);
  for (int i = 0; i < damages; ++i) {
    const auto at = *rc::gen::inRange<std::size_t>(0, journal.size());
    switch (*rc::gen::inRange(0, 3)) {
      case 0:
        journal[at] = *rc::gen::arbitrary<char>();
        break;
      case 1:
        journal.erase(at, *rc::gen::inRange<std::size_t>(1, 40));
        break;
      default:
        journal.insert(at, journal.substr(*rc::gen::inRange<std::size_t>(0, journal.size()), 30));
    }
  }
  const auto read = ReadJournal(journal);
  if (!read) {
    RC_ASSERT(!RenderText(read.error(), "x.journal").empty());
    return;
  }
  const ReplayReport report = Replay(*read);
  RC_ASSERT(report.verdict == ReplayReport::kEqual || !report.findings.empty());
}

std::vector<std::filesystem::path> ScriptsOfPairs() {
  std::vector<std::filesystem::path> out;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(TRANOS_SESSION_PAIRS)) {
    if (entry.path().extension() == ".trn") out.push_back(entry.path());
  }
  return out;
}

TEST(Replay, OfEveryScriptIsEqual) {
  for (const auto& path : ScriptsOfPairs()) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    EXPECT_EQ(ReplayOf(JournalOf(text.str())).verdict, ReplayReport::kEqual) << path;
  }
}

}  // namespace

}  // namespace tranos::session
