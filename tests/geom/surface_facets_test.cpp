// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <map>
#include <set>

#include "shapes.h"

namespace tranos::geom {
namespace {

const Vec3 kOrigin = Vec3::Zero(), kUp = Vec3::UnitZ();

using Key = std::array<double, 3>;
Key KeyOf(const Vec3& p) { return {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0}; }

Surface Sphere() {
  return *Revolution(*ArcThrough({0, 0, -2}, {2, 0, 0}, {0, 0, 2}), kOrigin, kUp, 2 * kPi);
}
Surface Torus() {
  const Circle tube{{Vec3(5, 0, 0), Vec3::UnitX(), Vec3::UnitZ()}, 1};
  return *Revolution(tube, kOrigin, kUp, 2 * kPi);
}
Surface Cone() { return *Revolution(Line{{3, 0, 0}, {0, 0, 4}}, kOrigin, kUp, 2 * kPi); }
Surface Saddle() { return *Ruled(Line{{0, 0, 0}, {10, 0, 0}}, Line{{0, 10, 0}, {10, 10, 4}}); }
Surface Conoid() { return *Ruled(Arc{{}, 3, kPi}, Line{{3, 0, 5}, {-3, 0, 5}}); }
Surface Patch() {
  const Vec3 a(0, 0, 0), b(10, 0, 1), c(11, 9, -1), d(-1, 8, 2);
  const BsplineCurve wave{
      3, {0, 0, 0, 0, 1, 1, 1, 1}, {c, {7, 12, 3}, {3, 6, -2}, d}, {1, 2, 0.5, 1}};
  return *EdgeSurface({*ArcThrough(a, {5, -1, 3}, b), Line{b, c}, wave, Line{d, a}});
}
Surface StretchedTorus() {
  return Transformed(Torus(), Moved(Vec3(1, 2, 0.5).asDiagonal(), Vec3(1, 2, 3)));
}

// Every edge of every facet, by the positions of its ends, with how often it is walked in each
// direction.
std::map<std::pair<Key, Key>, int> DirectedEdges(const Mesh& mesh) {
  std::map<std::pair<Key, Key>, int> walks;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      ++walks[{KeyOf(mesh.positions[t[k]]), KeyOf(mesh.positions[t[(k + 1) % 3]])}];
    }
  }
  return walks;
}

// The facet edges that no second facet walks the other way.
int FreeEdges(const Mesh& mesh) {
  const auto walks = DirectedEdges(mesh);
  int free = 0;
  for (const auto& [edge, count] : walks) {
    EXPECT_EQ(count, 1);
    free += walks.count({edge.second, edge.first}) == 0;
  }
  return free;
}

double DistanceToTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  Eigen::Matrix<double, 3, 2> sides;
  sides << b - a, c - a;
  const Vec2 at = (sides.transpose() * sides).inverse() * (sides.transpose() * (p - a));
  if (at.x() >= 0 && at.y() >= 0 && at.sum() <= 1) return (a + sides * at - p).norm();
  return NearestPoint(Polyline{{a, b, c}, true}, p).distance_m;
}

double DistanceToMesh(const Vec3& p, const Mesh& mesh) {
  double distance_m = 1e300;
  for (const auto& t : mesh.triangles) {
    distance_m = std::min(
        distance_m,
        DistanceToTriangle(p, mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]));
  }
  return distance_m;
}

struct Named {
  const char* name;
  Surface (*make)();
};
class AnySurface : public ::testing::TestWithParam<Named> {};

