// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/statement_match.h"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "interp/source.h"

namespace tranos::session {

namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

StatementTree TreeOf(const std::string& text) {
  interp::Sources sources;
  sources.files.push_back(interp::MakeSource("test.trn", text));
  return MakeStatementTree(sources, 200);
}

std::size_t Length(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b) {
  std::vector<std::size_t> row(b.size() + 1, 0);
  for (const std::uint64_t x : a) {
    std::size_t diagonal = 0;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t above = row[j + 1];
      row[j + 1] = x == b[j] ? diagonal + 1 : std::max(above, row[j]);
      diagonal = above;
    }
  }
  return row.back();
}

RC_GTEST_PROP(CommonSubsequence, IsCommonAscendingAndAsLongAsPossible, ()) {
  const auto letters =
      rc::gen::container<std::vector<std::uint64_t>>(rc::gen::inRange<std::uint64_t>(0, 5));
  const auto a = *letters, b = *letters;
  const Pairs pairs = CommonSubsequence(a, b);
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    RC_ASSERT(a[pairs[n].first] == b[pairs[n].second]);
    if (n > 0)
      RC_ASSERT(pairs[n].first > pairs[n - 1].first && pairs[n].second > pairs[n - 1].second);
  }
  RC_ASSERT(pairs.size() == Length(a, b));
}

TEST(CommonSubsequence, OfLongSequencesStaysUsable) {
  std::vector<std::uint64_t> a(50000), b;
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = i;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (i % 7 != 0) b.push_back(i);
    if (i % 11 == 0) b.push_back(1000000 + i);
  }
  EXPECT_EQ(CommonSubsequence(a, b).size(), 50000U - 7143U);
}

TEST(StatementTree, IsTheSameInAnyLayout) {
  const auto one = TreeOf("place line xy=0,0 dl=10\nfor i = 1 to 3 { place point xy=i,0 }");
  const auto other = TreeOf(
      "# plan\nPLACE LINE; xy = 0, 0\n dl=10 # sill\nfor i = 1 to 3 {\n\n place point\n "
      "xy=i,0\n}\n");
  EXPECT_EQ(one.statements[0].hash, other.statements[0].hash);
}

TEST(StatementTree, TellsOrderAndCaseOfNames) {
  EXPECT_NE(TreeOf("let a = 1\nlet b = 2").statements[0].hash,
            TreeOf("let b = 2\nlet a = 1").statements[0].hash);
  EXPECT_NE(TreeOf("let a = 1").statements[0].hash, TreeOf("let A = 1").statements[0].hash);
}

TEST(StatementTree, FindsTheCommandThatAKeyInAnswers) {
  const std::string text = "place line\nxy=0,0\nco=3\ndl=10";
  const auto tree = TreeOf(text);
  const std::uint32_t command = tree.At(0);
  EXPECT_EQ(tree.statements[command].kind, Statement::kCommand);
  EXPECT_EQ(tree.At(11), command);
  EXPECT_EQ(tree.statements[tree.At(18)].kind, Statement::kSetting);
  EXPECT_EQ(tree.At(23), command);
}

TEST(StatementTree, KnowsTheLoopsAround) {
  const std::string text = "for i = 1 to 2 { for j = 1 to 2 { place point xy=i,j } }";
  const auto tree = TreeOf(text);
  const std::uint32_t point = tree.At(static_cast<std::uint32_t>(text.find("place")));
  EXPECT_EQ(tree.statements[point].loops, 2U);
  EXPECT_EQ(tree.LoopsAround(point).size(), 2U);
}

// Which statement of b the one that begins with `text` in a is matched with, by its beginning.
std::string Counterpart(const std::string& a, const std::string& b, const std::string& text) {
  const StatementTree x = TreeOf(a), y = TreeOf(b);
  const auto match = MatchStatements(x, y);
  const std::uint32_t j = match.b_of_a[x.At(static_cast<std::uint32_t>(a.find(text)))];
  return j == kNoStatement
             ? "none"
             : b.substr(y.statements[j].begin, y.statements[j].end - y.statements[j].begin);
}

TEST(MatchStatements, FollowsWhatIsMoved) {
  EXPECT_EQ(Counterpart("place point xy=1,1\nplace circle xy=0,0 xy=1,0",
                        "place circle xy=0,0 xy=1,0\nplace point xy=1,1", "place point"),
            "place point xy=1,1");
}

TEST(MatchStatements, FollowsWhatIsWrapped) {
  EXPECT_EQ(
      Counterpart("place point xy=1,1", "if 1 < 2 { group { place point xy=1,1 } }", "place point"),
      "place point xy=1,1");
}

TEST(MatchStatements, FollowsWhatIsChangedBetweenItsNeighbours) {
  EXPECT_EQ(Counterpart("co=1\nplace circle radius=1 xy=0,0\nlv=2",
                        "co=1\nplace circle radius=2 xy=0,0\nlv=2", "place circle"),
            "place circle radius=2 xy=0,0");
  EXPECT_EQ(Counterpart("place circle radius=1 xy=0,0", "place arc xy=0,0", "place circle"),
            "none");
}

TEST(MatchStatements, MatchesBlocksWithWhatIsInThem) {
  EXPECT_EQ(Counterpart("for i = 1 to 3 { place point xy=i,0; place circle xy=0,0 xy=i,0 }",
                        "for i = 1 to 9 { place point xy=i,0; place circle xy=0,1 xy=i,0 }",
                        "place circle"),
            "place circle xy=0,1 xy=i,0");
}

}  // namespace

}  // namespace tranos::session
