// SPDX-License-Identifier: GPL-3.0-or-later
// Bad input: each has a code and a span, and the program stands.
#include <gtest/gtest.h>

#include "interp/run.h"

namespace tranos::interp {
namespace {

ScriptResult RunText(std::string text, Limits limits = {}) {
  return RunScript("hostile.trn", std::move(text), {"", {}, limits.depth}, {limits, {}},
                   {nullptr, [](std::string_view) {}});
}

std::string Repeated(std::string_view text, std::size_t count) {
  std::string out;
  out.reserve(text.size() * count);
  for (std::size_t i = 0; i < count; ++i) out += text;
  return out;
}

// The code of the first error, with the text that its span covers; both "" if there is none.
struct Found {
  std::string code, text;
};
Found FirstError(const ScriptResult& result) {
  for (const Diagnostic& diagnostic : result.diagnostics.list()) {
    if (diagnostic.severity() != Severity::kError) continue;
    EXPECT_LE(diagnostic.span.end, result.sources->files[diagnostic.span.file].text.size());
    EXPECT_FALSE(RenderText(diagnostic, *result.sources, false).empty());
    EXPECT_FALSE(RenderJson(diagnostic, *result.sources).empty());
    return {std::string(InfoOf(diagnostic.code).code),
            std::string(result.sources->Slice(diagnostic.span))};
  }
  return {};
}

TEST(HostileScript, NotUtf8NamesTheByte) {
  const ScriptResult result = RunText("print \"a\"\nprint \"\xff\"\n");
  EXPECT_EQ(FirstError(result).code, "E0101");
  EXPECT_EQ(result.diagnostics.list()[0].span.begin, 17u);
  EXPECT_FALSE(result.ran);
}

TEST(HostileScript, UnclosedBraceAtTheEndOfAMegabyte) {
  const std::string text = Repeated("place point xy=1,2,3\n", 50'000) + "if true {\n";
  const ScriptResult result = RunText(text);
  EXPECT_EQ(FirstError(result).code, "E0106");
  EXPECT_FALSE(result.ran);
}

TEST(HostileScript, HundredThousandParentheses) {
  const Found found =
      FirstError(RunText("let a = " + Repeated("(", 100'000) + "1" + Repeated(")", 100'000)));
  EXPECT_EQ(found.code, "E0108");
}

TEST(HostileScript, HundredThousandOfEachNesting) {
  for (const char* opening : {"[", "f(", "-", "not ", "if true then ", "x => ", "2^", "\"{"}) {
    const ScriptResult result = RunText("let a = " + Repeated(opening, 100'000));
    EXPECT_NE(FirstError(result).code, "") << opening;
  }
  for (const char* opening :
       {"{", "if true {", "group {", "for i = 1 to 2 {", "if true { } else "}) {
    const ScriptResult result = RunText(Repeated(opening, 100'000));
    EXPECT_NE(FirstError(result).code, "") << opening;
  }
}

TEST(HostileScript, LongChainsAreNoNesting) {
  const ScriptResult sum =
      RunText("let a = 1" + Repeated(" + 1", 100'000) + "\nassert a == 100001");
  EXPECT_EQ(FirstError(sum).code, "");
  ASSERT_EQ(sum.outcome.asserts.size(), 1u);
  EXPECT_TRUE(sum.outcome.asserts[0].passed);
  const ScriptResult chain =
      RunText("let a = 7\nif a == 0 { }" + Repeated(" else if a == 1 { }", 10'000) + " else { }");
  EXPECT_EQ(FirstError(chain).code, "");
}

TEST(HostileScript, InfiniteRecursionStopsAtTheLimitOfDepth) {
  EXPECT_EQ(FirstError(RunText("function f(n) = f(n + 1)\nlet a = f(1)")).code, "E0604");
  EXPECT_EQ(
      FirstError(RunText("let f = x => x\nfunction g(n) = map([n], x => g(x))[0]\nlet a = g(1)"))
          .code,
      "E0604");
  EXPECT_EQ(FirstError(RunText("define place a { place b xy=0,0,0 }\n"
                               "define place b { place a xy=0,0,0 }\nplace a xy=0,0,0"))
                .code,
            "E0604");
}

TEST(HostileScript, ExponentialWorkStopsAtTheLimitOfSteps) {
  Limits limits;
  limits.steps = 100'000;
  const ScriptResult result =
      RunText("function f(n) = if n == 0 then 0 else f(n - 1) + f(n - 1)\nlet a = f(60)", limits);
  EXPECT_EQ(FirstError(result).code, "E0601");
}

TEST(HostileScript, DoublingStopsAtTheLimitOfMemory) {
  Limits limits;
  limits.memory = 1'000'000;
  const std::string text =
      "let s = \"0123456789\"\nfunction twice(t, n) = if n == 0 then t else twice(\"{t}{t}\", n - "
      "1)\n"
      "let a = twice(s, 60)";
  EXPECT_EQ(FirstError(RunText(text, limits)).code, "E0603");
  const std::string lists =
      "function twice(t, n) = if n == 0 then t else twice(join(t, t), n - 1)\nlet a = twice([1, "
      "2], 60)";
  EXPECT_NE(FirstError(RunText(lists, limits)).code, "");
}

TEST(HostileScript, ListsThatShareTheirPartsAreNoTrouble) {
  // 2^60 numbers by reading, sixty lists by holding: it is told or refused, never walked.
  Limits limits;
  limits.steps = 100'000;
  const std::string text =
      "function twice(t, n) = if n == 0 then t else twice([t, t], n - 1)\n"
      "let a = twice([1, 2], 60)\nlet b = twice([1, 2], 60)\nlet same = a == b\n";
  const ScriptResult result = RunText(text, limits);
  EXPECT_NE(FirstError(result).code, "E0107");
}

TEST(HostileScript, ArraysStopAtTheLimitOfElements) {
  const std::string text =
      "place point xy=0,0,0\narray rectangular of=last columns=1e9 column_spacing=1";
  EXPECT_EQ(FirstError(RunText(text)).code, "E0212");
  Limits limits;
  limits.elements = 100;
  const std::string doubling =
      "place point xy=0,0,0\nfor i = 1 to 40 { choose all; copy xy=0,0,0 dl=1 }";
  EXPECT_EQ(FirstError(RunText(doubling, limits)).code, "E0602");
}

TEST(HostileScript, ControlCharactersAreShownEscaped) {
  for (const char* text :
       {"let \x1b[31m = 3", "print \"{\x1b}\"", "place \x07 line", "let a\x01 = 2"}) {
    const ScriptResult result = RunText(text);
    ASSERT_NE(FirstError(result).code, "") << text;
    for (const Diagnostic& diagnostic : result.diagnostics.list()) {
      const std::string shown = RenderText(diagnostic, *result.sources, false);
      for (const char c : shown)
        EXPECT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 32) << shown;
    }
  }
}

TEST(HostileScript, AHundredErrorsAreEnough) {
  const ScriptResult result = RunText(Repeated("place lin xy=0,0,0\n", 100'000));
  EXPECT_EQ(result.diagnostics.error_count(), 100'000u);
  EXPECT_EQ(result.diagnostics.list().size(), 100u);
}

TEST(HostileScript, ErrorsAreToldInTheOrderOfTheText) {
  const ScriptResult result =
      RunText("let a = b\ndefine dome { }\nplace lin xy=0,0,0\nlet a = 3\n");
  std::uint32_t before = 0;
  EXPECT_EQ(result.diagnostics.list().size(), 4u);
  for (const Diagnostic& diagnostic : result.diagnostics.list()) {
    EXPECT_GE(diagnostic.span.begin, before);
    before = diagnostic.span.begin;
  }
}

TEST(HostileScript, EmptyAndStrangeTextsStand) {
  for (const char* text : {"",
                           "\n",
                           ";",
                           "|",
                           "#",
                           "\xef\xbb\xbf",
                           "{",
                           "}",
                           "(",
                           "\"",
                           "=",
                           "as",
                           "reset",
                           "last",
                           "if",
                           "for",
                           "let",
                           "use",
                           "define",
                           "group",
                           "xy=",
                           "place",
                           "let a =",
                           "print \"{\"",
                           "print \"{}\"",
                           "x",
                           "1",
                           "un=",
                           "unit",
                           "assert"}) {
    const ScriptResult result = RunText(text);
    FirstError(result);
  }
}

}  // namespace
}  // namespace tranos::interp
