// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "drawing_board.h"

namespace tranos::interp {
namespace {

using geom::Vec3;

TEST(Copy, LeavesTheCopyChosenWithoutTheName) {
  DrawingBoard board;
  ASSERT_TRUE(board.Do("place line", {{0, 0, 0}, {10, 0, 0}}));
  model::Edit naming;
  naming.replaced.push_back(model::WithName(*board.Last(), "sill"));
  board.state = model::Apply(board.state, naming).state;
  board.ChooseLast();
  const model::ElementId original = board.state.drawing.selection[0];
  ASSERT_TRUE(board.Do("copy", {{5, 0, 0}, {25, 0, 0}}));
  ASSERT_EQ(board.state.drawing.selection.size(), 1u);
  EXPECT_NE(board.state.drawing.selection[0], original);
  EXPECT_EQ(board.Last()->name_or_empty(), "");
  EXPECT_EQ(model::BoundingBox(*board.Last()).min.x(), 20);
  EXPECT_EQ(board.state.model.Current(original)->name_or_empty(), "sill");
}

TEST(Rotate, QuarterTurnsAreExact) {
  DrawingBoard board;
  board.Set([](model::Settings& settings) { settings.angle_rad = geom::kPi / 2; });
  ASSERT_TRUE(board.Do("place line", {{30, 0, 0}, {0, 0, 0}}));
  board.ChooseLast();
  ASSERT_TRUE(board.Do("rotate copy", {{30, 0, 0}}));
  const auto& line = std::get<geom::Line>(*std::get<model::CurvePtr>(board.Last()->geometry));
  EXPECT_EQ(line.start, Vec3(30, 0, 0));
  EXPECT_EQ(line.end, Vec3(30, -30, 0));
}

TEST(Mirror, IsItsOwnInverse) {
  DrawingBoard board;
  ASSERT_TRUE(board.Do("place arc", {{1, 2, 0}, {3, 5, 1}, {6, 2, 4}}));
  board.ChooseLast();
  const model::Hash128 before = board.Last()->hash;
  ASSERT_TRUE(board.Do("mirror", {{0, 0, 0}, {1, 2, 0}}));
  EXPECT_FALSE(board.Last()->hash == before);
  ASSERT_TRUE(board.Do("mirror", {{0, 0, 0}, {1, 2, 0}}));
  EXPECT_NEAR(*model::Length(*board.Last()), *model::Length(*board.state.model.Current(0)), 1e-12);
  const geom::Box box = model::BoundingBox(*board.Last());
  EXPECT_NEAR(box.min.x(), 1, 0.2);
}

TEST(Scale, RefusesZeroNegativeAndBeyondTheWorld) {
  DrawingBoard board;
  ASSERT_TRUE(board.Do("place line", {{1, 0, 0}, {1e6, 0, 0}}));
  board.ChooseLast();
  for (const double factor : {0.0, -1.0, 1e308, 1e4}) {
    board.Set([&](model::Settings& settings) { settings.scale = Vec3::Constant(factor); });
    EXPECT_EQ(board.ErrorOf("scale", {{0, 0, 0}}), Code::kOutOfRange) << factor;
  }
}

TEST(Transforms, NeedSomethingChosen) {
  for (const std::string_view words :
       {"copy", "move", "mirror", "mirror copy", "rotate", "rotate copy", "scale", "array polar"}) {
    DrawingBoard board;
    EXPECT_EQ(board.ErrorOf(words, {{0, 0, 0}, {1, 0, 0}}), Code::kNothingChosen) << words;
  }
}

TEST(Array, FullTurnDividesByCountAndLessHasOneAtEachEnd) {
  DrawingBoard board;
  ASSERT_TRUE(board.Do("place point", {{1, 0, 0}}));
  board.ChooseLast();
  ASSERT_TRUE(board.Do("array polar", {{0, 0, 0}}, {{"count", Count(4)}}));
  EXPECT_LT((model::BoundingBox(*board.Last()).min - Vec3(0, -1, 0)).norm(), 1e-12);
  ASSERT_TRUE(board.Do("array polar", {{0, 0, 0}}, {{"count", Count(3)}, {"angle", Degrees(90)}}));
  EXPECT_LT((model::BoundingBox(*board.Last()).min - Vec3(0, 1, 0)).norm(), 1e-12);
}

TEST(Array, AlongAnArcTurnsWithIt) {
  DrawingBoard board;
  ASSERT_TRUE(board.Do("place arc center", {{5, 0, 0}, {0, 0, 0}, {0, 5, 0}}));
  const model::Value path = model::Value::OfElement(board.Last());
  ASSERT_TRUE(board.Do("place line", {{5, 0, 0}, {6, 0, 0}}));
  board.ChooseLast();
  ASSERT_TRUE(board.Do("array path", {}, {{"path", path}, {"count", Count(3)}}));
  EXPECT_EQ(board.state.drawing.last.size(), 2u);
  const geom::Box box = model::BoundingBox(*board.Last());
  EXPECT_NEAR(box.max.y(), 6, 1e-6);
  EXPECT_NEAR(box.max.x(), 0, 1e-6);
}

TEST(Array, RefusesCountsThatMakeNothingOrTooMuch) {
  DrawingBoard board;
  ASSERT_TRUE(board.Do("place point", {{1, 0, 0}}));
  board.ChooseLast();
  for (const double count : {0.0, 1.0, 1e7, 1e300}) {
    EXPECT_EQ(board.ErrorOf("array polar", {{0, 0, 0}}, {{"count", Count(count)}}),
              Code::kOutOfRange);
    EXPECT_EQ(board.ErrorOf("array rectangular", {},
                            {{"columns", Count(count)}, {"column_spacing", Metres(1)}}),
              Code::kOutOfRange);
  }
}

}  // namespace
}  // namespace tranos::interp
