// SPDX-License-Identifier: GPL-3.0-or-later
// The standard library keeps to stdlib/README.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "interp/command.h"
#include "interp/format.h"
#include "interp/run.h"
#include "stdlib/texts.h"

namespace tranos::interp {
namespace {

// The elements that stand in a family's file; a definition within a body is none.
std::vector<const Definition*> DefinitionsOf(const Program& program, const LibraryFamily& family) {
  std::vector<const Definition*> definitions;
  for (const Definition& definition : program.definitions) {
    const SourceText& source = program.sources->files[definition.span.file];
    if (source.path == family.path() && StandardLibrary().Defining(definition.words) == &family)
      definitions.push_back(&definition);
  }
  return definitions;
}

std::string Underscored(std::string words) {
  words.erase(0, words.find(' ') + 1);
  std::replace(words.begin(), words.end(), ' ', '_');
  return words;
}

class StandardLibraryTest : public ::testing::TestWithParam<std::string> {
 protected:
  const LibraryFamily& family_ = *StandardLibrary().Named(GetParam());
};

TEST_P(StandardLibraryTest, BindsWithoutAWord) {
  const Bound bound = BindFamily(StandardLibrary(), family_);
  for (const Diagnostic& diagnostic : bound.diagnostics.list())
    ADD_FAILURE() << RenderText(diagnostic, *bound.program->sources, false);
}

TEST_P(StandardLibraryTest, IsInTheOneLayout) {
  Sources sources;
  sources.files.push_back(MakeSource(family_.path(), std::string(family_.text)));
  Diagnostics diagnostics;
  const SyntaxTree tree = Parse(sources, 0, {200}, &diagnostics);
  ASSERT_FALSE(diagnostics.has_errors());
  EXPECT_EQ(Format(sources.files[0], tree), family_.text) << "tranos fmt " << family_.path();
}

TEST_P(StandardLibraryTest, EveryElementIsFoundByItsWords) {
  const Bound bound = BindFamily(StandardLibrary(), family_);
  std::set<std::string> found, listed;
  for (const Definition* definition : DefinitionsOf(*bound.program, family_))
    found.insert(definition->words);
  for (const std::string& words : StandardLibrary().Words()) {
    if (StandardLibrary().Defining(words) == &family_) listed.insert(words);
    EXPECT_EQ(FindCommand(words), nullptr) << words << " is a command already";
  }
  EXPECT_EQ(found, listed);
}

TEST_P(StandardLibraryTest, EveryElementDeclaresWhatDrivesHelpAndSoak) {
  const Bound bound = BindFamily(StandardLibrary(), family_);
  for (const Definition* definition : DefinitionsOf(*bound.program, family_)) {
    SCOPED_TRACE(definition->words);
    EXPECT_TRUE(definition->summary.ends_with('.')) << "the doc string is a sentence";
    bool has_detail = false;
    for (const DefinedParameter& parameter : definition->parameters) {
      EXPECT_FALSE(parameter.summary.empty()) << parameter.name << " says nothing of itself";
      EXPECT_FALSE(parameter.standard.empty()) << parameter.name << " has no default";
      if (parameter.name != "detail") continue;
      has_detail = true;
      EXPECT_TRUE(HasWord(parameter.words, "plan"));
      // What elements share for their plans has no other detail.
      EXPECT_TRUE(HasWord(parameter.words, "shell") || parameter.standard == "plan");
    }
    EXPECT_TRUE(has_detail);
  }
}

INSTANTIATE_TEST_SUITE_P(Families, StandardLibraryTest, ::testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const LibraryFamily& family : StandardLibrary().families())
                             names.push_back(family.name);
                           return names;
                         }()),
                         [](const auto& family) { return family.param; });

TEST(Facts, BelongToAnElementEach) {
  std::set<std::string> elements, facts;
  for (const std::string& words : StandardLibrary().Words()) elements.insert(Underscored(words));
  for (const stdlib::Text& text : stdlib::Facts()) facts.insert(std::string(text.name));
  EXPECT_EQ(elements, facts);
}

}  // namespace
}  // namespace tranos::interp