TEST_P(AnySurface, IsNowhereFartherFromItsFacetsThanTheTolerance) {
  const Surface surface = GetParam().make();
  const double chord_m = 0.05;
  const Mesh mesh = *Tessellate(surface, {chord_m, 0});
  for (int i = 0; i <= 37; ++i) {
    for (int j = 0; j <= 41; ++j) {
      EXPECT_LE(DistanceToMesh(PointAt(surface, i / 37.0, j / 41.0), mesh), chord_m * 1.001);
    }
  }
  for (const auto& t : mesh.triangles) {
    const Vec3 centre = (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3;
    EXPECT_LE(NearestPoint(surface, centre).distance_m, chord_m * 1.001);
  }
}

TEST_P(AnySurface, FacetsAreSoundAndFaceTheSideOfTheirNormals) {
  for (const Tolerance& tolerance : {Tolerance{0.02, 0}, Tolerance{1, 12}}) {
    const Mesh mesh = *Tessellate(GetParam().make(), tolerance);
    ASSERT_EQ(mesh.positions.size(), mesh.normals.size());
    for (const Vec3& normal : mesh.normals) EXPECT_NEAR(normal.norm(), 1, 1e-12);
    for (const auto& t : mesh.triangles) {
      const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
      const Vec3 cross = (b - a).cross(c - a);
      EXPECT_GT(cross.norm(), 1e-9);
      for (const std::uint32_t k : t) EXPECT_GT(cross.normalized().dot(mesh.normals[k]), -1e-6);
    }
  }
}

TEST_P(AnySurface, HasNoCracks) {
  const Surface surface = GetParam().make();
  const Mesh mesh = *Tessellate(surface, {0.05, 0});
  std::set<std::pair<Key, Key>> drawn;
  for (const auto& e : mesh.edges) {
    drawn.insert({KeyOf(mesh.positions[e[0]]), KeyOf(mesh.positions[e[1]])});
    drawn.insert({KeyOf(mesh.positions[e[1]]), KeyOf(mesh.positions[e[0]])});
  }
  // An edge with a facet on one side only is a border, and every border is drawn.
  const auto walks = DirectedEdges(mesh);
  for (const auto& [edge, count] : walks) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(walks.count({edge.second, edge.first}) || drawn.count(edge));
  }
}

TEST_P(AnySurface, FacetsComeCloseToTheArea) {
  const Surface surface = GetParam().make();
  const Mesh mesh = *Tessellate(surface, {1e-3, 0});
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.positions[t[0]];
    area += 0.5 * (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).norm();
  }
  EXPECT_NEAR(area, Area(surface), 3e-3 * Area(surface));
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, AnySurface,
    ::testing::Values(Named{"Sphere", Sphere}, Named{"Torus", Torus}, Named{"Cone", Cone},
                      Named{"Saddle", Saddle}, Named{"Conoid", Conoid}, Named{"Patch", Patch},
                      Named{"StretchedTorus", StretchedTorus},
                      Named{"Dome", [] { return *EdgeSurface(Fig6Edges()); }},
                      Named{"Cylinder",
                            [] {
                              return *Extrusion(Circle{{}, 2}, {1, 0, 4});
                            }},
                      Named{"Triangle",
                            [] {
                              return *EdgeSurface({*ArcThrough({4, 0, 0}, {2, 1, 2}, {0, 0, 0}),
                                                   Line{{0, 3, 0}, {4, 0, 0}},
                                                   Line{{0, 0, 0}, {0, 3, 0}}});
                            }}),
    [](const auto& test) { return test.param.name; });

TEST(SurfaceFacets, ClosedSurfacesHaveNoFreeEdgesAndNothingToDraw) {
  for (const Surface& surface : {Sphere(), Torus()}) {
    const Mesh mesh = *Tessellate(surface, {0.02, 0});
    EXPECT_EQ(FreeEdges(mesh), 0);
    EXPECT_TRUE(mesh.edges.empty());
    // Smooth everywhere: no position needs two normals.
    std::set<Key> positions;
    for (const Vec3& p : mesh.positions) positions.insert(KeyOf(p));
    EXPECT_EQ(positions.size(), mesh.positions.size());
  }
}

TEST(SurfaceFacets, NormalsOfASphereAreItsRadii) {
  const Mesh mesh = *Tessellate(Sphere(), {0.05, 0});
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_NEAR(std::abs(mesh.normals[i].dot(mesh.positions[i] / 2)), 1, 1e-12);
  }
}

TEST(SurfaceFacets, ApexOfAConeIsOnePointWithANormalForEachFacet) {
  const Mesh mesh = *Tessellate(Cone(), {1, 16});
  std::vector<Vec3> normals;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (mesh.positions[i] == Vec3(0, 0, 4)) normals.push_back(mesh.normals[i]);
  }
  EXPECT_EQ(normals.size(), 16u);
  for (const Vec3& normal : normals) EXPECT_NEAR(std::abs(normal.z()), 0.6, 1e-12);
  EXPECT_EQ(FreeEdges(mesh), 16);
}

