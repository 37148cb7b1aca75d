// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles fill exactly what lies inside an odd number of loops.
#include "geom/triangulate.h"

#include "shapes.h"

namespace tranos::geom {
namespace {

using Loops = std::vector<std::vector<Vec2>>;

double AreaOf(const std::vector<Vec2>& loop) {
  double twofold = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 &p = loop[i], &q = loop[(i + 1) % loop.size()];
    twofold += p.x() * q.y() - p.y() * q.x();
  }
  return 0.5 * twofold;
}

// The sum of the triangles' areas; each is counter-clockwise.
double Filled(const Loops& loops) {
  const auto triangles = TriangulatePolygon(loops);
  EXPECT_TRUE(triangles.has_value()) << triangles.error().detail;
  std::vector<Vec2> points;
  for (const auto& loop : loops) points.insert(points.end(), loop.begin(), loop.end());
  double sum = 0;
  for (const auto& t : triangles.value_or(std::vector<std::array<std::uint32_t, 3>>{})) {
    const double area = AreaOf({points[t[0]], points[t[1]], points[t[2]]});
    EXPECT_GT(area, 0);
    sum += area;
  }
  return sum;
}

std::vector<Vec2> Square(double from, double to) {
  return {{from, from}, {to, from}, {to, to}, {from, to}};
}

std::vector<Vec2> Ring(double radius, int count) {
  std::vector<Vec2> ring;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * kPi * i / count;
    ring.push_back(radius * Vec2(std::cos(angle), std::sin(angle)));
  }
  return ring;
}

TEST(TriangulatePolygon, TakesHolesAndIslandsByTurns) {
  EXPECT_DOUBLE_EQ(Filled({Square(0, 10)}), 100);
  EXPECT_DOUBLE_EQ(Filled({Square(0, 10), Square(2, 8)}), 100 - 36);
  EXPECT_DOUBLE_EQ(Filled({Square(4, 6), Square(0, 10), Square(2, 8)}), 100 - 36 + 4);
  EXPECT_DOUBLE_EQ(Filled({Square(0, 1), Square(2, 3)}), 2);
}

TEST(TriangulatePolygon, TakesEitherDirection) {
  std::vector<Vec2> clockwise = Square(2, 8);
  std::reverse(clockwise.begin(), clockwise.end());
  EXPECT_DOUBLE_EQ(Filled({Square(0, 10), clockwise}), 100 - 36);
}

TEST(TriangulatePolygon, HasTwoTrianglesLessThanCornersAndTwoMoreForEachHole) {
  const auto triangles = TriangulatePolygon({Ring(10, 100), Ring(3, 40)});
  ASSERT_TRUE(triangles.has_value());
  EXPECT_EQ(triangles->size(), 100 + 40);  // n - 2 + 2 a hole
}

TEST(TriangulatePolygon, TellsApartLoopsThatNearlyTouch) {
  const double gap = 1e-15;
  EXPECT_NEAR(Filled({Square(0, 1), {{gap, 0.5}, {0.5, 0.25}, {0.5, 0.75}}}), 1 - 0.125, 1e-12);
}

TEST(TriangulatePolygon, LetsCornersTouch) {
  EXPECT_DOUBLE_EQ(Filled({Square(0, 2), Square(2, 4)}), 8);
  EXPECT_DOUBLE_EQ(Filled({Square(0, 4), {{0, 0}, {3, 1}, {1, 3}}}), 16 - 4);
}

TEST(TriangulatePolygon, RefusesWhatIsNoPolygonAndSaysWhich) {
  const auto part = [](const Loops& loops) {
    const auto triangles = TriangulatePolygon(loops);
    return triangles ? -1 : triangles.error().part;
  };
  EXPECT_EQ(part({Square(0, 4), {{0, 0}, {1, 1}}}), 1);
  EXPECT_EQ(part({Square(0, 4), {{1, 1}, {1, 1}, {2, 2}}}), 1);
  EXPECT_EQ(part({Square(0, 4), Square(2, 6)}), 1);
  EXPECT_EQ(part({{{0, 0}, {2, 2}, {2, 0}, {0, 2}}}), 0);
  EXPECT_EQ(part({Square(0, 4), {{4, 0}, {6, 0}, {6, 4}, {4, 4}}}), 1);  // a side on a side
  EXPECT_GE(part({Square(0, 4), {{4, 1}, {6, 1}, {6, 3}, {4, 3}}}), 0);  // within a side
  EXPECT_GE(part({Square(0, 4), {{0, 2}, {2, 1}, {2, 3}}}), 0);          // a corner on a side
  EXPECT_EQ(part({{{0, 0}, {1, 0}, {NAN, 1}}}), 0);
}

RC_GTEST_PROP(TriangulatePolygon, FillsStarsWithStarsInThem, ()) {
  const auto star = [](double low, double high) {
    std::vector<Vec2> points;
    const int count = *rc::gen::inRange(3, 40);
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * kPi * i / count;
      points.push_back(Within(low, high) * Vec2(std::cos(angle), std::sin(angle)));
    }
    return points;
  };
  // The inner star stays within the circle inscribed in any triangle of the outer one.
  const Loops loops = {star(4, 9), star(0.5, 1.9)};
  const double expected = AreaOf(loops[0]) - AreaOf(loops[1]);
  RC_ASSERT(std::abs(Filled(loops) - expected) <= 1e-12 * expected);
}

}  // namespace
}  // namespace tranos::geom
