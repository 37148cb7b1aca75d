// SPDX-License-Identifier: GPL-3.0-or-later
// What every row of the table must have. Rows that are carried out need both kinds of examples.
#include <gtest/gtest.h>

#include <set>

#include "interp/command.h"

namespace tranos::interp {
namespace {

bool IsCode(std::string_view expect) { return FindCode(expect).has_value(); }
bool IsCarriedOut(const Command& row) { return row.exists(); }

TEST(Row, WordsAreUniqueLowerCaseAndFound) {
  std::set<std::string_view> seen;
  for (const Command& row : AllCommands()) {
    EXPECT_TRUE(seen.insert(row.words).second) << row.words;
    EXPECT_EQ(row.words.find_first_not_of("abcdefghijklmnopqrstuvwxyz "), std::string_view::npos)
        << row.words;
    EXPECT_EQ(FindCommand(row.words), &row);
  }
  EXPECT_EQ(FindCommand("place lin"), nullptr);
  EXPECT_EQ(FindCommand("place line "), nullptr);
  EXPECT_EQ(FindCommand(""), nullptr);
}

TEST(Row, FamiliesAreNotSplit) {
  std::set<std::string_view> closed;
  std::string_view family;
  for (const Command& row : AllCommands()) {
    EXPECT_FALSE(row.family.empty()) << row.words;
    if (row.family == family) continue;
    EXPECT_TRUE(closed.insert(row.family).second) << row.words;
    family = row.family;
  }
}

TEST(Row, SummariesAreSentences) {
  for (const Command& row : AllCommands()) {
    ASSERT_FALSE(row.summary.empty()) << row.words;
    EXPECT_EQ(row.summary.back(), '.') << row.words;
    EXPECT_GE(row.summary.front(), 'A') << row.words;
    EXPECT_LE(row.summary.front(), 'Z') << row.words;
  }
}

TEST(Row, ExamplesPassAndFail) {
  for (const Command& row : AllCommands()) {
    int passing = 0, failing = 0;
    for (const Example& example : row.examples) {
      ++(IsCode(example.expect) ? failing : passing);
      EXPECT_NE(example.script.find(row.words), std::string_view::npos) << row.words;
    }
    EXPECT_GE(failing, 1) << row.words;
    EXPECT_EQ(passing > 0, IsCarriedOut(row)) << row.words;
  }
}

TEST(Row, KeysAreDeclaredSoundly) {
  for (const Command& row : AllCommands()) {
    std::set<std::string_view> names;
    for (const Key& key : row.keys) {
      EXPECT_TRUE(names.insert(key.name).second) << row.words << " " << key.name;
      EXPECT_FALSE(key.summary.empty()) << row.words << " " << key.name;
      EXPECT_LT(key.prompt, static_cast<int>(row.prompts.size())) << row.words;
      // A closed list of words, or a few that say a number or a place.
      const bool counts = key.type == Type::kCount || key.type == Type::kNumber ||
                          (key.type == Type::kAny && !key.words.empty());
      EXPECT_TRUE(counts || (key.type == Type::kWord) == !key.words.empty())
          << row.words << " " << key.name;
    }
    EXPECT_TRUE(row.string_key.empty() || names.contains(row.string_key)) << row.words;
  }
}

TEST(Row, EveryKeyStandsInAnExample) {
  for (const Command& row : AllCommands()) {
    for (const Key& key : row.keys) {
      if (key.name == "of" || key.name == "keep" || key.name == row.string_key) continue;
      const std::string written = " " + std::string(key.name) + "=";
      bool found = false;
      for (const Example& example : row.examples) {
        found = found || example.script.find(written) != std::string_view::npos;
      }
      EXPECT_TRUE(found) << row.words << " " << key.name;
    }
  }
}

TEST(Row, PromptsFitTheManner) {
  for (const Command& row : AllCommands()) {
    const bool asks = !row.prompts.empty();
    switch (row.manner) {
      case Manner::kImmediate:
        EXPECT_FALSE(asks) << row.words;
        break;
      case Manner::kTransforms:
        break;
      default:
        EXPECT_TRUE(asks) << row.words;
    }
    EXPECT_GE(row.again, 0) << row.words;
    EXPECT_LE(row.again, static_cast<int>(row.prompts.size())) << row.words;
    EXPECT_LE(row.least, row.most) << row.words;
    if (row.manner == Manner::kTransforms || row.manner == Manner::kPicks ||
        row.manner == Manner::kEdits) {
      ASSERT_FALSE(row.keys.empty()) << row.words;
      EXPECT_EQ(row.keys[0].name, "of") << row.words;
      EXPECT_EQ(row.keys[0].type, Type::kElements) << row.words;
    }
  }
}

TEST(Row, LaterCommandsAreKnown) {
  for (const std::string_view words :
       {"place dimension", "attach drawing", "highlight", "plot"}) {
    const Command* row = FindCommand(words);
    ASSERT_NE(row, nullptr) << words;
    EXPECT_FALSE(IsCarriedOut(*row)) << words;
  }
}

TEST(Words, AreFoundWithoutRegardToCase) {
  EXPECT_TRUE(HasWord("top|front|right", "FRONT"));
  EXPECT_FALSE(HasWord("top|front|right", "fron"));
  EXPECT_FALSE(HasWord("top|front|right", ""));
  EXPECT_FALSE(HasWord("", "top"));
  EXPECT_EQ(SplitWords("a|bc|d"), (std::vector<std::string>{"a", "bc", "d"}));
  EXPECT_TRUE(SplitWords("").empty());
}

TEST(TypeNames, GoBothWays) {
  for (const std::string& name : TypeNames()) {
    const auto type = TypeNamed(name);
    ASSERT_TRUE(type.has_value()) << name;
    EXPECT_FALSE(Describe(*type).empty()) << name;
  }
  EXPECT_FALSE(TypeNamed("label").has_value());
  EXPECT_FALSE(TypeNamed("").has_value());
}

}  // namespace
}  // namespace tranos::interp
