// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras of real photographs under the same assumptions for every one; README.md has the tables.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/camera/real/facades.h"

namespace tranos::camera::real {
namespace {

// Under sanitizers, which take twenty times as long, lines are sought on one photograph in eight,
// and figures, being of all, are not asked for.
#ifdef TRANOS_SANITIZED
constexpr bool kFewPhotographs = true;
#else
constexpr bool kFewPhotographs = false;
#endif
std::vector<Known> SearchedForLines(const std::vector<Known>& photographs) {
  std::vector<Known> searched;
  for (std::size_t i = 0; i < photographs.size(); i += kFewPhotographs ? 8 : 1) {
    searched.push_back(photographs[i]);
  }
  return searched;
}

class RealPhotographs : public testing::Test {
 protected:
  void SetUp() override {
    if (!data_) GTEST_SKIP() << "skipped: no test photographs";
  }
  const std::filesystem::path& data() const { return *data_; }

 private:
  std::optional<std::filesystem::path> data_ = DataFolder();
};

// DESIGN.md's figures for detected segments of 102 such photographs with these priors.
TEST_F(RealPhotographs, OfYorkGiveTheFocalLengthWithinAFewPerCent) {
  const std::vector<Known> known = YorkUrban(data());
  ASSERT_EQ(known.size(), 51u);
  for (const Loss loss : {Loss::kNone, Loss::kHuber, Loss::kCauchy}) {
    const auto errors = FocalErrors(FoundCameras(known, loss), known, Loose::kCounts);
    EXPECT_LE(Quantile(errors, 0.5), 0.025);
    EXPECT_LE(Quantile(errors, 0.75), 0.048);
    EXPECT_LE(Quantile(errors, 0.9), 0.082);
  }
}

TEST_F(RealPhotographs, OfYorkMostlyTellTheFocalLengthWithinAFifthOfIt) {
  const std::vector<Known> known = YorkUrban(data());
  const std::vector<Found> found = FoundCameras(known);
  const auto errors = FocalErrors(found, known, Loose::kInfinite);
  EXPECT_LE(std::ranges::count_if(found, &Found::is_loose), 4);
  EXPECT_LE(Quantile(errors, 0.5), 0.025);
  EXPECT_LE(Quantile(errors, 0.75), 0.048);
  EXPECT_LE(Quantile(errors, 0.9), 0.13);
}

TEST_F(RealPhotographs, GiveTheSameFocalLengthWhetherPlaceAndScaleAreKnownOrNot) {
  for (const Known& known : YorkUrban(data())) {
    const Found without = FoundCamera(TracedDirections(known), Loss::kNone);
    const Found with = FoundCamera(TracedEdges(known), Loss::kNone);
    ASSERT_TRUE(without.is_found && with.is_found) << known.name;
    EXPECT_NEAR(without.focal_px, with.focal_px, 0.01 * with.sigma_px) << known.name;
  }
}

// Where the focal length is loose, a facade is seen from the front or nearly so: two of the three
// vanishing points are far away, and what is left does not tell.
TEST_F(RealPhotographs, OfYorkThatLeaveTheFocalLengthLooseAreFrontal) {
  const std::vector<Known> known = YorkUrban(data());
  const std::vector<Found> found = FoundCameras(known);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!found[i].is_loose()) continue;
    // The camera's axis, in the world: near one of the horizontal directions.
    const Vec3 axis = known[i].camera_from_world.row(2).cwiseAbs();
    EXPECT_GT(axis.head<2>().maxCoeff(), std::cos(20 * kPi / 180)) << found[i].name;
  }
}

TEST_F(RealPhotographs, OfTheCastleGiveFocalLengthAndRotation) {
  const std::vector<Known> known = Castle(data());
  ASSERT_EQ(known.size(), 8u);
  const std::vector<Found> found = FoundCameras(known);
  EXPECT_LE(Quantile(FocalErrors(found, known, Loose::kCounts), 0.5), 0.02);
  EXPECT_LE(Quantile(UprightErrors(found, known), 0.5), 0.35);
  EXPECT_LE(Quantile(RotationErrors(found, known), 0.5), 0.5);
  EXPECT_LE(Quantile(RelativeRotationErrors(found, known), 0.5), 0.55);
  EXPECT_GE(Coverage(found, known), 7.0 / 8);
}

