// SPDX-License-Identifier: GPL-3.0-or-later
// What calibrating tells of bad traces, and of traces, dimensions and priors that disagree.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "camera/calibrate.h"
#include "camera/trace_checks.h"
#include "tests/camera/comparison.h"
#include "tests/camera/scenes.h"

namespace tranos::camera {
namespace {

using benchmark::Cuboid;
using benchmark::CuboidOf;
using benchmark::Mentions;
using benchmark::TraceCuboid;
using benchmark::TracedCuboid;
using geom::ErrorCode;
using scenes::NumberList;
using scenes::Scene;
using scenes::Townhouse;

geom::Error ErrorOf(const Scene& scene) {
  const auto estimate = Calibrate(scene.photograph, scene.list.numbers());
  if (estimate) return {ErrorCode::kDegenerate, "none", -2};
  return estimate.error();
}

TEST(CalibrateErrors, TellsOfALineTracedTwice) {
  Scene scene = Townhouse();
  scene.photograph.traces.push_back(scene.photograph.traces[3]);
  const geom::Error error = ErrorOf(scene);
  EXPECT_EQ(error.part, static_cast<int>(scene.photograph.traces.size()) - 1);
  EXPECT_EQ(error.other, 3);
  EXPECT_NE(error.detail.find("the same as that of trace 4"), std::string::npos) << error.detail;
}

TEST(CalibrateErrors, EdgesAtTwoPlacesAreTwoThoughTheyLieOnEachOtherInThePicture) {
  Scene scene = Townhouse();
  scene.Edge({2, 0, 8.005}, {10, 0, 8.005});  // a third of a pixel above another
  EXPECT_EQ(ErrorOf(scene).part, -2) << ErrorOf(scene).detail;
  // The same edge once more, within noise.
  scene.Edge({0, 0, 8}, {10, 0, 8});
  std::get<EdgeTrace>(scene.photograph.traces.back()).line.a_px.y() += 1;
  EXPECT_EQ(ErrorOf(scene).other, 2);
}

TEST(CalibrateErrors, BlamesThePriorOfTheCameraThatIsOff) {
  Scene scene = Townhouse();
  scene.photograph.priors[kFocal] = {50, 0.1};
  const geom::Error error = ErrorOf(scene);
  EXPECT_EQ(error.part, -1);
  EXPECT_NE(error.detail.find("the prior of the focal length is farthest off"), std::string::npos)
      << error.detail;
}

// The townhouse with all its points of this height at that of an unknown.
geom::Result<std::vector<Estimate>> TownhouseOfHeight(const Unknown& height) {
  const Scene scene = Townhouse();
  return Calibrate(std::vector{scene.photograph}, std::vector{height},
                   [&](const Eigen::VectorXd& u) -> geom::Result<Numbers> {
                     Numbers numbers = scene.list.numbers(1);
                     for (Eigen::Index i = 2; i < 30; i += 3) {
                       if (numbers.values[i] != 8) continue;
                       numbers.values[i] = u[0];
                       numbers.by_unknown(i, 0) = 1;
                     }
                     return numbers;
                   });
}

TEST(CalibrateErrors, BlamesTheBoundOrTheDeviationThatIsOff) {
  const auto bound = TownhouseOfHeight({"height", 6.5, 0, 6, 7});
  ASSERT_FALSE(bound.has_value());
  EXPECT_NE(bound.error().detail.find("the bound of `height` is farthest off"), std::string::npos)
      << bound.error().detail;
  const auto stated = TownhouseOfHeight({"height", 6, 0.01});
  ASSERT_FALSE(stated.has_value());
  EXPECT_NE(stated.error().detail.find("`height` is farthest off"), std::string::npos)
      << stated.error().detail;
  // Fifteen traces, and then the unknown.
  EXPECT_EQ(stated.error().part, 15);
  EXPECT_TRUE(TownhouseOfHeight({"height", 6, 0}).has_value());
}

TEST(CalibrateErrors, TellsOfRectanglesTracedTheWrongWay) {
  Scene scene = Townhouse();
  auto& dots = std::get<RectangleTrace>(scene.photograph.traces[10]).dots_px;
  std::swap(dots[2], dots[3]);
  geom::Error error = ErrorOf(scene);
  EXPECT_EQ(error.part, 10);
  EXPECT_NE(error.detail.find("crosswise"), std::string::npos) << error.detail;
  std::swap(dots[2], dots[3]);
  std::swap(dots[1], dots[3]);
  error = ErrorOf(scene);
  EXPECT_EQ(error.part, 10);
  EXPECT_NE(error.detail.find("clockwise"), std::string::npos) << error.detail;
}

TEST(CalibrateErrors, TellsOfDimensionsThatAreNone) {
  for (const double length : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity()}) {
    Scene scene = Townhouse();
    const auto& rectangle = std::get<RectangleTrace>(scene.photograph.traces[10]);
    scene.list.values[rectangle.b] = length;
    const geom::Error error = ErrorOf(scene);
    EXPECT_EQ(error.code, ErrorCode::kOutOfRange) << length;
    EXPECT_EQ(error.part, 10) << length;
  }
}

TEST(CalibrateErrors, TellsOfLinesThatAreAllParallel) {
  Scene scene;
  scene.truth = Townhouse().truth;
  scene.truth[kPhi] = scene.truth[kOmega] = scene.truth[kKappa] = 0;
  scene.truth[kSkew] = kPi / 2;
  for (const double z : {0.0, 1.0, 3.0, 6.0}) scene.Direction({0, 0, z}, {10, 0, z}, 0);
  EXPECT_NE(ErrorOf(scene).detail.find("parallel"), std::string::npos);
}

TEST(CalibrateErrors, TellsOfDirectionsThatAreNotOrthogonal) {
  // The right wall's edges said to be along Y, and along X.
  Scene scene;
  scene.truth = Townhouse().truth;
  scene.Direction({10, 0, 0}, {10, 12, 0}, 1);
  scene.Direction({10, 0, 8}, {10, 12, 8}, 1);
  scene.Direction({10, 0, 3}, {10, 12, 3}, 0);
  scene.Direction({10, 0, 6}, {10, 12, 6}, 0);
  scene.Direction({0, 0, 0}, {0, 0, 8}, 2);
  const geom::Error error = ErrorOf(scene);
  EXPECT_EQ(error.part, 0);
  EXPECT_NE(error.detail.find("not orthogonal"), std::string::npos) << error.detail;
}

TEST(CalibrateErrors, TellsOfDimensionsThatDisagree) {
  // The gable's top is not 11 m high.
  Scene scene = Townhouse();
  const auto& top = std::get<PointTrace>(scene.photograph.traces[8]);
  scene.list.values[top.at + 2] += 0.3;
  const auto estimate = Calibrate(scene.photograph, scene.list.numbers());
  ASSERT_TRUE(estimate.has_value());
  ASSERT_TRUE(estimate->disagreement.has_value()) << estimate->chi2;
  EXPECT_TRUE(Mentions({estimate->disagreement->text}, "disagree"));
  EXPECT_TRUE(Mentions({estimate->disagreement->text}, "trace 9 is farthest off"));
  EXPECT_EQ(estimate->disagreement->part, 8);
  scene.list.values[top.at + 2] += 2;
  const geom::Error error = ErrorOf(scene);
  EXPECT_EQ(error.part, 8) << error.detail;
  EXPECT_NE(error.detail.find("disagree"), std::string::npos) << error.detail;
}

// Seven edges of a box in exact dots, one of them at a stated height that it does not have.
Scene BoxWithAWrongEdge(double stated_m) {
  Scene scene;
  scene.photograph.frame = {{36, 24.0075}, {1600, 1067}};
  scene.truth.parameters << 35, 1, 0, 0, 89 * kPi / 180, 12 * kPi / 180, 25 * kPi / 180,
      0.5 * kPi / 180, 22, -24, 2;
  const Vec3 corners[] = {{0, 0, 0}, {10, 0, 0}, {0, 0, 6}, {10, 0, 6}, {10, 14, 0}, {10, 14, 6}};
  for (const auto& [from, to] : {std::pair(0, 1), {0, 2}, {1, 3}, {1, 4}, {3, 5}, {4, 5}, {2, 3}}) {
    scene.Edge(corners[from], corners[to]);
  }
  const auto& wrong = std::get<EdgeTrace>(scene.photograph.traces[6]);
  scene.list.values[wrong.from + 2] = scene.list.values[wrong.to + 2] = stated_m;
  return scene;
}

TEST(CalibrateErrors, NamesTheTraceWithoutWhichAllAgree) {
  for (const double stated_m : {5.0, 7.0, 9.0}) {
    const geom::Error error = ErrorOf(BoxWithAWrongEdge(stated_m));
    EXPECT_EQ(error.part, 6) << stated_m << " m: " << error.detail;
    // Only one other edge shows a height at all; neither is better than the other.
    EXPECT_NE(error.detail.find("without trace 5 the rest agrees"), std::string::npos)
        << error.detail;
  }
}

// Seven edges that only just determine the camera, and rectangles with many residuals each, of
// which the one that is wrong draws the camera after it: each dot of it amiss, or its sides.
TEST(CalibrateErrors, NamesARectangleThoughItHasMoreResidualsThanAnEdge) {
  const scenes::Wall front{Vec3(0, 0, 0), 0, 0};
  const auto scene_of = [&](double a, double b) {
    Scene scene = BoxWithAWrongEdge(6);
    scene.Rectangle(front, 1.5, 1, 2, 3);
    scene.Rectangle(front, 6, 1, 2, 3);
    const auto& wrong = std::get<RectangleTrace>(scene.photograph.traces[8]);
    scene.list.values[wrong.a] = a;
    scene.list.values[wrong.b] = b;
    return scene;
  };
  for (const auto& [a, b] : {std::pair(2.6, 3.0), {3.0, 2.0}, {2.0, 2.2}}) {
    const geom::Error error = ErrorOf(scene_of(a, b));
    EXPECT_EQ(error.part, 8) << a << " m × " << b << " m: " << error.detail;
    EXPECT_EQ(error.detail.find("the rest agrees as well"), std::string::npos) << error.detail;
  }
  for (int dot = 0; dot < 4; ++dot) {
    for (const Vec2& amiss : {Vec2(30, 0), Vec2(0, -30), Vec2(-25, 25)}) {
      Scene scene = scene_of(2, 3);
      std::get<RectangleTrace>(scene.photograph.traces[8]).dots_px[dot] += amiss;
      const auto estimate = Calibrate(scene.photograph, scene.list.numbers());
      const int part = estimate ? estimate->disagreement->part : estimate.error().part;
      EXPECT_EQ(part, 8) << "dot " << dot << " by " << amiss.transpose();
    }
  }
}

TEST(CalibrateErrors, NamesTheUnknownThatDisagrees) {
  // Every edge has the height that it should have but for the stated mean, which is far off.
  const Cuboid& cuboid = CuboidOf("B4");
  TracedCuboid traced = TraceCuboid(cuboid, {.sigma_px = 0.1, .dimension_sigma = 0.01});
  const char* const names[] = {"width", "depth", "height"};
  for (int i = 0; i < 3; ++i) {
    std::vector<Unknown> unknowns = traced.unknowns;
    for (int k = 0; k < 3; ++k) {
      unknowns[k] = {names[k], cuboid.dimensions_m[k] * (k == i ? 1.1 : 1), 0.01};
    }
    // Of one photograph with a free camera any three dimensions agree.
    traced.photograph.priors[kAspect] = {cuboid.truth[kAspect], 1e-4};
    traced.photograph.priors[kSkew] = {cuboid.truth[kSkew], 1e-4};
    traced.photograph.priors[kPrincipalX] = {cuboid.truth[kPrincipalX], 1e-3};
    traced.photograph.priors[kPrincipalY] = {cuboid.truth[kPrincipalY], 1e-3};
    traced.photograph.priors[kFocal] = {cuboid.truth[kFocal], 1e-3};
    const auto estimates = Calibrate(std::vector{traced.photograph}, unknowns,
                                     [&](const Eigen::VectorXd& u) -> geom::Result<Numbers> {
                                       return benchmark::NumbersOf(cuboid, u, 3);
                                     });
    const std::string told =
        estimates ? estimates->front().disagreement->text : estimates.error().detail;
    EXPECT_NE(told.find(fmt::format("`{}` is farthest off", names[i])), std::string::npos) << told;
  }
}

TEST(CalibrateErrors, ErrorsCountTracesThroughThePhotographs) {
  const Scene sound = Townhouse();
  const auto traces = static_cast<int>(sound.photograph.traces.size());
  std::string told;
  const auto part_of = [&](const Scene& scene) {
    NumberList list = sound.list;
    const auto first = static_cast<int>(list.values.size());
    list.values.insert(list.values.end(), scene.list.values.begin(), scene.list.values.end());
    Photograph second = scene.photograph;
    second.name = "left";
    for (Trace& trace : second.traces) {
      if (auto* edge = std::get_if<EdgeTrace>(&trace)) edge->from += first, edge->to += first;
    }
    const auto estimates =
        Calibrate(std::vector{sound.photograph, second}, {},
                  [&](const Eigen::VectorXd&) -> geom::Result<Numbers> { return list.numbers(); });
    told = estimates ? "" : estimates.error().detail;
    return estimates ? -2 : estimates.error().part;
  };
  EXPECT_EQ(part_of(BoxWithAWrongEdge(7)), traces + 6);
  EXPECT_NE(told.find("trace 7 of `left` is farthest off"), std::string::npos) << told;
  Scene twice = BoxWithAWrongEdge(6);
  twice.photograph.traces.push_back(twice.photograph.traces[0]);
  EXPECT_EQ(part_of(twice), traces + 7);
  EXPECT_EQ(told.find("`left`: the line is the same as that of trace 1"), 0u) << told;
  EXPECT_EQ(part_of(BoxWithAWrongEdge(6)), -2);
}

TEST(CalibrateErrors, TellsThatTooLittleIsTraced) { EXPECT_NE(ErrorOf(Scene{}).part, -2); }

TEST(RepeatsALine, MarksTheLaterOfTwoThatLieOnEachOther) {
  const auto along = [](const Vec2& a, const Vec2& b, int axis) {
    return DirectionTrace{FitImageLine({a, b}, 0.5).value(), axis};
  };
  Photograph photograph;
  photograph.traces = {along({100, 100}, {500, 120}, 0), along({200, 105}, {400, 115}, 0),
                       along({200, 135}, {400, 145}, 0), along({100, 100}, {500, 120}, 1),
                       along({510, 120.5}, {600, 125}, 0)};
  EXPECT_EQ(RepeatsALine(photograph, {}), (std::vector{false, true, false, true, false}));
}

}  // namespace
}  // namespace tranos::camera
