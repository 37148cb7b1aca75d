// SPDX-License-Identifier: GPL-3.0-or-later
// create, construct, delete, drop, modify, choose; and Fig. 6 by its rows.
#include <cmath>

#include "drawing_board.h"

namespace tranos::interp {
namespace {

using geom::Vec3;
using model::TypeOf;

void DrawSquare(DrawingBoard& board) {
  const Vec3 corners[] = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    ASSERT_TRUE(board.Do("place line", {corners[i], corners[(i + 1) % 4]}));
  }
  ASSERT_TRUE(board.Do("choose all", Answers{}));
}

TEST(Fig6, IsTheConstructedDome) {
  DrawingBoard board;
  ASSERT_TRUE(board.Do("place line", {{0, 0, 0}, {10, 0, 0}}));
  ASSERT_TRUE(board.Do("choose element", {{5, 0, 0}}));
  ASSERT_TRUE(board.Do("copy", {{5, 0, 0}, {25, 0, 0}}));
  ASSERT_TRUE(board.Do("place arc", {{10, 0, 0}, {15, 0, 5}, {20, 0, 0}}));
  Answers parts;
  for (const model::ElementId id : {0u, 2u, 1u}) {
    parts.chosen.push_back(board.state.model.Current(id));
  }
  ASSERT_TRUE(board.Do("create chain", parts));
  EXPECT_EQ(board.state.model.live, 1u);
  EXPECT_NEAR(*model::Length(*board.Last()), 20 + 5 * geom::kPi, 1e-9);
  board.Set([](model::Settings& settings) { settings.angle_rad = geom::kPi / 2; });
  ASSERT_TRUE(board.Do("choose element", {{5, 0, 0}}));
  for (const Vec3& pivot : {Vec3(30, 0, 0), Vec3(30, -30, 0), Vec3(0, -30, 0)}) {
    ASSERT_TRUE(board.Do("rotate copy", {pivot}));
  }
  ASSERT_TRUE(board.Do("choose all", Answers{}));
  ASSERT_EQ(board.state.drawing.selection.size(), 4u);
  ASSERT_TRUE(board.Do("construct surface edge", Answers{}));
  EXPECT_EQ(board.state.model.live, 1u);
  EXPECT_NEAR(*model::Area(*board.Last()), 1236.08668, 1e-5);
  EXPECT_NEAR(model::BoundingBox(*board.Last()).max.z(), 10, 1e-9);
}

TEST(CreateShape, OfLinesIsAShapeAndConsumesThem) {
  DrawingBoard board;
  DrawSquare(board);
  ASSERT_TRUE(board.Do("create shape", Answers{}));
  EXPECT_EQ(TypeOf(*board.Last()), "shape");
  EXPECT_NEAR(*model::Area(*board.Last()), 16, 1e-9);
  EXPECT_EQ(board.state.model.live, 1u);
  EXPECT_TRUE(board.state.drawing.selection.empty());
}

TEST(CreateChain, KeepsItsPartsIfToldTo) {
  DrawingBoard board;
  DrawSquare(board);
  ASSERT_TRUE(board.Do("create chain", {}, {{"keep", model::Value::Boolean(true)}}));
  EXPECT_EQ(board.state.model.live, 5u);
}

TEST(CreateChain, SaysWhichPartDoesNotMeet) {
  DrawingBoard board;
  ASSERT_TRUE(board.Do("place line", {{0, 0, 0}, {4, 0, 0}}));
  ASSERT_TRUE(board.Do("place line", {{9, 0, 0}, {12, 0, 0}}));
  ASSERT_TRUE(board.Do("choose all", Answers{}));
  const auto result = board.Do("create chain", Answers{});
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, Code::kDoNotMeet);
  EXPECT_EQ(result.error().where.kind, Where::kChosen);
  EXPECT_EQ(result.error().where.index, 1);
}

