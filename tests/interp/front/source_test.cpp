// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/source.h"

#include <gtest/gtest.h>

namespace tranos::interp {
namespace {

TEST(Source, ColumnsCountCodePoints) {
  const SourceText source = MakeSource("a.trn", "let a = 1\nlet é日 = 2\n");
  const auto place = source.PlaceOf(static_cast<std::uint32_t>(source.text.find("= 2")));
  EXPECT_EQ(place.line, 2u);
  EXPECT_EQ(place.column, 8u);
}

TEST(Source, LinesComeWithoutTheirEnds) {
  const SourceText source = MakeSource("a.trn", "one\r\ntwo\n\nfour");
  EXPECT_EQ(source.Line(1), "one");
  EXPECT_EQ(source.Line(2), "two");
  EXPECT_EQ(source.Line(3), "");
  EXPECT_EQ(source.Line(4), "four");
  EXPECT_EQ(source.Line(5), "");
}

TEST(Source, AByteOrderMarkHasNoColumn) {
  const SourceText source = MakeSource("a.trn", "\xef\xbb\xbflet a = 1");
  EXPECT_EQ(source.PlaceOf(3).column, 1u);
  EXPECT_EQ(source.Line(1), "let a = 1");
  EXPECT_EQ(source.PlaceOf(0).line, 1u);
}

TEST(Source, TheEndOfTheTextHasAPlace) {
  const SourceText source = MakeSource("a.trn", "ab\n");
  EXPECT_EQ(source.PlaceOf(3).line, 2u);
  EXPECT_EQ(source.PlaceOf(3).column, 1u);
}

TEST(Source, FindsTheFirstByteThatIsNotUtf8) {
  constexpr auto kNone = std::string_view::npos;
  EXPECT_EQ(FirstInvalidUtf8(""), kNone);
  EXPECT_EQ(FirstInvalidUtf8("plain ascii of some length"), kNone);
  EXPECT_EQ(FirstInvalidUtf8("\xc3\xa9\xe6\x97\xa5\xf0\x9f\x8f\x9b"), kNone);
  EXPECT_EQ(FirstInvalidUtf8("abcdefghij\xff"), 10u);
  EXPECT_EQ(FirstInvalidUtf8("ab\xc3"), 2u);            // cut off
  EXPECT_EQ(FirstInvalidUtf8("\xc0\xaf"), 0u);          // overlong
  EXPECT_EQ(FirstInvalidUtf8("\xe0\x80\xaf"), 0u);      // overlong
  EXPECT_EQ(FirstInvalidUtf8("x\xed\xa0\x80"), 1u);     // a surrogate
  EXPECT_EQ(FirstInvalidUtf8("\xf4\x90\x80\x80"), 0u);  // beyond U+10FFFF
  EXPECT_EQ(FirstInvalidUtf8("\xf0\x8f\xbf\xbf"), 0u);  // overlong
  EXPECT_EQ(FirstInvalidUtf8("\x80"), 0u);              // a continuation alone
}

}  // namespace
}  // namespace tranos::interp
