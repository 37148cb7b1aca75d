// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/determination.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/camera/scenes.h"

namespace tranos::camera {
namespace {

using Kind = Quantity::Kind;

Eigen::MatrixXd RandomRows(int rows, int columns, std::uint64_t seed) {
  scenes::Noise noise(seed);
  Eigen::MatrixXd m(rows, columns);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) m(i, j) = 10 * noise.Draw();
  }
  return m;
}

const std::vector<Quantity> kThree = {{Kind::kLimited, 1, "focal length"},
                                      {Kind::kLimited, 1, "skew"},
                                      {Kind::kPosition, 1, "position"}};

TEST(Determination, OfFullRankIsTheInverseOfTheInformation) {
  const Eigen::MatrixXd j = RandomRows(9, 3, 1);
  const Determination d = Determine(j, 9, kThree);
  EXPECT_EQ(d.by_data, std::vector<bool>({true, true, true}));
  EXPECT_EQ(d.free_directions, 0);
  EXPECT_TRUE(d.undetermined.empty());
  const Eigen::MatrixXd inverse = (j.transpose() * j).inverse();
  EXPECT_LT((d.covariance - inverse).norm(), 1e-12 * inverse.norm());
}

TEST(Determination, OnlySumsAreSeen) {
  // Focal length and skew appear as their sum alone; the position is seen by itself.
  Eigen::MatrixXd j = RandomRows(9, 3, 2);
  j.col(1) = j.col(0);
  const Determination d = Determine(j, 9, kThree);
  EXPECT_EQ(d.by_data, std::vector<bool>({false, false, true}));
  EXPECT_EQ(d.free_directions, 1);
  ASSERT_EQ(d.undetermined.size(), 1u);
  EXPECT_EQ(d.undetermined[0].find("focal length and skew trade off"), 0u);
  EXPECT_EQ(d.covariance(0, 0), 0);
  EXPECT_GT(d.covariance(2, 2), 0);
}

TEST(Determination, APriorFixesWhatTheDataDoNot) {
  Eigen::MatrixXd j = RandomRows(10, 3, 3);
  j.col(1) = j.col(0);
  j.row(9) << 0, 1 / 0.01, 0;
  const Determination d = Determine(j, 9, kThree);
  EXPECT_EQ(d.by_data, std::vector<bool>({false, false, true}));
  EXPECT_EQ(d.with_priors, std::vector<bool>({true, true, true}));
  EXPECT_NEAR(std::sqrt(d.covariance(1, 1)), 0.01, 1e-12);
  EXPECT_EQ(d.undetermined.size(), 1u);
}

TEST(Determination, ADeviationAboveItsLimitIsNotDetermined) {
  Eigen::MatrixXd j = Eigen::MatrixXd::Identity(3, 3);
  j(0, 0) = 1 / 0.9, j(1, 1) = 1 / 1.1, j(2, 2) = 1e-3;
  // 0.9 and 1.1 of what may be; a position has no limit.
  const Determination d = Determine(j, 3, kThree);
  EXPECT_TRUE(d.by_data[0]);
  EXPECT_FALSE(d.by_data[1]);
  EXPECT_EQ(d.free_directions, 0);
  j(1, 1) = 2;
  EXPECT_EQ(Determine(j, 3, kThree).by_data, std::vector<bool>({true, true, true}));
}

// The limits are those of data alone (LANGUAGE.md section 8): a prior gives a number with whatever
// deviation is left, unless that is as large as the number.
TEST(Determination, APriorFixesWhatItLeavesUncertain) {
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(4, 3);
  j(0, 0) = 1 / 0.9, j(1, 1) = 1e-3, j(2, 2) = 2, j(3, 1) = 1 / 4.0;
  const Determination d = Determine(j, 3, kThree);
  EXPECT_EQ(d.by_data, std::vector<bool>({true, false, true}));
  EXPECT_EQ(d.with_priors, std::vector<bool>({true, true, true}));
  EXPECT_NEAR(std::sqrt(d.covariance(1, 1)), 4, 1e-3);
  EXPECT_EQ(d.undetermined.size(), 1u);
  j(3, 1) = 1 / 6.0;
  EXPECT_EQ(Determine(j, 3, kThree).with_priors, std::vector<bool>({true, false, true}));
}

