// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/parser.h"

#include <gtest/gtest.h>

#include "tests/interp/front/tree_text.h"

namespace tranos::interp {
namespace {

// The statements of a text without errors.
std::string Tree(std::string text) {
  const Parsed parsed = ParseText(std::move(text));
  for (const Diagnostic& diagnostic : parsed.diagnostics.list()) {
    ADD_FAILURE() << RenderText(diagnostic, parsed.sources, false);
  }
  const std::string tree = TreeText(parsed);
  constexpr std::string_view kBegin = "(Script ";
  return tree.starts_with(kBegin) ? tree.substr(kBegin.size(), tree.size() - kBegin.size() - 1)
                                  : tree;
}

std::string Value(const std::string& text) {
  const std::string tree = Tree("let x = " + text);
  return tree.substr(7, tree.size() - 8);
}

TEST(Parser, ACommandAndItsArguments) {
  EXPECT_EQ(Tree("place line  xy=0,0,0  dl=10"),
            "(Command place: line: (KeyIn xy: 0 0 0) (KeyIn dl: 10))");
  EXPECT_EQ(Tree("place text \"a\" 3 as t reset"),
            "(Command place: text: (String 'a') 3 (Naming t) Reset)");
  EXPECT_EQ(Tree("create group"), "(Command create: group:)");
  EXPECT_EQ(Tree("choose last"), "(Command choose: last:)");
}

TEST(Parser, SeparatorsInAnyNumber) {
  EXPECT_EQ(Tree(";;place line;|\n xy=0 | reset\n\n"),
            "(Command place: line:) (KeyIns (KeyIn xy: 0)) (KeyIns Reset)");
  EXPECT_EQ(Tree(""), "Script");
}

TEST(Parser, AWordBeforeAnEqualsSignIsAKey) {
  EXPECT_EQ(Tree("as=2 to=3 let=4"), "(KeyIns (KeyIn as: 2) (KeyIn to: 3) (KeyIn let: 4))");
  EXPECT_EQ(Tree("place arc and=1 xy=a and=2"),
            "(Command place: arc: (KeyIn and: 1) (KeyIn xy: a) (KeyIn and: 2))");
  EXPECT_EQ(Tree("reset as a"), "(KeyIns Reset (Naming a))");
}

TEST(Parser, Precedence) {
  EXPECT_EQ(Value("a or b and not c == d"), "(or a (and b (not (== c d))))");
  EXPECT_EQ(Value("1 + 2*3 - 4"), "(- (+ 1 (* 2 3)) 4)");
  EXPECT_EQ(Value("-2^2"), "(neg (^ 2 2))");
  EXPECT_EQ(Value("2^-3^2"), "(^ 2 (neg (^ 3 2)))");
  EXPECT_EQ(Value("2^3^4"), "(^ 2 (^ 3 4))");
  EXPECT_EQ(Value("a+1..b-1"), "(.. (+ a 1) (- b 1))");
  EXPECT_EQ(Value("x within a +- 2%"), "(within x (+- a 2%))");
  EXPECT_EQ(Value("x consistent 1..2 and y"), "(and (consistent x (.. 1 2)) y)");
  EXPECT_EQ(Value("a - -b"), "(- a (neg b))");
  EXPECT_EQ(Value("7 % 3*2"), "(* (% 7 3) 2)");
}

TEST(Parser, SpacesNeverEndAnExpression) {
  EXPECT_EQ(Tree("xy=1, 2 -3 co=4"), "(KeyIns (KeyIn xy: 1 (- 2 3)) (KeyIn co: 4))");
}

TEST(Parser, CallsIndicesAndMembers) {
  EXPECT_EQ(Value("f(1, [2])[0].group.x"),
            "(Member (Member (Index (Call f 1 (List 2)) 0) group) x)");
  EXPECT_EQ(Value("not (a)"), "(not (Paren a))");
  EXPECT_EQ(Value("last.volume"), "(Member Last volume)");
  EXPECT_EQ(Value("f()"), "(Call f)");
  EXPECT_EQ(Value("[]"), "List");
}

TEST(Parser, ConditionalsAndLambdas) {
  EXPECT_EQ(Value("if a then 1 else if b then 2 else 3"), "(Conditional a 1 (Conditional b 2 3))");
  EXPECT_EQ(Value("xs.map(x => y => x + y)"),
            "(Call (Member xs map) (Lambda x (Lambda y (+ x y))))");
}

TEST(Parser, NewlinesThatDoNotCount) {
  EXPECT_EQ(Tree("let x =\n 1 +\n 2\nlet y = [\n1\n,\n2\n]\nxy=\n1,\n2"),
            "(Let x (+ 1 2)) (Let y (List 1 2)) (KeyIns (KeyIn xy: 1 2))");
  EXPECT_EQ(Value("if a then\n 1 else\n 2"), "(Conditional a 1 2)");
  EXPECT_EQ(Tree("for i = 0 to\n 3 { }"), "(ForCount i 0 3 Block)");
  EXPECT_EQ(Tree("for x in\n xs { }"), "(ForEach x xs Block)");
  EXPECT_EQ(Value("(x\n=>\nx)"), "(Paren (Lambda x x))");
}

TEST(Parser, Strings) {
  EXPECT_EQ(Value(R"("bay {i} of {n + 1:2}")"),
            "(String 'bay ' (StringValue0 i) ' of ' (StringValue3 (+ n 1)))");
  EXPECT_EQ(Value(R"("{"{x}"}")"), "(String (StringValue0 (String (StringValue0 x))))");
  EXPECT_EQ(Value(R"("")"), "String");
}

TEST(Parser, Definitions) {
  EXPECT_EQ(Tree("unit pechys = 0.648m"), "(Unit pechys 0.648m)");
  EXPECT_EQ(Tree("function f(a, b) = a"), "(Function f (Params a b) a)");
  EXPECT_EQ(Tree("function f() = 1"), "(Function f Params 1)");
  EXPECT_EQ(Tree("unknown x : length = free"), "(Unknown x (Type0 length) free)");
  EXPECT_EQ(Tree("unknown rise = 4m in 2m..8m"), "(Unknown rise 4m (Range (.. 2m 8m)))");
  EXPECT_EQ(Tree("parameter h : length = 12m in 4m..40m \"to\""),
            "(Parameter (Param h (Type0 length) (Default 12m) (Range (.. 4m 40m)) (String 'to')))");
  EXPECT_EQ(Tree("interface crown at=[1, 2] r=3"),
            "(Interface crown (KeyIn at: (List 1 2)) (KeyIn r: 3))");
}

TEST(Parser, ADefineHasWordsAHeaderAndABlock) {
  EXPECT_EQ(Tree("define place dome cruciform\n  \"doc\"\n  bay : length = 30m\n"
                 "  detail : word = shell in outline, shell\n  xs : list of length\n{\n}\n"),
            "(Define (Words place dome cruciform) (String 'doc') "
            "(Param bay (Type0 length) (Default 30m)) "
            "(Param detail (Type0 word) (Default shell) (Range outline shell)) "
            "(Param xs (Type1 length)) Block)");
  EXPECT_EQ(Tree("define place x r : length { co=1 }"),
            "(Define (Words place x) (Param r (Type0 length)) (Block (KeyIns (KeyIn co: 1))))");
  EXPECT_EQ(Tree("define place x { }"), "(Define (Words place x) Block)");
}

TEST(Parser, Control) {
  EXPECT_EQ(Tree("for i = 0 to 7 step 2 { a }"), "(ForCount i 0 7 (Step 2) (Block (Command a:)))");
  EXPECT_EQ(Tree("for i, x in xs { }"), "(ForEach i x xs Block)");
  EXPECT_EQ(Tree("if a { } else if b { } else\n{ }"), "(If a Block (If b Block Block))");
  EXPECT_EQ(Tree("group as south { } group { }"), "(Group south Block) (Group Block)");
  EXPECT_EQ(Tree("hypothesis one { } hypothesis two { }"),
            "(Hypothesis one Block) (Hypothesis two Block)");
  EXPECT_EQ(Tree("{ a; b } c"), "(Block (Command a:) (Command b:)) (Command c:)");
  EXPECT_EQ(Tree("use \"a.trn\""), "(Use (String 'a.trn'))");
  EXPECT_EQ(Tree("assert a within 1 +- 2% \"m {x}\""),
            "(Assert (within a (+- 1 2%)) (String 'm ' (StringValue0 x)))");
}

TEST(Parser, StepAndToMeanSomethingOnlyInTheirPlace) {
  EXPECT_EQ(Tree("step camera paper omega=0.1deg"),
            "(Command step: camera: paper: (KeyIn omega: 0.1deg))");
  EXPECT_EQ(Value("to + list + of"), "(+ (+ to list) of)");
}

TEST(Parser, KeywordsInAnyCase) { EXPECT_EQ(Tree("LET x = True AND y"), "(Let x (and True y))"); }

TEST(Parser, SpansCoverWhatTheyName) {
  const Parsed parsed = ParseText("place  line xy=1,(2 +3) # c\n");
  const NodeId command = parsed.tree[parsed.tree.root].first_child;
  EXPECT_EQ(parsed.sources.Slice(parsed.tree.SpanOf(command)), "place  line xy=1,(2 +3)");
  const NodeId key_in = parsed.tree.Children(command)[2];
  EXPECT_EQ(parsed.sources.Slice(parsed.tree.SpanOf(key_in)), "xy=1,(2 +3)");
  ASSERT_EQ(parsed.tree.comments.size(), 1u);
}

TEST(Parser, ChainsCostNoDepth) {
  std::string sum = "let x = 1", chain = "if a { }", calls = "let f = f";
  for (int i = 0; i < 100000; ++i) {
    sum += "+1";
    chain += " else if a { }";
    calls += "(1)";
  }
  EXPECT_FALSE(ParseText(sum + "\n" + chain + "\n" + calls).diagnostics.has_errors());
}

// The paper's script, word for word.
TEST(Parser, TheCruciformDome) {
  const std::string tree = Tree(
      "co=0;lc=0;wt=1\nplace line;xy=0,0,0;dl=10\nchoose element;xy=5,0,0\ncopy;xy=5,0,0;dl=20\n"
      "aa=90;choose element;xy=5,0,0\nrotate copy\nxy=30,0,0;xy=30,-30,0;xy=0,-30,0;reset\n"
      "choose all; construct surface edge\nset view phong antialias | render all\n");
  EXPECT_NE(tree.find("(KeyIn xy: 30 (neg 30) 0)"), tree.npos);
  EXPECT_NE(tree.find("(Command set: view: phong: antialias:) (Command render: all:)"), tree.npos);
}

}  // namespace
}  // namespace tranos::interp
