// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes.h"

namespace tranos::geom {
namespace {

TEST(Chain, Fig6OutlineHasItsLength) {
  const Curve chain = Fig6Edge({0, 0, 0}, {1, 0, 0});
  EXPECT_NEAR(Length(chain), 20 + 5 * kPi, 1e-12);
  EXPECT_FALSE(IsClosed(chain));
  EXPECT_TRUE(Near(PointAtFraction(chain, 0.5), {15, 0, 5}, 1e-12));
}

TEST(Chain, PartsAreTurnedRoundWhereNeeded) {
  const Chain chain = *JoinChain(
      {Line{{0, 0, 0}, {1, 0, 0}}, Line{{2, 0, 0}, {1, 0, 0}}, Line{{2, 0, 0}, {2, 3, 0}}});
  EXPECT_EQ(PointAt(chain, 0), Vec3(0, 0, 0));
  EXPECT_EQ(PointAt(chain, 0.5), Vec3(1.5, 0, 0));
  EXPECT_EQ(PointAt(chain, 1), Vec3(2, 3, 0));
}

TEST(Chain, FirstPartIsTurnedOnlyIfItMustBe) {
  const Chain turned = *JoinChain({Line{{1, 0, 0}, {0, 0, 0}}, Line{{1, 0, 0}, {2, 0, 0}}});
  EXPECT_EQ(PointAt(turned, 0), Vec3(0, 0, 0));
  const Chain kept = *JoinChain({Arc{{}, 1, kPi}, Line{{1, 0, 0}, {-1, 0, 0}}});
  EXPECT_TRUE(kept.closed);
  EXPECT_EQ(PointAt(kept, 0), Vec3(1, 0, 0));
}

TEST(Chain, PartsThatLieApartAreNamed) {
  const auto apart = JoinChain(
      {Line{{0, 0, 0}, {1, 0, 0}}, Line{{1, 0, 0}, {2, 0, 0}}, Line{{3, 0, 0}, {4, 0, 0}}});
  ASSERT_FALSE(apart);
  EXPECT_EQ(apart.error().code, ErrorCode::kDoNotMeet);
  EXPECT_EQ(apart.error().part, 2);
  EXPECT_FALSE(JoinChain({}));
}

TEST(Chain, BsplineOfLinesAndAnArcIsThatOfFig6) {
  const BsplineCurve spline = ToBspline(Fig6Edge({0, 0, 0}, {1, 0, 0}));
  const double x[] = {0, 5, 10, 10, 15, 20, 20, 25, 30};
  const double z[] = {0, 0, 0, 5, 5, 5, 0, 0, 0};
  const double h = std::sqrt(0.5), w[] = {1, 1, 1, h, 1, h, 1, 1, 1};
  EXPECT_EQ(spline.degree, 2);
  EXPECT_EQ(spline.knots, (std::vector<double>{0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}));
  ASSERT_EQ(spline.poles.size(), 9u);
  for (int i = 0; i < 9; ++i) {
    EXPECT_TRUE(Near(spline.poles[i], {x[i], 0, z[i]}, 1e-13));
    EXPECT_NEAR(spline.weights[i], w[i], 1e-15);
  }
}

RC_GTEST_PROP(Chain, JoiningPiecesInAnyDirectionKeepsTheirLength, ()) {
  std::vector<Curve> parts;
  Vec3 at = DrawPoint();
  double length = 0;
  const int count = *rc::gen::inRange(1, 6);
  for (int i = 0; i < count; ++i) {
    const Vec3 next = DrawPoint();
    RC_PRE((next - at).norm() > 0.01);
    const Curve part = Line{at, next};
    parts.push_back(*rc::gen::arbitrary<bool>() ? Reversed(part) : part);
    length += (next - at).norm();
    at = next;
  }
  const auto chain = JoinChain(parts);
  RC_ASSERT(chain.has_value());
  RC_ASSERT(std::abs(Length(*chain) - length) < 1e-10);
}

}  // namespace
}  // namespace tranos::geom
