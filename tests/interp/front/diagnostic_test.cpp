// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/diagnostic.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

namespace tranos::interp {
namespace {

using ::testing::HasSubstr;

Sources OneFile(std::string text) {
  Sources sources;
  sources.files.push_back(MakeSource("church.trn", std::move(text)));
  return sources;
}

// A diagnostic about the first occurrence of `what`.
Diagnostic About(const Sources& sources, std::string_view what) {
  const auto begin = static_cast<std::uint32_t>(sources.files[0].text.find(what));
  const auto end = begin + static_cast<std::uint32_t>(what.size());
  return {Code::kUnexpectedToken, {0, begin, end}, "message", "label", ""};
}

// The line with the carets.
std::string Carets(const Sources& sources, std::string_view what) {
  const std::string text = RenderText(About(sources, what), sources, false);
  const std::size_t end = text.rfind(" label");
  const std::size_t begin = text.rfind('\n', end) + 1;
  return text.substr(begin, end - begin);
}

TEST(Diagnostic, TheLayoutOfTheLanguageManual) {
  std::string text(13, '\n');
  text += "place dome onion rise=30deg xy=0,0,0\n";
  const Sources sources = OneFile(text);
  Diagnostic diagnostic = About(sources, "30deg");
  diagnostic.message = "`rise` is a length, but 30deg is an angle";
  diagnostic.label = "expected a length such as 4.5m";
  diagnostic.help = "tranos help place dome onion";
  EXPECT_EQ(RenderText(diagnostic, sources, false),
            "error[E0107]: `rise` is a length, but 30deg is an angle\n"
            "  --> church.trn:14:23\n"
            "   |\n"
            "14 | place dome onion rise=30deg xy=0,0,0\n"
            "   |                       ^^^^^ expected a length such as 4.5m\n"
            "   = help: tranos help place dome onion\n");
}

TEST(Diagnostic, NotesAreFurtherSnippets) {
  const Sources sources = OneFile("{\na\n");
  Diagnostic diagnostic = About(sources, "a");
  diagnostic.notes.push_back({{0, 0, 1}, "opened here"});
  EXPECT_THAT(RenderText(diagnostic, sources, false),
              HasSubstr("note: opened here\n --> church.trn:1:1\n  |\n1 | {\n  | ^\n"));
}

TEST(Diagnostic, CaretsStandBelowWideAndCombiningCharacters) {
  EXPECT_EQ(Carets(OneFile("let 日本 = x"), "x"), "  |            ^");
  EXPECT_EQ(Carets(OneFile("let 日本 = x"), "日本"), "  |     ^^^^");
  EXPECT_EQ(Carets(OneFile("e\xcc\x81 x"), "x"), "  |   ^");
  EXPECT_EQ(Carets(OneFile("\tx"), "x"), "  |     ^");
}

TEST(Diagnostic, ASpanOfSeveralLinesIsUnderlinedOnItsFirst) {
  EXPECT_EQ(Carets(OneFile("ab [1,\n2]"), "[1,\n2]"), "  |    ^^^");
  EXPECT_EQ(Carets(OneFile("ab"), ""), "  | ^");
}

TEST(Diagnostic, ALongLineIsShownAroundTheMistake) {
  const Sources sources = OneFile(std::string(500000, 'a') + "X" + std::string(500000, 'b'));
  const std::string text = RenderText(About(sources, "X"), sources, false);
  EXPECT_LT(text.size(), 600u);
  EXPECT_THAT(text, HasSubstr("…"));
  const std::size_t line = text.find("1 | …") + 4;
  const std::size_t carets = text.find("  | ", line) + 4;
  // The ellipsis takes three bytes and one column.
  EXPECT_EQ(text.find('X', line) - line - 2, text.find('^', carets) - carets);
}

TEST(Diagnostic, ControlCharactersAreEscaped) {
  EXPECT_EQ(Printable("a\x1b[31m\n\xff\xe2\x80\xae"), "a\\u{1b}[31m\\u{a}\\xff\\u{202e}");
  const Sources sources = OneFile("a \x1b x");
  EXPECT_EQ(Carets(sources, "x"), "  |          ^");
  EXPECT_EQ(RenderText(About(sources, "x"), sources, false).find('\x1b'), std::string::npos);
}

TEST(Diagnostic, ColourOnlyOnRequest) {
  const Sources sources = OneFile("x");
  EXPECT_THAT(RenderText(About(sources, "x"), sources, true), HasSubstr("\x1b[1;31m"));
}

TEST(Diagnostic, WithoutASourceThereIsNoSnippet) {
  const Diagnostic diagnostic{Code::kNotUtf8, {7, 1, 2}, "m", "l", "h"};
  EXPECT_EQ(RenderText(diagnostic, Sources{}, false), "error[E0101]: m\n  = help: h\n");
}

TEST(Diagnostic, Json) {
  const Sources sources = OneFile("a\n  日x\xff\n");
  Diagnostic diagnostic = About(sources, "x");
  diagnostic.message = "bad \xff byte";
  diagnostic.notes.push_back({{0, 0, 1}, "here"});
  const auto json = nlohmann::json::parse(RenderJson(diagnostic, sources));
  EXPECT_EQ(json["severity"], "error");
  EXPECT_EQ(json["code"], "E0107");
  EXPECT_EQ(json["path"], "church.trn");
  EXPECT_EQ(json["line"], 2);
  EXPECT_EQ(json["column"], 4);
  EXPECT_EQ(json["end_column"], 5);
  EXPECT_EQ(json["begin"], 7);
  EXPECT_EQ(json["end"], 8);
  EXPECT_EQ(json["message"], "bad \xef\xbf\xbd byte");
  EXPECT_EQ(json["notes"][0]["text"], "here");
  EXPECT_EQ(json["notes"][0]["line"], 1);
}

TEST(Diagnostic, EveryCodeIsUniqueAndExplained) {
  std::set<std::string_view> seen;
  for (const Code code : AllCodes()) {
    const CodeInfo& info = InfoOf(code);
    EXPECT_TRUE(seen.insert(info.code).second) << info.code;
    EXPECT_EQ(info.code.size(), 5u);
    EXPECT_EQ(info.code[0], info.severity == Severity::kError ? 'E' : 'W') << info.code;
    EXPECT_FALSE(info.title.ends_with('.')) << info.code;
    EXPECT_TRUE(info.explanation.ends_with('.')) << info.code;
    EXPECT_EQ(FindCode(info.code), code);
  }
  EXPECT_EQ(FindCode("e0101"), Code::kNotUtf8);
  EXPECT_EQ(FindCode("E9999"), std::nullopt);
}

TEST(DidYouMean, FindsTheNearest) {
  const std::vector<std::string> words = {"place line", "place arc", "radius", "rotate", "xy"};
  EXPECT_EQ(DidYouMean("raduis", words), "radius");
  EXPECT_EQ(DidYouMean("Place Lin", words), "place line");
  EXPECT_EQ(DidYouMean("yx", words), "xy");
  EXPECT_EQ(DidYouMean("sphere", words), std::nullopt);
  EXPECT_EQ(DidYouMean("q", words), std::nullopt);
  EXPECT_EQ(DidYouMean("north", {"South", "North"}), "North");
  EXPECT_EQ(DidYouMean("bat", {"bar", "cat"}), "bar");  // the first of equals
}

}  // namespace
}  // namespace tranos::interp
