// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/difference.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "runs.h"
#include "session/correspondence.h"

namespace tranos::session {

namespace {

using testing::DoubleNear;
using testing::HasSubstr;

const ElementChange& Only(const Difference& difference) {
  EXPECT_EQ(difference.changes.size(), 1U);
  return difference.changes.at(0);
}

TEST(Diff, TellsALengthBeforeAndAfter) {
  const Difference difference = DiffOf("place line xy=0,0 dl=10", "place line xy=0,0 dl=12");
  const ElementChange& change = Only(difference);
  EXPECT_EQ(change.kind, ElementChange::kChanged);
  EXPECT_THAT(change.before.length_m.value(), DoubleNear(10, 1e-12));
  EXPECT_THAT(change.after.length_m.value(), DoubleNear(12, 1e-12));
  EXPECT_THAT(change.largest_m.value(), DoubleNear(2, 1e-12));
  EXPECT_FALSE(change.after.volume_m3.has_value());
}

TEST(Diff, MeasuresTheLargestDistanceOfAGrownCircle) {
  const Difference difference =
      DiffOf("place circle radius=1 xy=0,0", "place circle radius=1.5 xy=0,0");
  EXPECT_THAT(Only(difference).largest_m.value(), DoubleNear(0.5, 1e-12));
}

TEST(Diff, MeasuresARegionThatGrewOrMoved) {
  const std::string make = "place circle radius=1 xy=0,0 as eye; create region of=[rim, eye]";
  const Difference grown = DiffOf("place circle radius=5 xy=0,0 as rim\n" + make,
                                  "place circle radius=6 xy=0,0 as rim\n" + make);
  EXPECT_THAT(Only(grown).largest_m.value(), DoubleNear(1, 1e-9));
  const std::string ring = "place circle radius=5 xy=0,0 as rim\n" + make + " as ring\n";
  const Difference moved = DiffOf(ring, ring + "move of=ring xy=0,0 dl=3");
  EXPECT_EQ(Only(moved).kind, ElementChange::kMoved);
}

TEST(Diff, TellsWhatIsTurnedAsMoved) {
  const Difference difference =
      DiffOf("place shape xy=0,0 dl=4 dl=0,3 reset", "place shape xy=0,0 dl=0,4 dl=-3 reset");
  const ElementChange& change = Only(difference);
  EXPECT_EQ(change.kind, ElementChange::kMoved);
  EXPECT_FALSE(change.by_m.has_value());
  EXPECT_THAT(change.largest_m.value(), DoubleNear(std::hypot(7, 1), 1e-9));
}

TEST(Diff, TellsParametersOfPlacedElementsWithTheirDefaults) {
  const std::string define =
      "define place gate width : length = 2m { place block xy=0,0 xy=width,3 }\n";
  const Difference difference =
      DiffOf(define + "place gate xy=0,0", define + "place gate width=2.5 xy=0,0");
  const ElementChange& change = Only(difference);
  ASSERT_EQ(change.parameters.size(), 1U);
  EXPECT_EQ(change.parameters[0].name, "width");
  EXPECT_EQ(change.parameters[0].before, "2m");
  EXPECT_EQ(change.parameters[0].after, "2.5m");
  EXPECT_THAT(change.before.area_m2.value(), DoubleNear(6, 1e-12));
}

TEST(Diff, DescribesWhatIsTooLongToWrite) {
  const std::string define =
      "define place row marks : list of number = [0] { for x in marks { place point xy=x,0 } }\n";
  const Difference difference = DiffOf(define + "place row marks=[1, 2] xy=0,0",
                                       define + "place row marks=range(1, 2000) xy=0,0");
  const ElementChange& change = Only(difference);
  ASSERT_EQ(change.parameters.size(), 1U);
  EXPECT_EQ(change.parameters[0].before, "[1,2]");
  EXPECT_THAT(change.parameters[0].after, testing::StartsWith("a list of "));
}

TEST(Diff, FollowsFilesThatAreUsed) {
  const std::string script = "use \"lib.trn\"\nplace gate xy=0,0\nplace point xy=9,9";
  const auto a = RecordOf("a.trn", script, {},
                          {{"lib.trn", "define place gate { place block xy=0,0 xy=1,1 }"}});
  const auto b = RecordOf("a.trn", script, {},
                          {{"lib.trn", "define place gate { place block xy=0,0 xy=1,2 }"}});
  EXPECT_EQ(Summary(Diff(a, b)), "changed gate\n");
}

TEST(Diff, CountsWhatIsEqual) {
  const Difference difference =
      DiffOf("place point xy=0,0 xy=1,0 xy=2,0", "place point xy=0,0 xy=1,0 xy=2,5");
  EXPECT_EQ(difference.equal, 2U);
  EXPECT_EQ(DiffOf("place point xy=0,0", "place point xy=0,0").equal, 1U);
}

TEST(Diff, OfNothingAndSomething) {
  EXPECT_EQ(Summary(DiffOf("", "place point xy=0,0")), "added point\n");
  EXPECT_EQ(Summary(DiffOf("place point xy=0,0", "# nothing")), "removed point\n");
  EXPECT_EQ(Summary(DiffOf("", "")), "equal\n");
}

TEST(RenderText, SaysNameDistanceParametersMeasuresAndPlaces) {
  const Difference difference =
      DiffOf("place circle radius=1 xy=0,0 as rim", "# new\nplace circle radius=2 xy=0,0 as rim");
  EXPECT_EQ(
      RenderText(difference),
      "changed  circle `rim` by up to 1 m: radius 1m -> 2m, length 6.28318531 -> 12.5663706 m, "
      "area 3.14159265 -> 12.5663706 m2  [a.trn:1 -> b.trn:2]\n"
      "0 added, 0 removed, 0 moved, 1 changed, 0 equal\n");
  EXPECT_EQ(RenderText(DiffOf("place point xy=0,0", "place point  xy=0,0")),
            "no difference in effect\n");
}

TEST(RenderText, SaysTheTurnOfEachLoop) {
  const std::string loops = "for i = 1 to 2 { for j = 4 to 5 { place point xy=i,j } }";
  EXPECT_THAT(RenderText(DiffOf("", loops)), HasSubstr("added    point  [b.trn:1 turn 2, 4]\n"));
}

TEST(RenderJson, IsOneObjectInMetres) {
  const auto json = nlohmann::json::parse(
      RenderJson(DiffOf("un=cm\nplace point xy=0,0 as p", "un=cm\nplace point xy=50,0 as p")));
  ASSERT_EQ(json["changes"].size(), 1U);
  const auto& change = json["changes"][0];
  EXPECT_EQ(change["change"], "moved");
  EXPECT_EQ(change["name"], "p");
  EXPECT_EQ(change["type"], "point");
  EXPECT_EQ(change["by_m"], nlohmann::json({0.5, 0.0, 0.0}));
  EXPECT_EQ(change["place_after"]["line"], 2);
  EXPECT_EQ(change["measures_after"]["length"], nullptr);
  EXPECT_EQ(change["parameters"][0]["before"], "0m,0m,0m");
}

model::ElementPtr Made(model::Geometry geometry) {
  return model::MakeElement(0, std::move(geometry), std::make_shared<const model::Attributes>(),
                            nullptr, {});
}

TEST(RigidDisplacement, IsOfTheSameShapeOnly) {
  const auto line = [](double length) {
    return Made(std::make_shared<const geom::Curve>(
        geom::Line{geom::Vec3::Zero(), geom::Vec3(length, 0, 0)}));
  };
  EXPECT_TRUE(RigidDisplacement(*line(1), *line(1)).has_value());
  EXPECT_FALSE(RigidDisplacement(*line(1), *line(1.001)).has_value());
  EXPECT_FALSE(RigidDisplacement(*line(1), *Made(model::Point{geom::Vec3::Zero()})).has_value());
}

TEST(RigidDisplacement, IsNoMirrorImage) {
  const auto string = [](double z) {
    geom::Polyline polyline;
    polyline.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 0, z}};
    return Made(std::make_shared<const geom::Curve>(polyline));
  };
  EXPECT_FALSE(RigidDisplacement(*string(5), *string(-5)).has_value());
}

TEST(LargestDistance, IsNothingBetweenThingsOfDifferentKinds) {
  const auto line = Made(
      std::make_shared<const geom::Curve>(geom::Line{geom::Vec3::Zero(), geom::Vec3(1, 0, 0)}));
  EXPECT_FALSE(LargestDistance(*line, *Made(model::Point{geom::Vec3::Zero()})).has_value());
}

}  // namespace

}  // namespace tranos::session
