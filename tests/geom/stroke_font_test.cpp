// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/stroke_font.h"

#include "shapes.h"

namespace tranos::geom {
namespace {

TEST(StrokeFont, CapitalsStandOnTheBaseLineAndAreAsHighAsSaid) {
  const Box box = BoundingBox(Text{"H", {}, 2.1});
  EXPECT_NEAR(box.min.y(), 0, 1e-12);
  EXPECT_NEAR(box.max.y(), 2.1, 1e-12);
}

TEST(StrokeFont, LettersFollowOneAnother) {
  EXPECT_GT(BoundingBox(Text{"HH", {}, 1}).max.x(), 1.8 * BoundingBox(Text{"H", {}, 1}).max.x());
  EXPECT_EQ(Strokes(Text{"HH", {}, 1}).size(), 2 * Strokes(Text{"H", {}, 1}).size());
}

TEST(StrokeFont, EveryPrintableCharacterHasItsOwnShape) {
  const auto box = Strokes(Text{"\xc3\xa9", {}, 1});
  ASSERT_EQ(box.size(), 1u);
  EXPECT_EQ(box[0].front(), box[0].back());
  for (char c = '!'; c <= '~'; ++c) {
    const auto strokes = Strokes(Text{std::string(1, c), {}, 1});
    EXPECT_FALSE(strokes.empty()) << c;
    EXPECT_NE(strokes, box) << c;
  }
}

TEST(StrokeFont, BlankTextHasNoStrokesAndABoxAtItsOrigin) {
  Text blank{"  ", {}, 1};
  blank.frame.origin = {1, 2, 3};
  EXPECT_TRUE(Strokes(blank).empty());
  EXPECT_EQ(BoundingBox(blank).min, Vec3(1, 2, 3));
}

TEST(StrokeFont, BytesThatAreNotUtf8AreBoxes) {
  EXPECT_EQ(Strokes(Text{"\xff\xc3", {}, 1}).size(), 2u);
  EXPECT_EQ(Strokes(Text{"\xe2\x82\xac", {}, 1}).size(), 1u);
}

RC_GTEST_PROP(StrokeFont, TextIsCarriedAlongByASimilarity, ()) {
  const Text text{"Aq 7", DrawFrame(), Within(0.1, 3)};
  const double scale = Within(0.1, 5);
  const Affine m = Moved(scale * DrawRotation(), DrawPoint());
  const auto before = Strokes(text), after = Strokes(Transformed(text, m));
  RC_ASSERT(before.size() == after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    for (std::size_t k = 0; k < before[i].size(); ++k) {
      RC_ASSERT((m * before[i][k] - after[i][k]).norm() < 1e-10);
    }
  }
}

}  // namespace
}  // namespace tranos::geom