TEST_F(RealPhotographs, OfFspyGiveItsCameraUnderItsAssumptions) {
  const Known known = ShiftedLandscape(data());
  for (const auto& camera : {SquareByOrthocentre(known), SquareByLikelihood(known)}) {
    ASSERT_TRUE(camera);
    EXPECT_NEAR(camera->focal_px, 1976.23, 0.001 * 1976.23);
    EXPECT_NEAR(camera->focal_px, known.focal_px, 1e-3);
    // fSpy counts from the picture's corner, half a dot before the middle of the first.
    EXPECT_NEAR(camera->principal_px.x() + 0.5, 1813.05, 0.5);
    EXPECT_NEAR(camera->principal_px.y() + 0.5, 907.21, 0.5);
    EXPECT_LT((camera->principal_px - known.principal_px).norm(), 1e-3);
  }
}

TEST_F(RealPhotographs, OfATowerGiveTheSameCameraAsAnIndependentSolution) {
  const Known known = Tower(data());
  for (const auto& camera : {SquareByOrthocentre(known), SquareByLikelihood(known)}) {
    ASSERT_TRUE(camera);
    EXPECT_NEAR(camera->focal_px, known.focal_px, 2e-3);
    EXPECT_LT((camera->principal_px - known.principal_px).norm(), 2e-3);
  }
}

// Nothing traced by hand. What docs/camera.md tells, a photograph or two less.
TEST_F(RealPhotographs, OfYorkGiveTheirDirectionsByTheLinesFoundOnThem) {
  Errors found, true_directions;
  for (const Known& known : SearchedForLines(YorkUrban(data()))) {
    const auto lines = DetectLines(PhotoOf(known));
    ASSERT_TRUE(lines) << known.name;
    const auto directions = FindVanishingDirections(*lines, known.frame);
    ASSERT_TRUE(directions) << known.name;
    found.Add(FoundCamera(TracedLines(known, *lines, directions->axis)), known);
    true_directions.Add(FoundCamera(TracedLines(known, *lines, AxesByLabels(known, *lines))),
                        known);
  }
  if (kFewPhotographs) return;
  EXPECT_GE(found.DirectionsWithin(2), 0.80);
  EXPECT_GE(found.DirectionsWithin(5), 0.93);
  EXPECT_GE(found.HorizonArea(0.25), 0.91);
  EXPECT_GE(found.HorizonArea(0.25), true_directions.HorizonArea(0.25) - 0.01);
  EXPECT_LE(Quantile(found.focal, 0.5), 0.033);
}

TEST_F(RealPhotographs, OfTheCastleGiveTheirCamerasByTheLinesFoundOnThem) {
  const std::vector<Known> castle = SearchedForLines(Castle(data()));
  std::vector<Found> found;
  for (const Known& known : castle) {
    const auto lines = DetectLines(PhotoOf(known));
    ASSERT_TRUE(lines) << known.name;
    const auto directions = FindVanishingDirections(*lines, known.frame);
    ASSERT_TRUE(directions) << known.name;
    found.push_back(FoundCamera(TracedLines(known, *lines, directions->axis)));
  }
  if (kFewPhotographs) return;
  EXPECT_LE(Quantile(FocalErrors(found, castle, Loose::kCounts), 0.5), 0.03);
  EXPECT_LE(Quantile(UprightErrors(found, castle), 0.5), 0.8);
  EXPECT_LE(Quantile(RotationErrors(found, castle, 4), 0.5), 1.2);
}

TEST_F(RealPhotographs, OfStreetFrontsMakeBoxesOfTheirWindows) {
  double filled = 0;
  std::size_t windows = 0;
  for (const Front& front : Fronts(data())) {
    const auto lines = DetectLines(PhotoOf(front.photograph));
    ASSERT_TRUE(lines) << front.photograph.name;
    const auto directions = FindVanishingDirections(*lines, front.photograph.frame);
    ASSERT_TRUE(directions) << front.photograph.name;
    const Found found = FoundCamera(TracedLines(front.photograph, *lines, directions->axis));
    const Mat3 front_from_dot = FrontFromDot(front.photograph, found, *lines, directions->axis);
    for (const auto& window : front.windows) filled += BoxFilled(window, front_from_dot);
    windows += front.windows.size();
  }
  EXPECT_GE(filled / static_cast<double>(windows), 0.9);
}

}  // namespace
}  // namespace tranos::camera::real
