// SPDX-License-Identifier: GPL-3.0-or-later
// Families of a library: reached by words, bound when reached, and whose mistake is whose.
#include <gtest/gtest.h>

#include "interp/run.h"

namespace tranos::interp {
namespace {

constexpr std::string_view kArches = R"(
define place arch plain
  "An arch."
  span : length = 2m in 1m..9m "clear span"
{
  place line xy=0,0,0 dl=span
  interface crown at=[span/2, 0, rise(span)]
}
function rise(span) = span/2
define place arch on sticks { place stick xy=0,0,0; place arch plain xy=0,0,1 }
)";
constexpr std::string_view kSticks = R"(
use "arches.trn"
define place stick length : length = 1m in 0.1m..4m { place line xy=0,0,0 dl=0,0,length }
define place stick like an arch { place stick length=rise(2m) xy=0,0,0 }
define place stick under arch span : length = 2m { place stick xy=0,0,0; place arch plain span=span xy=0,0,1 }
define place stick of nothing length : length = 1m { place line xy=0,0,0 dl=length/0 }
)";

class FamilyTest : public ::testing::Test {
 protected:
  ScriptResult Run(std::string script) {
    BindOptions options;
    options.library = &library_;
    return RunScript("script.trn", std::move(script), options, {}, {});
  }
  static std::vector<std::string> Paths(const ScriptResult& result) {
    std::vector<std::string> paths;
    for (const SourceText& source : result.sources->files) paths.push_back(source.path);
    return paths;
  }
  static const Diagnostic& Only(const ScriptResult& result) {
    EXPECT_EQ(result.diagnostics.list().size(), 1u);
    return result.diagnostics.list().at(0);
  }
  static std::string_view TextAt(const ScriptResult& result, const Span& span) {
    return result.sources->Slice(span);
  }

  Library library_{{{"arches", kArches},
                    {"broken", "define place wreck {"},
                    {"mixed",
                     "define place good { place line xy=0,0,0 dl=1 }\n"
                     "define place bad { place line xy=0,0,0 dl=nothing }\n"
                     "define place worse { place good xy=0,0,0; place bad xy=0,0,0 }"},
                    {"letting", "let a = 1\ndefine place letter { place line xy=0,0,0 dl=a }"},
                    {"sticks", kSticks}}};
};
using Strings = std::vector<std::string>;

TEST_F(FamilyTest, WhatAScriptDoesNotReachIsNotRead) {
  EXPECT_EQ(Paths(Run("place line xy=0,0,0 dl=1")), Strings{"script.trn"});
  EXPECT_EQ(Paths(Run("let arch = 1\nplace text text=\"place arch plain\" xy=0,0")),
            Strings{"script.trn"});
}

TEST_F(FamilyTest, AnElementIsReachedByItsWords) {
  const ScriptResult result =
      Run("place arch plain span=4m xy=1,0,0 as a\n"
          "assert a.bbox.max.x == 5m and a.crown.at.z == 2m and a.span == 4m");
  EXPECT_TRUE(result.diagnostics.list().empty());
  EXPECT_TRUE(result.outcome.asserts.at(0).passed);
  EXPECT_EQ(Paths(result), (Strings{"script.trn", "stdlib/arches.trn"}));
  EXPECT_TRUE(result.sources->files[1].of_library);
  EXPECT_FALSE(result.sources->files[0].of_library);
}

TEST_F(FamilyTest, AnElementIsReachedFromADefinitionAndFromALoop) {
  const ScriptResult result =
      Run("define place pair { for i = 0 to 1 { place arch plain xy=i*5m,0 } }\nplace pair xy=0,0");
  EXPECT_TRUE(result.diagnostics.list().empty());
  EXPECT_EQ(result.outcome.state.model.live, 1u);
}

TEST_F(FamilyTest, FamiliesUseOneAnotherInCircles) {
  EXPECT_FALSE(Run("place arch on sticks xy=0,0").diagnostics.has_errors());
  EXPECT_FALSE(Run("place stick like an arch xy=0,0 as s\nassert s.bbox.max.z == 1m")
                   .diagnostics.has_errors());
}

// A body that nothing reaches is not bound: its mistake is not this script's.
TEST_F(FamilyTest, AnElementIsBoundWhenItIsReached) {
  EXPECT_TRUE(Run("place good xy=0,0").diagnostics.list().empty());
  EXPECT_EQ(Only(Run("place bad xy=0,0")).code, Code::kUnknownName);
  EXPECT_EQ(Only(Run("place worse xy=0,0")).code, Code::kUnknownName);
}

TEST_F(FamilyTest, TheUsersOwnDefinitionOfTheSameWordsIsMeant) {
  const ScriptResult result =
      Run("define place arch plain { place point xy=0,0,7 }\nplace arch plain xy=0,0 as a\n"
          "assert a.bbox.max.z == 7m");
  EXPECT_TRUE(result.diagnostics.list().empty());
  EXPECT_TRUE(result.outcome.asserts.at(0).passed);
  EXPECT_EQ(Paths(result), Strings{"script.trn"});
}

