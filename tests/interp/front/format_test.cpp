// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/format.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/interp/front/tree_text.h"

namespace tranos::interp {
namespace {

std::string Formatted(const Parsed& parsed) {
  for (const Diagnostic& diagnostic : parsed.diagnostics.list()) {
    ADD_FAILURE() << RenderText(diagnostic, parsed.sources, false);
  }
  return Format(parsed.sources.files[0], parsed.tree);
}

std::string Formatted(std::string text) { return Formatted(ParseText(std::move(text))); }

TEST(Format, SpacesWithinALine) {
  EXPECT_EQ(Formatted("place line  xy = 0 , 0,0   dl=10 ;;  reset|undo;"),
            "place line xy=0,0,0 dl=10; reset | undo\n");
  EXPECT_EQ(Formatted("let x=-(1+2) * 3^2 +f( a,b )[ 0 ] . c"),
            "let x = -(1 + 2)*3^2 + f(a, b)[0].c\n");
  EXPECT_EQ(Formatted("xy=a + 1 , [1,2 + 3]"), "xy=a+1,[1, 2 + 3]\n");
  EXPECT_EQ(Formatted("let r=0 .. n-1;let s=0 .. n"), "let r = 0 .. n - 1; let s = 0..n\n");
  EXPECT_EQ(Formatted("assert a<b and not(c)or d within 1+-2%"),
            "assert a < b and not (c) or d within 1 +- 2%\n");
  EXPECT_EQ(Formatted("unknown x:length=free"), "unknown x : length = free\n");
  EXPECT_EQ(Formatted("let f=xs.map(x=>x*2)"), "let f = xs.map(x => x*2)\n");
}

TEST(Format, SpacesThatCarryMeaningStay) {
  EXPECT_EQ(Formatted("n=a + -1"), "n=a+ -1\n");
  EXPECT_EQ(Formatted("n=2e -3"), "n=2e -3\n");
  EXPECT_EQ(Formatted("let n = 5 %3"), "let n = 5 % 3\n");
  EXPECT_EQ(Formatted("print \"a  {x+1:2}\""), "print \"a  {x+1:2}\"\n");
}

TEST(Format, LinesAreTheWriters) {
  EXPECT_EQ(Formatted("for i=0 to 3{a;b}\nfor i=0 to 3 {\na\nb }\n"),
            "for i = 0 to 3 { a; b }\nfor i = 0 to 3 {\n  a\n  b }\n");
  EXPECT_EQ(Formatted("let x=[1,\n2,\n3\n]\nlet y=1+\n2"),
            "let x = [1,\n    2,\n    3\n]\nlet y = 1 +\n    2\n");
  EXPECT_EQ(Formatted("if a{\nb\n}else if c{}\nelsewhere"),
            "if a {\n  b\n} else if c {}\nelsewhere\n");
}

TEST(Format, AtMostOneEmptyLine) {
  EXPECT_EQ(Formatted("\n\na\n\n\n\nb\n{\n\nc\n\n}\n\n\n"), "a\n\nb\n{\n  c\n}\n");
  EXPECT_EQ(Formatted("\n ; \n"), "");
}

TEST(Format, CommentsKeepTheirPlaces) {
  EXPECT_EQ(Formatted("#top  \na#trailing\n{#open\n#own\nb}\n#end"),
            "#top\na  #trailing\n{  #open\n  #own\n  b }\n#end\n");
  EXPECT_EQ(Formatted("let x=[1,# one\n# two\n2]"), "let x = [1,  # one\n    # two\n    2]\n");
  EXPECT_EQ(Formatted("a ; # c\n;b"), "a  # c\nb\n");
}

TEST(Format, ADefinition) {
  EXPECT_EQ(Formatted("define place dome\n\"doc\"\n# size\nbay:length=30m in 1m..2m,\n3m \"d\"\n{\n"
                      "interface crown at=[0,1] r=bay/2\n}"),
            "define place dome\n  \"doc\"\n  # size\n  bay : length = 30m in 1m..2m,\n      3m "
            "\"d\"\n{\n  interface crown at=[0, 1] r=bay/2\n}\n");
}

TEST(Format, LineEndsAndMarksOfOtherSystemsGo) {
  EXPECT_EQ(Formatted("\xef\xbb\xbf"
                      "a # c\r\nb\r\n"),
            "a  # c\nb\n");
}

// --- Random scripts ---

using Texts = std::vector<std::string>;

std::string Pick(const Texts& texts) { return *rc::gen::elementOf(texts); }
int Below(int bound) { return *rc::gen::inRange(0, bound); }
std::string Space() { return Pick({"", " ", "  "}); }
std::string Gap() { return Pick({" ", "  ", "\t"}); }
std::string Break() { return Pick({"", " ", "\n", " # in\n", "\n\n\n# own\n\n"}); }

std::string Atom() {
  return Pick({"a", "b_1", "0", "1.5", "2e", "3m", "2%", "1e3", "true", "last", "\"s {a:1} \\n\"",
               "\"\"", "ναός", "to", "step", "[]", "f()"});
}

std::string Expression(int depth) {
  if (depth == 0) return Atom();
  const auto inner = [&] { return Expression(depth - 1); };
  switch (Below(10)) {
    case 0:
      return "(" + Break() + inner() + Break() + ")";
    case 1:
      return "[" + Break() + inner() + Space() + "," + Break() + inner() + "]";
    case 2:
      return "-" + Space() + "(" + inner() + ")";
    case 3:
      return "not" + Gap() + "(" + inner() + ")";
    case 4:
      return "(if " + inner() + " then" + Gap() + inner() + " else " + inner() + ")";
    case 5:
      return "f(" + Space() + "x" + Space() + "=>" + Space() + inner() + ")";
    case 6:
      return "a[" + inner() + "]" + Space() + "." + Space() + Pick({"x", "group", "last"});
    case 7:
      return "(" + inner() + ")" + Space() + "^" + Space() + "-" + Atom();
    default:
      return "(" + inner() + ")" +
             Pick({" + ", "+", " - ", "-", "*", " / ", " % ", "..", " +- ", " == ", "<", " and ",
                   " or ", " within ", " + -", "- -"}) +
             "(" + inner() + ")";
  }
}

std::string KeyIn() {
  std::string text = Pick({"xy", "dl", "co", "as", "to", "in", "let"}) + Space() + "=" + Space();
  const int count = 1 + Below(3);
  for (int i = 0; i < count; ++i) text += (i == 0 ? "" : Space() + "," + Break()) + Expression(2);
  return text;
}

std::string Command() {
  std::string text = Pick({"place line", "place  arc", "choose last", "create group", "undo"});
  const int count = Below(4);
  for (int i = 0; i < count; ++i) {
    text += Gap();
    text += Below(2) == 0 ? KeyIn() : Pick({"as n", "reset", "center", "3m", "\"t\""});
  }
  return text;
}

std::string Separator() {
  return Pick(
      {"\n", ";", " | ", ";;\n", "\n\n\n", " # c\n", "\n# own  \n", " ;\n;", "\n #a\n\n#b\n"});
}

std::string Statement(int depth);

std::string Block(int depth) {
  std::string text = "{" + Pick({"", " ", "\n", "\n\n", "# c\n"});
  const int count = Below(3);
  for (int i = 0; i < count; ++i) text += Statement(depth) + Separator();
  return text + "}";
}

std::string Definition(int depth) {
  return "define place x" + Separator() + Pick({"", "\"doc\"" + Separator()}) + "r" + Space() +
         ":" + Space() + "list of length" + Space() + "=" + Break() + Expression(1) + " in" +
         Gap() + Expression(1) + Space() + "," + Break() + "b \"d\"" + Separator() + Block(depth);
}

std::string Statement(int depth) {
  switch (Below(depth > 0 ? 14 : 7)) {
    case 0:
      return "let x" + Space() + "=" + Break() + Expression(2);
    case 1:
      return KeyIn() + Gap() + KeyIn();
    case 2:
      return "function f(" + Space() + "a," + Break() + "b)" + Space() + "=" + Expression(2);
    case 3:
      return "assert" + Gap() + Expression(2) + Gap() + "\"m {a}\"";
    case 4:
      return "unknown u" + Space() + ":" + "length=" + Expression(1) + " in " + Expression(1);
    case 7:
      return "for i" + Space() + "=" + Expression(1) + " to" + Break() + " " + Expression(1) +
             " step " + Expression(1) + Space() + Block(depth - 1);
    case 8:
      return "for i, x in " + Expression(1) + Block(depth - 1);
    case 9:
      return "if " + Expression(1) + Block(depth - 1) + Space() + "else" + Break() + " if a" +
             Block(depth - 1) + "else" + Break() + Block(depth - 1);
    case 10:
      return "group as g" + Gap() + Block(depth - 1) + Pick({"", " ", "\n"}) + Command();
    case 11:
      return Definition(depth - 1);
    case 12:
      return Block(depth - 1) + Block(depth - 1);
    default:
      return Command();
  }
}

std::string Script() {
  std::string text = Pick({"", "\n", "# top\n", ";"});
  const int count = Below(6);
  for (int i = 0; i < count; ++i) text += Statement(2) + Separator();
  return text;
}

TEST(Format, NeverChangesMeaningAndHasOneResult) {
  EXPECT_TRUE(rc::check([] {
    const std::string text = Script();
    const Parsed parsed = ParseText(text);
    RC_LOG() << text;
    for (const Diagnostic& diagnostic : parsed.diagnostics.list()) {
      RC_LOG() << RenderText(diagnostic, parsed.sources, false);
    }
    RC_ASSERT(!parsed.diagnostics.has_errors());
    const std::string once = Format(parsed.sources.files[0], parsed.tree);
    RC_LOG() << once;
    const Parsed again = ParseText(once);
    RC_ASSERT(!again.diagnostics.has_errors());
    RC_ASSERT(TreeText(again) == TreeText(parsed));
    RC_ASSERT(CommentsOf(again) == CommentsOf(parsed));
    RC_ASSERT(Format(again.sources.files[0], again.tree) == once);
  }));
}

}  // namespace
}  // namespace tranos::interp
