// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/residuals.h"

#include <gtest/gtest.h>

#include "camera/adjustment.h"
#include "tests/camera/scenes.h"

namespace tranos::camera {
namespace {

using scenes::Scene;
using scenes::Townhouse;

struct Joint {
  std::vector<Photograph> photographs;
  std::vector<Unknown> unknowns;
  Layout layout;
  Numbers numbers;
  Eigen::VectorXd state;
};

Joint JointOf(const Scene& scene) {
  Joint joint{{scene.photograph}, {}, {}, scene.list.numbers(), {}};
  joint.layout = LayoutOf(joint.photographs, joint.unknowns);
  const std::vector<Camera> cameras{scene.truth};
  joint.state = StartState(joint.photographs, joint.layout, joint.numbers, cameras, {});
  return joint;
}

Linearised At(const Joint& joint, const Eigen::VectorXd& state) {
  return *Linearise(joint.photographs, joint.unknowns, joint.layout, joint.numbers, state);
}

TEST(Residuals, OfExactTracesVanish) {
  const Joint joint = JointOf(Townhouse());
  // Facades, and what is on them, are found from the dots: 2° apart in azimuth, as the true ones.
  EXPECT_LT(At(joint, joint.state).residuals.cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Residuals, OfExactTracesVanishWhereARectangleFixesTheWorld) {
  Scene scene;
  scene.truth.parameters << 34, 1.02, 0.4, -0.7, 1.55, 0.15, 0.4, 0.02, 16, -24, 1.7;
  const scenes::Wall front{Vec3(0, 0, 0), 0, 0}, east{Vec3(12, 1, 0), kPi / 2, 1};
  scene.Rectangle(front, 0, 0, 2, 3);
  scene.Rectangle(front, 4, 1, 1, 2);
  scene.Circle(front, 7, 4, 1, 6);
  scene.Rectangle(east, 3, 1, 1, 2);
  const Joint joint = JointOf(scene);
  EXPECT_EQ(joint.layout.facade_column[0], -1);
  EXPECT_LT(At(joint, joint.state).residuals.cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_NEAR(joint.state[joint.layout.facade_column[1]], kPi / 2, 1e-9);
  // The east front is x = 12, left of the way along it.
  EXPECT_NEAR(joint.state[joint.layout.facade_column[1] + 1], -12, 1e-9);
}

// Away from the truth, so that no residual is zero.
Eigen::VectorXd Disturbed(const Eigen::VectorXd& state) {
  Eigen::VectorXd moved = state;
  scenes::Noise noise(5);
  for (int i = 0; i < moved.size(); ++i) moved[i] += 0.003 * noise.Draw();
  return moved;
}

TEST(Residuals, DerivativesAgreeWithDifferences) {
  const Joint joint = JointOf(Townhouse());
  const Eigen::VectorXd state = Disturbed(joint.state);
  const Linearised at = At(joint, state);
  const double step = 1e-5;
  for (int c = 0; c < joint.layout.columns; ++c) {
    Eigen::VectorXd more = state, less = state;
    more[c] += step, less[c] -= step;
    const Eigen::VectorXd difference =
        (At(joint, more).residuals - At(joint, less).residuals) / (2 * step);
    const double size = std::max(1.0, difference.cwiseAbs().maxCoeff());
    for (int r = 0; r < joint.layout.rows(); ++r) {
      EXPECT_NEAR(at.jacobian(r, c), difference[r], 2e-6 * size) << "row " << r << " column " << c;
    }
  }
}

// With each number an unknown of its own.
void ExpectDerivativesByNumbers(Joint joint, std::span<const NumberIndex> given_planes) {
  const Eigen::VectorXd known = Disturbed(joint.state);
  const auto n = static_cast<int>(joint.numbers.values.size());
  joint.unknowns.resize(n);
  for (int i = 0; i < n; ++i) joint.unknowns[i] = {"n", joint.numbers.values[i]};
  joint.numbers.by_unknown = Eigen::MatrixXd::Identity(n, n);
  joint.layout = LayoutOf(joint.photographs, joint.unknowns, given_planes);
  Eigen::VectorXd state(joint.layout.columns);
  state << known.head<kParameters>(), joint.numbers.values, known.tail(known.size() - kParameters);
  const Linearised at = At(joint, state);
  const double step = 1e-5;
  for (int i = 0; i < n; ++i) {
    Joint more = joint, less = joint;
    more.numbers.values[i] += step, less.numbers.values[i] -= step;
    const Eigen::VectorXd difference =
        (At(more, state).residuals - At(less, state).residuals) / (2 * step);
    const Eigen::VectorXd exact = at.jacobian.col(joint.layout.unknown_column() + i);
    EXPECT_LT((exact - difference).cwiseAbs().maxCoeff(),
              2e-6 * std::max(1.0, difference.cwiseAbs().maxCoeff()))
        << "number " << i;
  }
}

TEST(Residuals, DerivativesByNumbersAgreeWithDifferences) {
  ExpectDerivativesByNumbers(JointOf(Townhouse()), {});
}

TEST(Residuals, OfAFacadeWhosePlaneIsGivenHangOnItsNumbers) {
  Scene scene = Townhouse();
  const NumberIndex azimuth = scene.list.Add(kPi / 2);
  scene.list.Add(-10.0);  // the distance of x = 10, to the left of the way along it
  const std::vector<NumberIndex> given_planes{-1, azimuth};
  Joint joint{{scene.photograph}, {}, {}, scene.list.numbers(), {}};
  joint.layout = LayoutOf(joint.photographs, joint.unknowns, given_planes);
  EXPECT_EQ(joint.layout.facade_column[1], -1);
  const std::vector<Camera> cameras{scene.truth};
  joint.state = StartState(joint.photographs, joint.layout, joint.numbers, cameras, {});
  EXPECT_LT(At(joint, joint.state).residuals.cwiseAbs().maxCoeff(), 1e-8);
  ExpectDerivativesByNumbers(joint, given_planes);
}

TEST(Residuals, AnEdgeIsJudgedByItsInfiniteLine) {
  const Scene scene = Townhouse();
  const View view = ViewOf(scene.truth.parameters, scene.photograph.frame);
  const Vec3 from(0, 0, 0), to(10, 0, 0);
  const Vec2 a = scene.Dot(from), b = scene.Dot(to);
  const Vec2 along = (b - a).normalized(), right(-along.y(), along.x());
  // Slid along by any length and moved across by 3 px and 4 px at its ends.
  const ImageLine line{a + 77 * along + 3 * right, b + 77 * along + 4 * right, 0.5, 2.0};
  const auto residuals = EdgeResiduals(view, line, from, to);
  EXPECT_NEAR(residuals[0].value, 3.5 / 0.5, 1e-9);
  EXPECT_NEAR(residuals[1].value, 1.0 / 2.0, 1e-9);
}

TEST(Residuals, ADirectionAgreesWithItsEdgeWhenTheEdgesPlaceIsFree) {
  // Let the edge slide within the plane square to its direction: the least χ² left of its two
  // residuals is what its direction alone has to pay, to first order.
  const Scene scene = Townhouse();
  ParameterVector parameters = scene.truth.parameters;
  parameters[kPhi] += 1e-4, parameters[kOmega] -= 7e-5, parameters[kFocal] += 1e-3;
  const View view = ViewOf(parameters, scene.photograph.frame);
  const struct {
    Vec3 from, to;
    int axis;
  } cases[] = {{{0, 0, 8}, {10, 0, 8}, 0}, {{10, 0, 8}, {10, 12, 8}, 1}, {{0, 0, 0}, {0, 0, 8}, 2}};
  for (const auto& [from, to, axis] : cases) {
    const ImageLine line = scenes::LineOf(scene.Dot(from), scene.Dot(to), 0.5);
    const auto edge = EdgeResiduals(view, line, from, to);
    // Moving both ends alike by d across the direction.
    Eigen::Matrix<double, 2, 2> by_slide;
    Vec2 value;
    for (int i = 0; i < 2; ++i) {
      const Vec3 g = edge[i].by_point[0] + edge[i].by_point[1];
      by_slide.row(i) << g[(axis + 1) % 3], g[(axis + 2) % 3];
      value[i] = edge[i].value;
    }
    // Only one combination of slides moves the line across the picture.
    Eigen::JacobiSVD<Eigen::Matrix2d> svd(by_slide, Eigen::ComputeFullU);
    const double left = std::abs(svd.matrixU().col(1).dot(value));
    const double direction = std::abs(DirectionResidual(view, line, Vec3::Unit(axis)).value);
    EXPECT_NEAR(direction, left, 1e-3 * left + 1e-6) << "axis " << axis;
    EXPECT_GT(direction, 1e-4);
  }
}

TEST(Residuals, ADirectionIsSoundAtInfinity) {
  // Looking straight at the front, lines along X are parallel to the picture's.
  Camera camera;
  camera.parameters << 35, 1, 0, 0, kPi / 2, 0, 0, 0, 0, -20, 0;
  const Frame frame;
  const ImageLine level{{100, 700}, {900, 700}, 0.25, 1.0};
  const ImageLine tilted{{100, 700}, {900, 704}, 0.25, 1.0};
  const View view = ViewOf(camera.parameters, frame);
  EXPECT_NEAR(DirectionResidual(view, level, Vec3::UnitX()).value, 0, 1e-12);
  // There the tilt is all that counts: 4 px, less what turning the line's length costs.
  EXPECT_NEAR(std::abs(DirectionResidual(view, tilted, Vec3::UnitX()).value), 4.0, 1e-3);
  // And it goes over smoothly.
  camera[kPhi] = 1e-9;
  EXPECT_NEAR(
      std::abs(DirectionResidual(ViewOf(camera.parameters, frame), tilted, Vec3::UnitX()).value),
      4.0, 1e-3);
}

TEST(Residuals, ADotBeyondACurvesEndIsAsFarAsTheEnd) {
  const Scene scene = Townhouse();
  const View view = ViewOf(scene.truth.parameters, scene.photograph.frame);
  std::vector<Seen> polyline;
  for (const Vec3& p : {Vec3(0, 0, 1), Vec3(2, 0, 1), Vec3(4, 0, 2)}) {
    polyline.push_back(See(view, p));
  }
  const Vec2 a = polyline[0].dot.hnormalized(), b = polyline[1].dot.hnormalized();
  const Vec2 along = (b - a).normalized(), right(-along.y(), along.x());
  EXPECT_NEAR(std::abs(ResidualOfCurve(view, a - 6 * along, 0.5, polyline).residual.value), 12,
              1e-9);
  EXPECT_NEAR(ResidualOfCurve(view, a + 9 * along + 3 * right, 0.5, polyline).residual.value, 6,
              1e-9);
  EXPECT_NEAR(ResidualOfCurve(view, a + 9 * along - 3 * right, 0.5, polyline).residual.value, -6,
              1e-9);
}

TEST(Residuals, AnImageOfACircleIsReachedAtItsNearestPoint) {
  const Scene scene = Townhouse();
  const View view = ViewOf(scene.truth.parameters, scene.photograph.frame);
  const Vec3 centre(6, 0, 6);
  const Vec2 dot = scene.Dot(centre) + Vec2(90, -20);
  const double distance = std::abs(
      ResidualOfCircle(view, dot, 1, centre, Vec3::UnitX(), Vec3::UnitZ(), 1.0).residual.value);
  double least = 1e9;
  for (int i = 0; i < 100000; ++i) {
    const double t = 2 * kPi * i / 100000;
    least = std::min(least, (scene.Dot(centre + Vec3(std::cos(t), 0, std::sin(t))) - dot).norm());
  }
  EXPECT_NEAR(distance, least, 1e-6);
}

}  // namespace
}  // namespace tranos::camera