TEST_F(FamilyTest, TheUsersOwnDefinitionChangesNothingInTheLibrary) {
  const ScriptResult result =
      Run("define place stick { place point xy=0,0,7 }\nplace arch on sticks xy=0,0 as a\n"
          "assert a.bbox.max.z == 1m");
  EXPECT_TRUE(result.diagnostics.list().empty());
  EXPECT_TRUE(result.outcome.asserts.at(0).passed);
}

TEST_F(FamilyTest, NamesDoNotCrossFromOneToTheOther) {
  EXPECT_EQ(Only(Run("place arch plain xy=0,0\nlet a = rise(3m)")).code, Code::kUnknownFunction);
  EXPECT_FALSE(Run("function rise(s) = 0m\nplace arch plain xy=0,0 as a\nassert a.crown.at.z == 1m")
                   .diagnostics.has_errors());
}

TEST_F(FamilyTest, AnArgumentOutOfItsRangeIsTheUsers) {
  const ScriptResult result = Run("place arch plain span=12m xy=0,0");
  const Diagnostic& error = Only(result);
  EXPECT_EQ(error.code, Code::kOutOfRange);
  EXPECT_EQ(TextAt(result, error.span), "12m");
  EXPECT_EQ(error.span.file, 0u);
  EXPECT_EQ(error.label, "expected 1 m..9 m");
  ASSERT_EQ(error.notes.size(), 1u);  // where it is declared
  EXPECT_EQ(error.notes[0].span.file, 1u);
}

TEST_F(FamilyTest, AMistakeWithinTheLibraryNamesTheUsersPlacement) {
  const ScriptResult result = Run("place line xy=0,0,0 dl=1\nplace stick of nothing xy=0,0");
  const Diagnostic& error = Only(result);
  EXPECT_EQ(error.code, Code::kNotFinite);
  EXPECT_EQ(result.sources->files[error.span.file].path, "stdlib/sticks.trn");
  ASSERT_EQ(error.notes.size(), 1u);
  EXPECT_EQ(TextAt(result, error.notes[0].span), "place stick of nothing");
  EXPECT_NE(RenderText(error, *result.sources, false).find("stdlib/sticks.trn:6"),
            std::string::npos);
}

TEST_F(FamilyTest, AMistakeFarWithinTellsEachFilesPlacement) {
  const ScriptResult result = Run("place stick under arch span=20m xy=0,0");
  const Diagnostic& error = Only(result);
  EXPECT_EQ(error.code, Code::kOutOfRange);
  EXPECT_EQ(result.sources->files[error.span.file].path, "stdlib/sticks.trn");
  ASSERT_EQ(error.notes.size(), 2u);
  EXPECT_EQ(result.sources->files[error.notes[0].span.file].path, "stdlib/arches.trn");
  EXPECT_EQ(TextAt(result, error.notes[1].span), "place stick under arch");
}

TEST_F(FamilyTest, WordsThatAreNearlyAnElementsAreSuggested) {
  EXPECT_EQ(Only(Run("place arch plane xy=0,0")).help, "did you mean `place arch plain`?");
}

TEST_F(FamilyTest, ABrokenFamilyIsToldOfOnlyWhereItIsReached) {
  EXPECT_FALSE(Run("place stick xy=0,0").diagnostics.has_errors());
  const ScriptResult result = Run("place wreck xy=0,0");
  ASSERT_TRUE(result.diagnostics.has_errors());
  const Span span = result.diagnostics.list().back().span;
  EXPECT_EQ(result.sources->files[span.file].path, "stdlib/broken.trn");
}

TEST_F(FamilyTest, AFamilyHoldsFunctionsAndDefinitionsAlone) {
  EXPECT_EQ(Run("place letter xy=0,0").diagnostics.list().at(0).code, Code::kMisplaced);
}

TEST_F(FamilyTest, AFileOfTheUsersMayHaveAFamilysName) {
  Host host;
  host.read = [](std::string_view) -> tl::expected<std::string, HostError> {
    return "define place tree { place line xy=0,0,0 dl=0,0,5 }";
  };
  BindOptions options;
  options.library = &library_;
  const ScriptResult result = RunScript(
      "script.trn", "use \"stdlib/arches.trn\"\nplace tree xy=0,0\nplace arch plain xy=0,0",
      options, {}, host);
  EXPECT_TRUE(result.diagnostics.list().empty());
  ASSERT_EQ(Paths(result), (Strings{"script.trn", "stdlib/arches.trn", "stdlib/arches.trn"}));
  EXPECT_FALSE(result.sources->files[1].of_library);
  EXPECT_TRUE(result.sources->files[2].of_library);
}

}  // namespace
}  // namespace tranos::interp
