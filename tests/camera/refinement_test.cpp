// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/refinement.h"

#include <gtest/gtest.h>

#include "camera/likelihood.h"
#include "tests/camera/scenes.h"

namespace tranos::camera {
namespace {

using benchmark::Cuboid;
using benchmark::CuboidOf;
using benchmark::Cuboids;
using benchmark::TraceCuboid;
using benchmark::TracedCuboid;

NumbersOfUnknowns Fixed(const Numbers& numbers) {
  return [numbers](const Eigen::VectorXd&) -> geom::Result<Numbers> { return numbers; };
}

geom::Result<Refined> RefineFrom(const std::vector<Photograph>& photographs,
                                 const std::vector<Unknown>& unknowns,
                                 const NumbersOfUnknowns& numbers_of, const Camera& start,
                                 const RefineOptions& options = {}) {
  const Layout layout = LayoutOf(photographs, unknowns);
  Eigen::VectorXd u(unknowns.size());
  for (std::size_t i = 0; i < unknowns.size(); ++i) u[static_cast<int>(i)] = unknowns[i].start;
  const geom::Result<Numbers> numbers = numbers_of(u);
  const std::vector<Camera> cameras(photographs.size(), start);
  return Refine(photographs, unknowns, layout, numbers_of,
                StartState(photographs, layout, *numbers, cameras, u), options);
}

TEST(Refinement, AgreesWithTheCameraAlone) {
  for (const Cuboid& cuboid : Cuboids()) {
    if (!cuboid.determined()) continue;
    for (const std::uint64_t seed : {1, 2, 3}) {
      const TracedCuboid traced = TraceCuboid(cuboid, {.sigma_px = 0.5, .seed = seed});
      const CameraFit alone = FitCamera(traced.photograph, traced.numbers, cuboid.truth);
      const auto joint = RefineFrom({traced.photograph}, {}, Fixed(traced.numbers), cuboid.truth);
      ASSERT_TRUE(joint.has_value());
      EXPECT_NEAR(joint->chi2, alone.chi2, 1e-9 * alone.chi2);
      for (int i = 0; i < kParameters; ++i) {
        const double value = alone.camera.parameters[i];
        // The principal point by the frame's width: 1e-8 mm is what rounding of dots leaves of it.
        const bool in_frame = i == kPrincipalX || i == kPrincipalY;
        const double size = in_frame ? 36 : std::max(1.0, std::abs(value));
        EXPECT_NEAR(joint->state[i], value, 1e-9 * size)
            << cuboid.name << " " << kParameterNames[i];
      }
    }
  }
}

TEST(Refinement, FindsEverythingOfAnExactScene) {
  const scenes::Scene scene = scenes::Townhouse();
  Camera start = scene.truth;
  start[kFocal] += 2, start[kPhi] += 0.05, start[kX0] += 0.5, start[kY0] -= 1;
  const auto refined = RefineFrom({scene.photograph}, {}, Fixed(scene.list.numbers()), start);
  ASSERT_TRUE(refined.has_value());
  EXPECT_LT(refined->chi2, 1e-16);
  for (int i = 0; i < kParameters; ++i) {
    EXPECT_NEAR(refined->state[i], scene.truth.parameters[i],
                1e-8 * std::max(1.0, std::abs(scene.truth.parameters[i])))
        << kParameterNames[i];
  }
}

// A cuboid whose three dimensions are not known, but for what is stated of them.
struct Free {
  const Cuboid& cuboid;
  TracedCuboid traced;
  int calls = 0;
  std::vector<Eigen::VectorXd> points;