TEST(Group, IsMadeAndDroppedWithoutLoss) {
  DrawingBoard board;
  DrawSquare(board);
  const model::Hash128 before = board.state.model.hash;
  ASSERT_TRUE(board.Do("create group", Answers{}));
  EXPECT_EQ(board.state.model.live, 1u);
  ASSERT_TRUE(board.Do("choose element", {{2, 0, 0}}));
  EXPECT_EQ(TypeOf(*board.state.model.Current(board.state.drawing.selection[0])), "group");
  ASSERT_TRUE(board.Do("drop", Answers{}));
  EXPECT_EQ(board.state.model.live, 4u);
  EXPECT_EQ(board.state.model.hash, before);
}

TEST(Group, CopiesByItself) {
  DrawingBoard board;
  DrawSquare(board);
  ASSERT_TRUE(board.Do("create group", Answers{}));
  board.ChooseLast();
  ASSERT_TRUE(board.Do("copy", {{0, 0, 0}, {10, 0, 0}}));
  ASSERT_TRUE(board.Do("drop", Answers{}));
  EXPECT_EQ(board.state.model.live, 5u);
  ASSERT_TRUE(board.Do("choose all", Answers{}));
  ASSERT_TRUE(board.Do("delete", Answers{}));
  EXPECT_EQ(board.state.model.live, 0u);
}

TEST(Drop, GivesAPlacedElementsPartsWhatThePlacementGave) {
  DrawingBoard board;
  model::Attributes plain, coloured;
  coloured.colour = {7};
  const auto part =
      model::MakeElement(model::kNoElement, model::Point{{1, 0, 0}},
                         std::make_shared<const model::Attributes>(plain), nullptr, {});
  const auto prototype = model::MakePrototype({"peg", {part}, {}, {}, {}, {}});
  geom::Affine world_from_prototype = geom::Affine::Identity();
  world_from_prototype.translation() = Vec3(0, 5, 0);
  model::Edit placing;
  placing.added.push_back(model::MakeElement(
      model::kNoElement,
      std::make_shared<const model::Instance>(model::Instance{prototype, world_from_prototype}),
      std::make_shared<const model::Attributes>(coloured), nullptr, {}));
  board.state = model::Apply(board.state, placing).state;
  board.ChooseLast();
  ASSERT_TRUE(board.Do("drop", Answers{}));
  EXPECT_EQ(TypeOf(*board.Last()), "point");
  EXPECT_EQ(board.Last()->attributes->colour.code, 7u);
  EXPECT_EQ(model::BoundingBox(*board.Last()).min, Vec3(1, 5, 0));
}

TEST(Modify, ChangesWhatIsNamedAlone) {
  DrawingBoard board;
  ASSERT_TRUE(board.Do("place point", {{0, 0, 0}}));
  board.ChooseLast();
  board.Set([](model::Settings& settings) {
    model::Attributes attributes;
    attributes.colour = {3};
    attributes.level = "roof";
    settings.attributes = std::make_shared<const model::Attributes>(attributes);
  });
  Answers colour_alone;
  colour_alone.words = {"Color"};
  ASSERT_TRUE(board.Do("modify", colour_alone));
  EXPECT_EQ(board.Last()->attributes->colour.code, 3u);
  EXPECT_EQ(board.Last()->attributes->level, "1");
  ASSERT_TRUE(board.Do("modify", Answers{}));
  EXPECT_EQ(board.Last()->attributes->level, "roof");
}

TEST(ConstructSurface, BackwardsTurnsTheOtherWay) {
  DrawingBoard board;
  ASSERT_TRUE(board.Do("place line", {{1, 0, 0}, {1, 0, 2}}));
  board.ChooseLast();
  ASSERT_TRUE(board.Do("construct surface revolution", {},
                       {{"from", model::Value::OfPoint({0, 0, 0})},
                        {"to", model::Value::OfPoint({0, 0, 1})},
                        {"angle", Degrees(-90)}}));
  const geom::Box box = model::BoundingBox(*board.Last());
  EXPECT_NEAR(box.min.y(), -1, 1e-9);
  EXPECT_NEAR(box.max.y(), 0, 1e-9);
}