TEST(Determination, WhatNothingSeesIsFree) {
  Eigen::MatrixXd j = RandomRows(2, 3, 5);
  j.col(2).setZero();
  const Determination d = Determine(j, 2, kThree);
  EXPECT_EQ(d.by_data, std::vector<bool>({true, true, false}));
  ASSERT_EQ(d.undetermined.size(), 1u);
  EXPECT_EQ(d.undetermined[0].find("position is not seen"), 0u);
}

// What closes one group of quantities does not close another: each is told with what does.
TEST(Determination, ScaleIsToldApartFromTheCamerasOwn) {
  std::vector<Quantity> quantities = kThree;
  quantities.push_back({Kind::kUnknown, 1, "`width`"});
  Eigen::MatrixXd j = RandomRows(9, 4, 7);
  j.col(1) = j.col(0), j.col(3) = j.col(2);
  const Determination d = Determine(j, 9, quantities);
  EXPECT_EQ(d.undetermined, std::vector<std::string>(
                                {"focal length and skew trade off: a second independent ratio or a "
                                 "third dimension closes it",
                                 "position and `width` trade off: a known length, or a deviation "
                                 "of the unknown, closes it"}));
}

TEST(Determination, WhatScaleAccountsForIsNoPartOfTheCamerasOwn) {
  std::vector<Quantity> quantities = kThree;
  quantities.push_back({Kind::kUnknown, 1, "`width`"});
  // Along (1, 1, 0, 1) the camera is open, along (0, 0, 1, 1) scale: together they leave out
  // `width`.
  Eigen::MatrixXd open(4, 2);
  open << 1, 0, 1, 0, 0, 1, 1, 1;
  const Eigen::MatrixXd seen = open.transpose().fullPivLu().kernel();
  const Determination d = Determine(RandomRows(9, 2, 10) * seen.transpose(), 9, quantities);
  ASSERT_EQ(d.undetermined.size(), 2u);
  EXPECT_EQ(d.undetermined[0].find("focal length, skew and position trade off: a second"), 0u);
  EXPECT_EQ(d.undetermined[1].find("position and `width` trade off: a known length"), 0u);
}

TEST(Determination, AnUnknownThatTheCameraHangsOnIsToBeKnown) {
  std::vector<Quantity> quantities = kThree;
  quantities.push_back({Kind::kUnknown, 1, "`depth`"});
  Eigen::MatrixXd j = RandomRows(9, 4, 8);
  j.col(3) = j.col(0);
  EXPECT_EQ(
      Determine(j, 9, quantities).undetermined,
      std::vector<std::string>({"focal length and `depth` trade off: a known length, a second "
                                "independent ratio, or a deviation of `depth` closes it"}));
  // Two directions and one unknown: its value would leave one of them open.
  j.col(1) = j.col(0);
  EXPECT_EQ(Determine(j, 9, quantities).undetermined,
            std::vector<std::string>({"focal length, skew and `depth` trade off: a second "
                                      "independent ratio or a third dimension closes it"}));
}

TEST(Determination, WhatNothingTracedDependsOnIsToBeTraced) {
  std::vector<Quantity> quantities = kThree;
  quantities.push_back({Kind::kUnknown, 1, "`depth`"});
  Eigen::MatrixXd j = RandomRows(9, 4, 9);
  j.col(3).setZero();
  EXPECT_EQ(Determine(j, 9, quantities).undetermined,
            std::vector<std::string>({"`depth` is not seen by anything traced: a trace of what "
                                      "depends on it, or a deviation of the unknown, closes it"}));
}

TEST(Determination, UnitsDoNotMatter) {
  // The same problem in millimetres and kilometres.
  const Eigen::MatrixXd j = RandomRows(9, 3, 6);
  std::vector<Quantity> other = kThree;
  const Eigen::Vector3d units(1e-3, 1e3, 1e6);
  for (int i = 0; i < 3; ++i) other[i].scale = 1 / units[i];
  const Determination a = Determine(j, 9, kThree), b = Determine(j * units.asDiagonal(), 9, other);
  EXPECT_EQ(a.by_data, b.by_data);
  const Eigen::MatrixXd back = units.asDiagonal() * b.covariance * units.asDiagonal();
  EXPECT_LT((a.covariance - back).norm(), 1e-12 * a.covariance.norm());
}

}  // namespace
}  // namespace tranos::camera
