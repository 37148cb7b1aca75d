// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>

#include "drawing_board.h"

namespace tranos::interp {
namespace {

using geom::Vec3;
using model::Length;

geom::Frame Front() { return {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitZ()}; }

TEST(PlaceArc, AboutItsCentreByPointOrAngle) {
  DrawingBoard board;
  ASSERT_TRUE(board.Do("place arc center", {{5, 0, 0}, {0, 0, 0}, {0, 9, 0}}));
  EXPECT_NEAR(*Length(*board.Last()), 2.5 * geom::kPi, 1e-9);
  Answers clockwise;
  clockwise.points = {{5, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  clockwise.answered = {true, true, false};
  clockwise.keys = {{"angle", Degrees(-90)}};
  ASSERT_TRUE(board.Do("place arc center", clockwise));
  EXPECT_NEAR(model::BoundingBox(*board.Last()).min.y(), -5, 1e-9);
  clockwise.keys = {{"angle", Degrees(400)}};
  const auto result = board.Do("place arc center", clockwise);
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, Code::kOutOfRange);
}

TEST(PlaceCircle, LiesInTheActivePlane) {
  DrawingBoard board;
  board.Set([](model::Settings& settings) { settings.plane = Front(); });
  ASSERT_TRUE(board.Do("place circle", {{0, 1, 0}, {2, 1, 0}}));
  EXPECT_NEAR(model::BoundingBox(*board.Last()).max.z(), 2, 1e-9);
  EXPECT_EQ(board.ErrorOf("place circle", {{0, 1, 0}, {2, 2, 0}}), Code::kNotPlanar);
  EXPECT_EQ(board.ErrorOf("place circle", {{0, 1, 0}, {0, 1, 0}}), Code::kDegenerate);
}

TEST(PlaceBlock, RunsAnticlockwiseFromTheFirstCorner) {
  DrawingBoard board;
  ASSERT_TRUE(board.Do("place block", {{4, 0, 1}, {0, 3, 1}}));
  const auto& curve = *std::get<model::CurvePtr>(board.Last()->geometry);
  const auto& vertices = std::get<geom::Polyline>(curve).vertices;
  ASSERT_EQ(vertices.size(), 4u);
  EXPECT_EQ(vertices[0], Vec3(4, 0, 1));
  EXPECT_EQ(vertices[2], Vec3(0, 3, 1));
  double turned = 0;
  for (std::size_t i = 0; i < 4; ++i) turned += vertices[i].cross(vertices[(i + 1) % 4]).z();
  EXPECT_NEAR(turned / 2, 12, 1e-12);
}

TEST(PlaceShape, TakesAClosingPointAndRefusesWhatEnclosesNothing) {
  DrawingBoard board;
  ASSERT_TRUE(board.Do("place shape", {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 0, 0}}));
  EXPECT_NEAR(*model::Area(*board.Last()), 6, 1e-9);
  EXPECT_EQ(board.ErrorOf("place shape", {{0, 0, 0}, {4, 0, 0}, {0, 0, 0}}), Code::kDegenerate);
  EXPECT_EQ(board.ErrorOf("place shape", {{0, 0, 0}, {4, 0, 0}, {4, 0, 0}, {0, 3, 0}}),
            Code::kDegenerate);
  EXPECT_FALSE(board.Do("place shape", {{0, 0, 0}, {4, 0, 0}, {8, 0, 0}}).has_value());
}

TEST(PlaceText, IsUnderActiveAngleAndScale) {
  DrawingBoard board;
  board.Set([](model::Settings& settings) {
    settings.angle_rad = geom::kPi / 2;
    settings.scale = Vec3::Constant(2);
  });
  ASSERT_TRUE(board.Do("place text", {{1, 1, 0}},
                       {{"text", model::Value::String("nave")}, {"height", Metres(0.5)}}));
  const auto& text = *std::get<model::TextPtr>(board.Last()->geometry);
  EXPECT_EQ(text.content, "nave");
  EXPECT_NEAR(text.height_m, 1, 1e-12);
  EXPECT_LT((text.frame.x - Vec3::UnitY()).norm(), 1e-12);
  EXPECT_EQ(board.ErrorOf("place text", {{1, 1, 0}}), Code::kMissingValue);
  EXPECT_EQ(board.ErrorOf("place text", {{1, 1, 0}},
                          {{"text", model::Value::String("x")}, {"height", Metres(-1)}}),
            Code::kOutOfRange);
}

// Whatever finite numbers are keyed in: an error, or an element of finite extent.
TEST(Place, IsTotal) {
#ifdef TRANOS_SANITIZED  // a quarter of the pairs, for each takes ten times as long
  const double extremes[] = {0, 1, -1e-9, 1e9, -1e308};
#else
  const double extremes[] = {0, 1, -1, 1e-320, 1e-9, 1e9, -1e9, 1e154, 1e308, -1e308};
#endif
  std::size_t made = 0, refused = 0;
  for (const Command& row : AllCommands()) {
    if (row.family != "place" || !row.execute) continue;
    for (const double a : extremes) {
      for (const double b : extremes) {
        DrawingBoard board;
        const std::vector<Vec3> points = {{a, b, 0}, {b, a, 0}, {a, a, b}, {b, b, a}};
        const std::size_t count = row.manner == Manner::kGathers ? 3 : row.prompts.size();
        const auto result =
            board.Do(row.words, {points.begin(), points.begin() + static_cast<long>(count)},
                     {{"text", model::Value::String("x")}, {"radius", Metres(b)}});
        ++(result ? made : refused);
        if (!result) continue;
        const geom::Box box = model::BoundingBox(*board.Last());
        EXPECT_TRUE(box.min.allFinite() && box.max.allFinite()) << row.words << a << " " << b;
      }
    }
  }
  EXPECT_GT(made, 100u);
  EXPECT_GT(refused, 100u);
}

}  // namespace
}  // namespace tranos::interp