TEST(SurfaceFacets, CylinderByCountIsAPrism) {
  const Mesh mesh = *Tessellate(*Extrusion(Circle{{}, 2}, {0, 0, 5}), {1, 6});
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_EQ(mesh.edges.size(), 12u);
  const auto rim = *Tessellate(Circle{{}, 2}, {1, 6});
  std::set<Key> positions;
  for (const Vec3& p : mesh.positions) positions.insert(KeyOf(p));
  EXPECT_EQ(positions.size(), 12u);
  for (const Vec3& p : rim) {
    double nearest = 1;
    for (const Vec3& q : mesh.positions) nearest = std::min(nearest, (p - q).norm());
    EXPECT_LT(nearest, 1e-14);
  }
  EXPECT_TRUE(positions.count({2, 0, 0}));
  EXPECT_TRUE(positions.count({-2, 0, 5}));
}

TEST(SurfaceFacets, HalfCircleByCountHasHalfTheFacets) {
  EXPECT_EQ(Tessellate(*Extrusion(Arc{{}, 2, kPi}, {0, 0, 5}), {1, 6})->triangles.size(), 6u);
}

TEST(SurfaceFacets, CreasesOfTheDomeAreDoubledAndDrawn) {
  const Mesh mesh = *Tessellate(*EdgeSurface(Fig6Edges()), {1, 16});
  std::map<Key, std::set<Key>> normals;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    normals[KeyOf(mesh.positions[i])].insert(KeyOf(mesh.normals[i]));
  }
  // The corner of a flat square and two arms and the crossing.
  EXPECT_GE((normals[KeyOf({10, -10, 0})].size()), 3u);
  // The crown is smooth and its knot lines are not drawn.
  EXPECT_EQ((normals[KeyOf({15, -15, 10})].size()), 1u);
  for (const auto& e : mesh.edges) {
    const Vec3 middle = 0.5 * (mesh.positions[e[0]] + mesh.positions[e[1]]);
    bool on_line = false;
    for (const double at : {0.0, 10.0, 20.0, 30.0}) {
      on_line = on_line || std::abs(middle.x() - at) < 1e-9 || std::abs(middle.y() + at) < 1e-9;
    }
    EXPECT_TRUE(on_line) << middle.transpose();
  }
  // Four borders and four creases of 1 + 8 + 1 facets.
  EXPECT_EQ(mesh.edges.size(), 80u);
}

TEST(SurfaceFacets, BoxProfileIsCreasedAtItsSeamToo) {
  const Polyline square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, true};
  const Mesh mesh = *Tessellate(*Extrusion(square, {0, 0, 1}), {0.1, 0});
  EXPECT_EQ(mesh.positions.size(), 16u);
  EXPECT_EQ(mesh.triangles.size(), 8u);
  EXPECT_EQ(mesh.edges.size(), 12u);
}

TEST(SurfaceFacets, PlanesNeedTwoFacetsHoweverFine) {
  const Surface plane = *Extrusion(Line{{0, 0, 0}, {3, 1, 0}}, {0, 0, 2});
  EXPECT_EQ(Tessellate(plane, {1e-9, 0})->triangles.size(), 2u);
  EXPECT_EQ(Tessellate(plane, {1e-300, 0})->triangles.size(), 2u);
}

TEST(SurfaceFacets, TooManyFacetsAreRefused) {
  EXPECT_EQ(Tessellate(Sphere(), {1e-300, 0}).error().code, ErrorCode::kTooLarge);
  EXPECT_EQ(Tessellate(Sphere(), {1, 2'000'000'000}).error().code, ErrorCode::kTooLarge);
}

// These are refused only after large grids were tried: seconds, and minutes under sanitizers.
TEST(SurfaceFacets, TooManyFacetsAreRefusedShortOfHopeless) {
#ifdef TRANOS_SANITIZED
  GTEST_SKIP() << "too slow under sanitizers";
#endif
  EXPECT_EQ(Tessellate(Patch(), {1e-12, 0}).error().code, ErrorCode::kTooLarge);
  EXPECT_EQ(Tessellate(Saddle(), {1e-14, 0}).error().code, ErrorCode::kTooLarge);
}

}  // namespace
}  // namespace tranos::geom