TEST(ConstructSurface, NeedsOneWayOfSayingHowFar) {
  DrawingBoard board;
  ASSERT_TRUE(board.Do("place line", {{1, 0, 0}, {1, 2, 0}}));
  board.ChooseLast();
  EXPECT_EQ(board.ErrorOf("construct surface projection", {}), Code::kMissingValue);
  EXPECT_EQ(board.ErrorOf("construct surface projection", {},
                          {{"height", Metres(1)}, {"to", model::Value::OfPoint({0, 0, 1})}}),
            Code::kWrongWords);
  EXPECT_EQ(board.ErrorOf("construct surface projection", {}, {{"height", Metres(0)}}),
            Code::kDegenerate);
}

TEST(Choose, AddsAndDropsInOrderEachOnce) {
  DrawingBoard board;
  for (const double x : {0.0, 1.0, 2.0}) ASSERT_TRUE(board.Do("place point", {{x, 0, 0}}));
  ASSERT_TRUE(board.Do("choose element", {{2, 0, 0}}));
  ASSERT_TRUE(board.Do("choose add all", Answers{}));
  EXPECT_EQ(board.state.drawing.selection, (model::Selection{2, 0, 1}));
  ASSERT_TRUE(board.Do("choose drop element", {{0, 0, 0}}));
  EXPECT_EQ(board.state.drawing.selection, (model::Selection{2, 1}));
  Answers second;
  second.points = {{0, 0, 0}};
  second.answered = {true};
  second.first = false;
  ASSERT_TRUE(board.Do("choose element", second));
  EXPECT_EQ(board.state.drawing.selection, (model::Selection{2, 1, 0}));
}

TEST(ChooseFence, TellsInsideFromOverlap) {
  DrawingBoard board;
  ASSERT_TRUE(board.Do("place line", {{1, 1, 0}, {9, 1, 7}}));
  ASSERT_TRUE(board.Do("place circle", {{3, 3, 0}, {4, 3, 0}}));
  ASSERT_TRUE(board.Do("choose fence", {{0, 0, 0}, {5, 5, 0}}));
  EXPECT_EQ(board.state.drawing.selection, (model::Selection{1}));
  Answers overlap;
  overlap.points = {{0, 0, 0}, {5, 5, 0}};
  overlap.words = {"overlap"};
  ASSERT_TRUE(board.Do("choose fence", overlap));
  EXPECT_EQ(board.state.drawing.selection, (model::Selection{0, 1}));
  EXPECT_EQ(board.ErrorOf("choose fence", {{0, 0, 0}, {0, 5, 0}}), Code::kDegenerate);
}

TEST(SetPlane, KeepsItsXLevel) {
  DrawingBoard board;
  Answers front;
  front.words = {"front"};
  ASSERT_TRUE(board.Do("set plane", front));
  EXPECT_EQ(board.state.drawing.settings->plane.z(), Vec3(0, -1, 0));
  ASSERT_TRUE(board.Do("set plane", {}, {{"normal", model::Value::OfPoint({0, -3, 0})}}));
  EXPECT_LT((board.state.drawing.settings->plane.x - Vec3::UnitX()).norm(), 1e-12);
  EXPECT_EQ(board.ErrorOf("set plane", {},
                          {{"normal", model::Value::OfPoint({0, 0, 1})},
                           {"x", model::Value::OfPoint({0, 0, 2})}}),
            Code::kDegenerate);
}

TEST(Render, ChecksFormatAndSize) {
  DrawingBoard board;
  EXPECT_EQ(board.ErrorOf("render", {}, {{"file", model::Value::String("a.b/plan")}}),
            Code::kUnknownFormat);
  const model::Value huge = model::Value::List({Count(1e9), Count(480)});
  EXPECT_EQ(board.ErrorOf("render", {}, {{"size", huge}}), Code::kOutOfRange);
  const auto result = board.Do("render", {}, {{"file", model::Value::String("Plan.PNG")}});
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->edit.outputs.size(), 1u);
}

}  // namespace
}  // namespace tranos::interp
