// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "runs.h"
#include "session/journal_reader.h"

namespace tranos::session {

namespace {

using Json = nlohmann::json;

std::vector<Json> LinesOf(const std::string& journal) {
  std::vector<Json> lines;
  std::istringstream in(journal);
  for (std::string line; std::getline(in, line);) lines.push_back(Json::parse(line));
  return lines;
}

constexpr const char* kScript =
    "place line xy=0,0 dl=10 as sill\nco=3\nplace circle radius=2 xy=1,1\n";

TEST(Journal, BeginsWithWhatTheRunWasStartedFrom) {
  RunSettings settings;
  settings.parameters = {{"height", "14m"}};
  const auto lines =
      LinesOf(JournalOf("parameter height : length = 12m\nplace point xy=0,height", settings));
  EXPECT_EQ(lines[0]["tranos_journal"], kJournalVersion);
  EXPECT_EQ(lines[0]["program"], "1.2.3");
  EXPECT_EQ(lines[0]["parameters"][0], Json({"height", "14m"}));
  EXPECT_EQ(lines[0]["limits"]["elements"], 1000000);
  EXPECT_EQ(lines[0]["sources"][0]["path"], "test.trn");
  EXPECT_EQ(lines[0]["sources"][0]["text"],
            "parameter height : length = 12m\nplace point xy=0,height");
}

TEST(Journal, HasALineForEachKeyInWithItsPlaceAndHashes) {
  const auto lines = LinesOf(JournalOf(kScript));
  ASSERT_EQ(lines.size(), 10U);
  EXPECT_EQ(lines[3]["key_in"], "dl=10m");
  EXPECT_EQ(lines[3]["line"], 1);
  EXPECT_EQ(lines[3]["column"], 19);
  EXPECT_EQ(lines[3]["begin"], 18);
  const Json& added = lines[3]["edit"]["added"][0];
  EXPECT_EQ(added["type"], "line");
  EXPECT_EQ(added["geometry"]["end"], Json({10.0, 0.0, 0.0}));
  EXPECT_EQ(lines[3]["ids"], Json::array({0}));
  EXPECT_EQ(lines[4]["key_in"], "as sill");
  EXPECT_EQ(lines[4]["edit"]["replaced"][0]["name"], "sill");
  EXPECT_NE(lines[3]["model"], lines[4]["model"]);
  EXPECT_EQ(lines[4]["model"], lines[5]["model"]);  // a setting changes the state alone
  EXPECT_NE(lines[4]["state"], lines[5]["state"]);
  EXPECT_EQ(lines[8]["edit"]["added"][0]["attributes"]["co"], "3");
}

TEST(Journal, EndsWithTheModelOfTheRun) {
  const auto lines = LinesOf(JournalOf(kScript));
  EXPECT_EQ(lines.back()["end"], "ran");
  EXPECT_EQ(lines.back()["steps"], 8);
  EXPECT_EQ(lines.back()["elements"], 2);
  EXPECT_EQ(lines.back()["model"],
            model::Hex(RecordOf("test.trn", kScript).result.outcome.state.model.hash));
}

TEST(Journal, HoldsTheFilesThatWereUsedAndTheirHash) {
  const std::string script = "use \"lib.trn\"\nplace point xy=bay,0";
  const auto one = LinesOf(JournalOf(script, {}, {{"lib.trn", "let bay = 3m"}}));
  const auto other = LinesOf(JournalOf(script, {}, {{"lib.trn", "let bay = 4m"}}));
  EXPECT_EQ(one[0]["sources"][1]["path"], "lib.trn");
  EXPECT_EQ(one[0]["sources"][1]["text"], "let bay = 3m");
  EXPECT_NE(one[0]["library"], other[0]["library"]);
}

TEST(Journal, CountsColumnsInCharactersAlsoAlongOneLine) {
  const auto lines =
      LinesOf(JournalOf("place text \"Grüße\" xy=0,0; place point xy=1,0\nplace point xy=2,0"));
  for (const Json& line : lines) {
    if (line.value("key_in", "") == "xy=1m,0m") {
      EXPECT_EQ(line["column"], 40);
    }
    if (line.value("key_in", "") == "xy=2m,0m") {
      EXPECT_EQ(line["line"], 2);
    }
  }
}

TEST(Journal, EscapesWhateverATextHolds) {
  const std::string text = "tab\there, \xC3\xA9, \xF0\x9F\x8F\x9B";
  const auto lines = LinesOf(JournalOf("# \x01\x1f\x7f\nplace text \"" + text + "\" xy=0,0"));
  EXPECT_EQ(lines[0]["sources"][0]["text"], "# \x01\x1f\x7f\nplace text \"" + text + "\" xy=0,0");
  JsonText out;
  out.String("bad \xC0\x80 \xED\xA0\x80 \xF5 \"\\");
  EXPECT_TRUE(Json::accept(out.text()));
}

TEST(Journal, IsTheSameInWhateverPiecesItIsWritten) {
  EXPECT_EQ(JournalOf(kScript, {}, {}, 1), JournalOf(kScript));
}

TEST(Journal, OfAnEmptyScriptHasABeginningAndAnEnd) {
  const auto lines = LinesOf(JournalOf(""));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[1]["steps"], 0);
}

TEST(Journal, WritesThePartsOfADefinitionOnce) {
  const auto lines = LinesOf(
      JournalOf("define place gate { place block xy=0,0 xy=1,1 }\nplace gate xy=0,0 xy=5,0"));
  std::size_t with_parts = 0, placed = 0;
  for (const Json& line : lines) {
    if (!line.contains("edit") || !line["edit"].contains("added")) continue;
    ++placed;
    if (line["edit"]["added"][0]["geometry"].contains("parts")) ++with_parts;
  }
  EXPECT_EQ(placed, 2U);
  EXPECT_EQ(with_parts, 1U);
}

TEST(ReadJournal, TakesWhatTheWriterGives) {
  RunSettings settings;
  settings.hypothesis = "high";
  settings.limits.depth = 77;
  const std::string text = JournalOf(
      "hypothesis low { place point xy=0,0 }\nhypothesis high { place point xy=1,0 }", settings);
  const auto journal = ReadJournal(text);
  ASSERT_TRUE(journal.has_value());
  EXPECT_EQ(journal->settings.hypothesis, "high");
  EXPECT_EQ(journal->settings.limits.depth, 77);
  EXPECT_EQ(journal->program, "1.2.3");
}

interp::Code CodeOf(const std::string& text) {
  const auto journal = ReadJournal(text);
  return journal ? interp::Code::kNotYet : journal.error().code;
}

TEST(ReadJournal, RefusesWhatIsNoJournal) {
  EXPECT_EQ(CodeOf(""), interp::Code::kNotAJournal);
  EXPECT_EQ(CodeOf("place line xy=0,0"), interp::Code::kNotAJournal);
  EXPECT_EQ(CodeOf("{}"), interp::Code::kNotAJournal);
  EXPECT_EQ(CodeOf(std::string(100000, '[')), interp::Code::kNotAJournal);
}

TEST(ReadJournal, RefusesAnotherVersion) {
  std::string text = JournalOf(kScript);
  text.replace(text.find(":1,"), 3, ":2,");
  EXPECT_EQ(CodeOf(text), interp::Code::kJournalVersion);
  EXPECT_EQ(CodeOf("{\"tranos_journal\":\"1\"}\n"), interp::Code::kBrokenJournal);
}

TEST(ReadJournal, RefusesEveryBeginningOfAJournal) {
  const std::string text = JournalOf(kScript);
  for (std::size_t length = 0; length < text.size(); ++length) {
    const auto journal = ReadJournal(std::string_view(text).substr(0, length));
    ASSERT_FALSE(journal.has_value()) << length;
    EXPECT_GE(journal.error().line, 1U);
  }
}

TEST(ReadJournal, RefusesASourceThatIsNotWhatItsHashSays) {
  std::string text = JournalOf(kScript);
  text.replace(text.find("dl=10 as"), 5, "dl=11");
  EXPECT_EQ(CodeOf(text), interp::Code::kBrokenJournal);
}

TEST(ReadJournal, RefusesAHeaderWithMembersOfOtherTypes) {
  const std::string text = JournalOf(kScript);
  const std::size_t end = text.find('\n');
  const Json header = Json::parse(text.substr(0, end));
  for (const auto& [key, value] : header.items()) {
    if (key == "library") continue;  // told, and not read
    for (const Json& wrong :
         {Json(-1), Json(nullptr), Json("x"), Json::array({1}), Json::object()}) {
      if (wrong.type() == value.type()) continue;
      Json changed = header;
      changed[key] = wrong;
      EXPECT_FALSE(ReadJournal(changed.dump() + text.substr(end)).has_value()) << key << wrong;
    }
  }
}

TEST(ReadJournal, RefusesADepthThatTheStackMightNotHold) {
  RunSettings settings;
  settings.limits.depth = 1000;
  EXPECT_TRUE(ReadJournal(JournalOf(kScript, settings)).has_value());
  settings.limits.depth = 1001;
  EXPECT_EQ(CodeOf(JournalOf(kScript, settings)), interp::Code::kBrokenJournal);
}

TEST(ReadJournal, RendersWhatIsWrongWithTheJournalsLine) {
  const auto journal = ReadJournal("no journal");
  ASSERT_FALSE(journal.has_value());
  EXPECT_EQ(RenderText(journal.error(), "a\nb"),
            "error[E0801]: the file is no journal\n  --> a\\u{a}b:1\n");
}

}  // namespace

}  // namespace tranos::session
