// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "tests/interp/front/tree_text.h"

namespace tranos::interp {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// "E0107@3:5" for each diagnostic.
std::vector<std::string> ErrorsIn(std::string text, const ParseLimits& limits = {}) {
  const Parsed parsed = ParseText(std::move(text), limits);
  std::vector<std::string> out;
  for (const Diagnostic& diagnostic : parsed.diagnostics.list()) {
    const auto place = parsed.sources.files[0].PlaceOf(diagnostic.span.begin);
    out.push_back(std::string(InfoOf(diagnostic.code).code) + "@" + std::to_string(place.line) +
                  ":" + std::to_string(place.column));
  }
  return out;
}

std::string HelpOf(std::string text) {
  const Parsed parsed = ParseText(std::move(text));
  return parsed.diagnostics.list().empty() ? "" : parsed.diagnostics.list()[0].help;
}

TEST(ParserErrors, EachMistakeIsReportedOnce) {
  EXPECT_THAT(ErrorsIn("let y = \nlet z = 3 4\nplace line\nlet a = b +\n"),
              ElementsAre("E0107@1:8", "E0107@2:11", "E0107@4:12"));
  EXPECT_THAT(ErrorsIn("let a 1\nlet b = )\nplace point 1,2\nlet c = 1\n"),
              ElementsAre("E0107@1:7", "E0107@2:9", "E0107@3:14"));
}

TEST(ParserErrors, TheRestOfTheFileIsRead) {
  const Parsed parsed = ParseText("let a 1\nplace line\n");
  EXPECT_EQ(TreeText(parsed), "(Script Error (Command place: line:))");
}

TEST(ParserErrors, BracketsThatAreNotClosed) {
  EXPECT_THAT(ErrorsIn("let a = (1 + 2\nlet b = 4\nlet c = 5 6\n"),
              ElementsAre("E0106@2:1", "E0107@3:11"));
  EXPECT_THAT(ErrorsIn("let c = [1,\n  2 3,\n  4]\nlet d = 5 6"),
              ElementsAre("E0107@2:5", "E0107@4:11"));
  EXPECT_THAT(ErrorsIn("for i = 0 to 3 {\n  place line\n"), ElementsAre("E0106@2:13"));
  EXPECT_THAT(ErrorsIn("if a { if b { {\n"), ElementsAre("E0106@1:16"));
  EXPECT_THAT(ErrorsIn("}\nlet a = 1 2"), ElementsAre("E0107@1:1", "E0107@2:11"));
}

TEST(ParserErrors, AFailedStatementKeepsItsBlockAndItsElse) {
  EXPECT_THAT(ErrorsIn("for i == 3 {\n  let a = 1 2\n} else if b { c } else { d }\nlet b = 1 2"),
              ElementsAre("E0107@1:7", "E0107@2:13", "E0107@4:11"));
  EXPECT_THAT(ErrorsIn("fro i = 0 to 3 { place line }\nlet a = 1"), ElementsAre("E0107@1:16"));
}

TEST(ParserErrors, AMistakeInAHeaderSpoilsItsLineOnly) {
  EXPECT_THAT(ErrorsIn("define place dome\n  bay length\n  span : length = )\n  r : length\n{\n"
                       "  let a = 1 2\n}\n"),
              ElementsAre("E0107@2:7", "E0107@3:19", "E0107@6:13"));
  EXPECT_THAT(ErrorsIn("define place x\n  in x\n{ }\n"), ElementsAre("E0111@2:3"));
  EXPECT_THAT(ErrorsIn("define\n  \"doc\"\n  r : length\n{ }\n"), ElementsAre("E0107@1:7"));
}

TEST(ParserErrors, ElseStandsOnTheLineOfTheBrace) {
  EXPECT_THAT(ErrorsIn("if a {\n}\nelse {\n}\nplace line"), ElementsAre("E0107@3:1"));
  EXPECT_THAT(ErrorsIn("if a\n{\n}\n"), ElementsAre("E0107@1:5"));
}

TEST(ParserErrors, BracketsMustTouch) {
  EXPECT_THAT(ErrorsIn("xy=f (1)"), ElementsAre("E0113@1:6"));
  EXPECT_THAT(ErrorsIn("let a = b [1]"), ElementsAre("E0113@1:11"));
}

TEST(ParserErrors, PerCentOrRemainder) {
  EXPECT_THAT(ErrorsIn("let a = 5%3\nlet b = 5% 3\n"), ElementsAre("E0114@1:10", "E0114@2:12"));
  EXPECT_THAT(HelpOf("n=5%3"), HasSubstr("5 % …"));
}

TEST(ParserErrors, ThereIsNoUnaryPlus) {
  EXPECT_THAT(ErrorsIn("lv=+1;co=3"), ElementsAre("E0109@1:4"));
  EXPECT_THAT(HelpOf("lv=+1"), HasSubstr("`lv=2`"));
  EXPECT_THAT(HelpOf("lv=3;{ lv=7 }\nlv=+1"), HasSubstr("`lv=4`"));
  EXPECT_THAT(HelpOf("height=+4m"), HasSubstr("`height=4m`"));
  EXPECT_THAT(HelpOf("let a = +4"), HasSubstr("`4`"));
}

TEST(ParserErrors, ComparisonsAndRangesDoNotChain) {
  EXPECT_THAT(ErrorsIn("let a = 1 < b < 3"), ElementsAre("E0110@1:15"));
  EXPECT_THAT(ErrorsIn("let a = 1..2..3"), ElementsAre("E0107@1:13"));
}

TEST(ParserErrors, KeywordsAreNoNames) {
  EXPECT_THAT(ErrorsIn("let for = 3\nplace line as if\nlet a = unit\n"),
              ElementsAre("E0111@1:5", "E0111@2:15", "E0111@3:9"));
}

TEST(ParserErrors, PlainStrings) {
  EXPECT_THAT(ErrorsIn("use \"a{x}\""), ElementsAre("E0112@1:7"));
  EXPECT_THAT(ErrorsIn("parameter a : length \"{x}\""), ElementsAre("E0112@1:23"));
}

TEST(ParserErrors, Numbers) {
  EXPECT_THAT(ErrorsIn("let a = 3.\nlet b = .5\nlet c = \"{a:x}\"\nlet d = \"{a:99}\""),
              ElementsAre("E0105@1:10", "E0105@2:9", "E0107@3:13", "E0105@4:13"));
}

TEST(ParserErrors, ABadWordSilencesItsStatementOnly) {
  EXPECT_THAT(ErrorsIn("let a = b & c\nlet d = \"abc {x\"\nlet e = 'f'\nlet g = 1 2"),
              ElementsAre("E0102@1:11", "E0103@2:14", "E0102@3:9", "E0102@3:11", "E0107@4:11"));
}

TEST(ParserErrors, NotUtf8) { EXPECT_THAT(ErrorsIn("a\n\xff"), ElementsAre("E0101@2:1")); }

TEST(ParserErrors, AnInterfaceTakesKeysOnly) {
  EXPECT_THAT(ErrorsIn("interface crown at=[0,0] foo"), ElementsAre("E0107@1:26"));
}

std::string Repeat(std::string_view text, int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += text;
  return out;
}

TEST(ParserErrors, DepthIsBounded) {
  constexpr int kMany = 100000;
  for (const std::string_view part :
       {"(", "-", "not ", "[", "2^", "if a then ", "x => ", "\"{", "f(", "xs[", "1 + (", "-(2^"}) {
    const std::string text = "let x = " + Repeat(part, kMany) + "1\nlet y = 2\n";
    const auto errors = ErrorsIn(text);
    const bool is_string = part == "\"{";
    ASSERT_EQ(errors.size(), 1u) << part;
    EXPECT_TRUE(errors[0].starts_with(is_string ? "E0103" : "E0108")) << part << errors[0];
  }
  EXPECT_THAT(ErrorsIn("let x = " + Repeat("\"{", kMany) + "1" + Repeat("}\"", kMany)),
              ElementsAre("E0108@1:410"));
  EXPECT_THAT(ErrorsIn(Repeat("{", kMany)), ElementsAre("E0108@1:201"));
  EXPECT_THAT(ErrorsIn(Repeat("{", kMany) + Repeat("}", kMany) + "\nlet a = 1 2"),
              ElementsAre("E0108@1:201", "E0107@2:11"));
  EXPECT_THAT(ErrorsIn(Repeat("if a {", kMany)), ElementsAre("E0108@1:1206"));
}

TEST(ParserErrors, DepthIsTheUsersToRaise) {
  const auto nested = [](int count) {
    return "let x = " + Repeat("(", count) + "1" + Repeat(")", count);
  };
  EXPECT_THAT(ErrorsIn(nested(200)), IsEmpty());
  EXPECT_THAT(ErrorsIn(nested(201)), ElementsAre("E0108@1:209"));
  EXPECT_THAT(ErrorsIn(nested(1000), {1000}), IsEmpty());
  EXPECT_EQ(ErrorsIn(nested(100000), {1000000}).size(), 1u);
  // The deepest recursion that one level can cost.
  const std::string level = "1 or 1 and not 1 == 1..1 + 1*-2^(";
  EXPECT_EQ(ErrorsIn("let x = " + Repeat(level, 100000), {1000000}).size(), 1u);
}

TEST(ParserErrors, ABigFileWithAnOpenBraceIsQuick) {
  const std::string text = Repeat("place point xy=1,2,3\n", 50000) + "for i = 0 to 3 {\n";
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(ErrorsIn(text), ElementsAre("E0106@50001:17"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

TEST(ParserErrors, OnlyTheFirstHundredAreKept) {
  const Parsed parsed = ParseText(Repeat("let a = 1 2\n", 1000));
  EXPECT_EQ(parsed.diagnostics.error_count(), 1000u);
  EXPECT_EQ(parsed.diagnostics.list().size(), 100u);
}

}  // namespace
}  // namespace tranos::interp
