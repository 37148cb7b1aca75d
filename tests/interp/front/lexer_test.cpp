// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/lexer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace tranos::interp {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> Words(std::string text, Diagnostics* diagnostics) {
  const SourceText source = MakeSource("a.trn", std::move(text));
  std::vector<std::string> out;
  for (const Token& token : Lex(source, 0, diagnostics).tokens) {
    if (token.kind == TokenKind::kEnd) break;
    out.push_back(source.text.substr(token.begin, token.end - token.begin));
  }
  return out;
}

std::vector<std::string> Words(std::string text) {
  Diagnostics diagnostics;
  auto out = Words(std::move(text), &diagnostics);
  EXPECT_FALSE(diagnostics.has_errors());
  return out;
}

std::vector<Code> CodesOf(std::string text) {
  Diagnostics diagnostics;
  Words(std::move(text), &diagnostics);
  std::vector<Code> out;
  for (const Diagnostic& diagnostic : diagnostics.list()) out.push_back(diagnostic.code);
  return out;
}

TEST(Lexer, ARangeBetweenNumbersIsNoFraction) {
  EXPECT_THAT(Words("1..5"), ElementsAre("1", "..", "5"));
  EXPECT_THAT(Words("0.5..1.5m"), ElementsAre("0.5", "..", "1.5m"));
  EXPECT_THAT(Words("a..b"), ElementsAre("a", "..", "b"));
}

TEST(Lexer, UnitsTouchTheirNumbers) {
  EXPECT_THAT(Words("35.5m 5m2 30deg 12ft"), ElementsAre("35.5m", "5m2", "30deg", "12ft"));
  EXPECT_THAT(Words("2 m"), ElementsAre("2", "m"));
  EXPECT_THAT(Words("2πήχεις"), ElementsAre("2πήχεις"));
}

TEST(Lexer, AnExponentNeedsDigits) {
  EXPECT_THAT(Words("1e3m"), ElementsAre("1e3m"));
  EXPECT_THAT(Words("1E-3"), ElementsAre("1E-3"));
  EXPECT_THAT(Words("2e"), ElementsAre("2e"));
  EXPECT_THAT(Words("2e-x"), ElementsAre("2e", "-", "x"));
}

TEST(Lexer, PerCentTouchesItsNumber) {
  EXPECT_THAT(Words("2% 5 % 3 x%3"), ElementsAre("2%", "5", "%", "3", "x", "%", "3"));
  EXPECT_THAT(Words("5m%3"), ElementsAre("5m", "%", "3"));
  EXPECT_THAT(CodesOf("5%3"), ElementsAre(Code::kPercentOrRemainder));
  EXPECT_THAT(CodesOf("5%(3)"), ElementsAre(Code::kPercentOrRemainder));
}

TEST(Lexer, OperatorsAreTakenLongest) {
  EXPECT_THAT(Words("a==b!=c<=d>=e=>f+-g"),
              ElementsAre("a", "==", "b", "!=", "c", "<=", "d", ">=", "e", "=>", "f", "+-", "g"));
}

TEST(Lexer, KeywordsInAnyCase) {
  EXPECT_EQ(KeywordOf("let"), Keyword::kLet);
  EXPECT_EQ(KeywordOf("Hypothesis"), Keyword::kHypothesis);
  EXPECT_EQ(KeywordOf("CONSISTENT"), Keyword::kConsistent);
  EXPECT_EQ(KeywordOf("lets"), Keyword::kNone);
  EXPECT_EQ(KeywordOf("to"), Keyword::kNone);
}

TEST(Lexer, WordsOfAnyScriptAndCombiningAccents) {
  EXPECT_THAT(Words("日本 Ναός e\xcc\x81t\xc3\xa9"),
              ElementsAre("日本", "Ναός", "e\xcc\x81t\xc3\xa9"));
  EXPECT_EQ(NormalWord("e\xcc\x81"), "\xc3\xa9");
  EXPECT_EQ(NormalWord("plain"), "plain");
}

TEST(Lexer, StringsHoldValuesAndStringsInThem) {
  EXPECT_THAT(Words(R"("a {x:2} }} {{")"),
              ElementsAre("\"", "a ", "{", "x", ":", "2", "}", " }} {{", "\""));
  EXPECT_THAT(Words(R"("{f("b")}")"),
              ElementsAre("\"", "{", "f", "(", "\"", "b", "\"", ")", "}", "\""));
  EXPECT_THAT(Words("\"#1a2b3c\" # gone"), ElementsAre("\"", "#1a2b3c", "\""));
}

TEST(Lexer, CommentsEndBeforeTheLineDoes) {
  Diagnostics diagnostics;
  const SourceText source = MakeSource("a.trn", "a # one\r\n# two");
  const Lexed lexed = Lex(source, 0, &diagnostics);
  ASSERT_EQ(lexed.comments.size(), 2u);
  EXPECT_EQ(source.text.substr(lexed.comments[0].begin, 5), "# one");
  EXPECT_EQ(lexed.comments[0].end, 7u);
  EXPECT_EQ(lexed.tokens.size(), 3u);  // a, the newline, the end
}

TEST(Lexer, RefusesWhatCannotBeSeen) {
  EXPECT_THAT(CodesOf(std::string("a\0b", 3)), ElementsAre(Code::kStrayCharacter));
  EXPECT_THAT(CodesOf("a\fb"), ElementsAre(Code::kStrayCharacter));
  EXPECT_THAT(CodesOf("\"a\x1b[31m\""), ElementsAre(Code::kStrayCharacter));
  EXPECT_THAT(CodesOf("# \xe2\x80\xae"), ElementsAre(Code::kStrayCharacter));
  EXPECT_THAT(CodesOf("a\rb"), ElementsAre(Code::kStrayCharacter));
  EXPECT_THAT(CodesOf("\xef\xbb\xbfplace line\r\n"), ElementsAre());
}

TEST(Lexer, ReportsEachMistakeInAString) {
  EXPECT_THAT(CodesOf("\"abc"), ElementsAre(Code::kUnclosedString));
  EXPECT_THAT(CodesOf("\"abc {x\nlet"), ElementsAre(Code::kUnclosedString));
  EXPECT_THAT(CodesOf(R"("a\q")"), ElementsAre(Code::kBadEscape));
  EXPECT_THAT(CodesOf(R"("a } b")"), ElementsAre(Code::kBadEscape));
  EXPECT_THAT(CodesOf(R"("{a;b}")"), ElementsAre(Code::kStrayCharacter));
}

TEST(Lexer, NumbersAndTheirUnits) {
  EXPECT_EQ(NumberOf("35.5m").value, 35.5);
  EXPECT_EQ(NumberOf("35.5m").unit, "m");
  EXPECT_EQ(NumberOf("2%").unit, "%");
  EXPECT_EQ(NumberOf("2e").value, 2);
  EXPECT_EQ(NumberOf("2e").unit, "e");
  EXPECT_EQ(NumberOf("1e3m").value, 1000);
  EXPECT_EQ(NumberOf("1e-999").value, 0);
  EXPECT_TRUE(std::isinf(NumberOf("1e999").value));
  EXPECT_THAT(CodesOf("1e999"), ElementsAre(Code::kBadNumber));
  EXPECT_THAT(CodesOf("1e-999"), ElementsAre());
}

TEST(Lexer, ResolvesEscapes) {
  EXPECT_EQ(UnescapeStringText(R"(a\"b\\c\n{{d}})"), "a\"b\\c\n{d}");
  EXPECT_EQ(UnescapeStringText(""), "");
}

}  // namespace
}  // namespace tranos::interp