  NumbersOfUnknowns numbers_of() {
    return [this](const Eigen::VectorXd& u) -> geom::Result<Numbers> {
      ++calls;
      points.push_back(u);
      return benchmark::NumbersOf(cuboid, u, 3);
    };
  }
};

Free FreeCuboid(const char* name, double sigma_px, double dimension_sigma) {
  const Cuboid& cuboid = CuboidOf(name);
  return {
      cuboid,
      TraceCuboid(cuboid, {.sigma_px = sigma_px, .seed = 4, .dimension_sigma = dimension_sigma}),
      0,
      {}};
}

TEST(Refinement, EvaluatesUnknownsOnceAtEachPoint) {
  Free free = FreeCuboid("B1", 0.5, 0.02);
  const auto refined = RefineFrom({free.traced.photograph}, free.traced.unknowns, free.numbers_of(),
                                  free.cuboid.truth);
  ASSERT_TRUE(refined.has_value());
  for (std::size_t i = 2; i < free.points.size(); ++i)
    EXPECT_NE(free.points[i], free.points[i - 1]);
  EXPECT_LT(free.calls, 40);
}

TEST(Refinement, IsTheSameEachTime) {
  Free free = FreeCuboid("B4", 0.5, 0.02);
  const auto once = RefineFrom({free.traced.photograph}, free.traced.unknowns, free.numbers_of(),
                               free.cuboid.truth);
  const auto again = RefineFrom({free.traced.photograph}, free.traced.unknowns, free.numbers_of(),
                                free.cuboid.truth);
  ASSERT_TRUE(once.has_value() && again.has_value());
  EXPECT_EQ(once->state, again->state);
}

TEST(Refinement, AnUnknownStaysWithinItsBoundsAndTellsWhenItIsHeld) {
  Free free = FreeCuboid("B1", 0.1, 0.02);
  std::vector<Unknown> unknowns = free.traced.unknowns;
  // The depth without a prior, kept below the truth, 14 m.
  unknowns[1] = {"depth", 12, 0, 10, 13};
  const auto held =
      RefineFrom({free.traced.photograph}, unknowns, free.numbers_of(), free.cuboid.truth);
  ASSERT_TRUE(held.has_value());
  EXPECT_NEAR(held->state[kParameters + 1], 13, 1e-6);
  EXPECT_TRUE(held->at_bound[1]);
  EXPECT_FALSE(held->at_bound[0]);
  unknowns[1].max = 20;
  const auto free_of_it =
      RefineFrom({free.traced.photograph}, unknowns, free.numbers_of(), free.cuboid.truth);
  ASSERT_TRUE(free_of_it.has_value());
  EXPECT_FALSE(free_of_it->at_bound[1]);
  EXPECT_LT(free_of_it->chi2, held->chi2);
}

TEST(Refinement, ARobustLossDoubtsTheWrongTrace) {
  scenes::Scene scene = scenes::Townhouse();
  auto& wrong = std::get<EdgeTrace>(scene.photograph.traces[2]);
  wrong.line.a_px.y() += 40;
  for (const Loss loss : {Loss::kHuber, Loss::kCauchy}) {
    RefineOptions options;
    options.loss = loss;
    const auto robust =
        RefineFrom({scene.photograph}, {}, Fixed(scene.list.numbers()), scene.truth, options);
    ASSERT_TRUE(robust.has_value());
    for (std::size_t i = 0; i < robust->weights.size(); ++i) {
      EXPECT_EQ(robust->weights[i] < 0.5, i == 2) << "trace " << i;
    }
  }
  const auto plain = RefineFrom({scene.photograph}, {}, Fixed(scene.list.numbers()), scene.truth);
  RefineOptions cauchy;
  cauchy.loss = Loss::kCauchy;
  const auto robust =
      RefineFrom({scene.photograph}, {}, Fixed(scene.list.numbers()), scene.truth, cauchy);
  EXPECT_LT(std::abs(robust->state[kFocal] - scene.truth[kFocal]),
            0.1 * std::abs(plain->state[kFocal] - scene.truth[kFocal]));
}

TEST(Refinement, TellsWhyTheNumbersCannotBeHad) {
  Free free = FreeCuboid("B1", 0.5, 0.02);
  const auto fails = [](const Eigen::VectorXd&) -> geom::Result<Numbers> {
    return tl::unexpected(geom::Error{geom::ErrorCode::kOutOfRange, "a negative radius", 3});
  };
  const Layout layout = LayoutOf(std::vector{free.traced.photograph}, free.traced.unknowns);
  const auto refined = Refine(std::vector{free.traced.photograph}, free.traced.unknowns, layout,
                              fails, Eigen::VectorXd::Ones(layout.columns));
  ASSERT_FALSE(refined.has_value());
  EXPECT_EQ(refined.error().detail, "a negative radius");
}

TEST(Refinement, TwoPhotographsOfOneBuildingShareItsUnknowns) {
  // Each picture alone needs a dimension; the height is known in neither, the width in both.
  const scenes::Scene first = scenes::Townhouse();
  scenes::Scene second;
  second.truth = first.truth;
  second.truth[kPhi] = -0.3, second.truth[kX0] = -6, second.truth[kOmega] = 0.1;
  second.Edge({0, 0, 0}, {10, 0, 0});
  second.Edge({0, 0, 8}, {10, 0, 8});
  second.Edge({0, 0, 0}, {0, 0, 8});
  second.Edge({0, 0, 8}, {0, 12, 8});
  second.Edge({10, 0, 0}, {10, 0, 8});
  second.Edge({0, 12, 0}, {0, 12, 8});
  second.Edge({0, 0, 0}, {0, 12, 0});
  scenes::NumberList all = first.list;
  const int shift = static_cast<int>(all.values.size());
  all.values.insert(all.values.end(), second.list.values.begin(), second.list.values.end());
  for (Trace& trace : second.photograph.traces) {
    auto& edge = std::get<EdgeTrace>(trace);
    edge.from += shift, edge.to += shift;
  }
  const std::vector<Photograph> photographs{first.photograph, second.photograph};
  const Layout layout = LayoutOf(photographs, {});
  Camera near_first = first.truth, near_second = second.truth;
  near_first[kFocal] += 1, near_second[kX0] += 1;
  const std::vector<Camera> cameras{near_first, near_second};
  const auto refined = Refine(photographs, {}, layout, Fixed(all.numbers()),
                              StartState(photographs, layout, all.numbers(), cameras, {}));
  ASSERT_TRUE(refined.has_value());
  EXPECT_NEAR(refined->state[kFocal], first.truth[kFocal], 1e-8);
  EXPECT_NEAR(refined->state[kParameters + kX0], second.truth[kX0], 1e-8);
}

}  // namespace
}  // namespace tranos::camera
