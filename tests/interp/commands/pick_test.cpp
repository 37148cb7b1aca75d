// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/pick.h"

#include <cmath>

#include "drawing_board.h"

namespace tranos::interp {
namespace {

using geom::Vec3;

TEST(Pick, TakesTheNearestWithinTheTolerance) {
  DrawingBoard board;
  EXPECT_EQ(Pick(board.state, {0, 0, 0}).element, nullptr);
  ASSERT_TRUE(board.Do("place line", {{0, 0, 0}, {10, 0, 0}}));
  ASSERT_TRUE(board.Do("place circle", {{5, 5, 0}, {8, 5, 0}}));
  const PickResult near = Pick(board.state, {5, 0.009, 0});
  EXPECT_TRUE(near.within);
  EXPECT_EQ(near.element->id, 0u);
  const PickResult edge = Pick(board.state, {5, 1.9, 0});
  EXPECT_FALSE(edge.within);
  EXPECT_EQ(edge.element->id, 1u);
  EXPECT_NEAR(edge.distance_m, 0.1, 1e-9);
}

TEST(Pick, PrefersPointThenCurveThenSurfaceWhereTheyTie) {
  DrawingBoard board;
  ASSERT_TRUE(board.Do("place point", {{2, 0, 0}}));
  ASSERT_TRUE(board.Do("place line", {{0, 0, 0}, {4, 0, 0}}));
  ASSERT_TRUE(board.Do("place line", {{0, 0, 0}, {4, 0, 0}}));
  board.ChooseLast();
  ASSERT_TRUE(board.Do("construct surface projection", {}, {{"height", Metres(3)}}));
  EXPECT_EQ(model::TypeOf(*Pick(board.state, {2, 0, 0}).element), "point");
  EXPECT_FALSE(Pick(board.state, {2, 0, 0}).ambiguous);
  EXPECT_EQ(model::TypeOf(*Pick(board.state, {3, 0, 0}).element), "line");
  EXPECT_EQ(model::TypeOf(*Pick(board.state, {3, 0, 2}).element), "surface");
}

TEST(Pick, TakesTheOneMadeLastWithAWarning) {
  DrawingBoard board;
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(board.Do("place line", {{0, 0, 0}, {4, 0, 0}}));
  const PickResult pick = Pick(board.state, {1, 0, 0});
  EXPECT_TRUE(pick.ambiguous);
  EXPECT_EQ(pick.element->id, 2u);
  const auto chosen = board.Do("choose element", {{1, 0, 0}});
  ASSERT_TRUE(chosen.has_value());
  ASSERT_EQ(chosen->warnings.size(), 1u);
  EXPECT_EQ(chosen->warnings[0].code, Code::kAmbiguousPick);
}

TEST(Pick, PassesOverLevelsThatAreOff) {
  DrawingBoard board;
  ASSERT_TRUE(board.Do("place point", {{0, 0, 0}}));
  board.SetLevel("roof");
  ASSERT_TRUE(board.Do("place point", {{0, 0, 0}}));
  EXPECT_EQ(Pick(board.state, {0, 0, 0}).element->id, 1u);
  Answers roof;
  roof.words = {"roof"};
  ASSERT_TRUE(board.Do("level off", roof));
  EXPECT_EQ(Pick(board.state, {0, 0, 0}).element->id, 0u);
  ASSERT_TRUE(board.Do("level on", roof));
  EXPECT_EQ(Pick(board.state, {0, 0, 0}).element->id, 1u);
}

// The bounds never lose the nearest one: against measuring every element.
TEST(Pick, AgreesWithMeasuringEverything) {
  DrawingBoard board;
  for (int i = 0; i < 60; ++i) {
    const double a = std::fmod(i * 7.31, 20), b = std::fmod(i * 3.17, 20),
                 c = std::fmod(i * 1.7, 3);
    switch (i % 4) {
      case 0:
        board.Do("place circle", {{a, b, c}, {a + 1 + c, b, c}});
        break;
      case 1:
        board.Do("place line", {{a, b, c}, {b, a + 1, 0}});
        break;
      case 2:
        board.Do("place arc", {{a, b, 0}, {a + 1, b, 1 + c}, {a + 2, b, 0}});
        break;
      default:
        board.Do("place block", {{a, b, c}, {a + 2, b + 1, c}});
    }
    if (i % 12 == 7) {
      board.ChooseLast();
      ASSERT_TRUE(board.Do("construct surface projection", {}, {{"height", Metres(2)}}));
    }
  }
  ASSERT_GE(board.state.model.live, 60u);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p(std::fmod(i * 5.77, 24) - 2, std::fmod(i * 2.39, 24) - 2, std::fmod(i * 0.9, 4));
    double nearest = 1e9;
    board.state.model.ForEach([&](const model::ElementPtr& element) {
      nearest = std::min(nearest, model::NearestPoint(*element, p).distance_m);
    });
    EXPECT_NEAR(Pick(board.state, p).distance_m, nearest, 2e-9);
  }
}

}  // namespace
}  // namespace tranos::interp
