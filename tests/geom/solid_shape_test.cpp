// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes of solids: closed, of the right volume and genus, by closed forms and by symmetry.
#include <gtest/gtest.h>

#include <cmath>

#include "geom/closed_surface.h"
#include "geom/mesh_section.h"
#include "geom/solid_primitives.h"
#include "geom/swept_solid.h"
#include "geom/wall.h"

namespace tranos::geom {
namespace {

constexpr Tolerance kFine = {1e-4, 0};
constexpr double kRounding = 1e-9;

// An upright frame that is nobody's axis.
Frame Askew() {
  const Vec3 x = Vec3(2, 1, 0.5).normalized();
  const Vec3 y = Vec3::UnitZ().cross(x).normalized();
  return {{3, -4, 5}, x, y};
}

Curve Rectangle(const Vec3& corner, const Vec3& u, const Vec3& v) {
  return Polyline{{corner, corner + u, corner + u + v, corner + v}, true};
}

struct Expected {
  double volume_m3, area_m2;
  int genus = 0;
};

// A mesh whose facets lie within `chord_m` of a surface of this area and volume.
void ExpectSolid(const Result<TriangleMesh>& mesh, const Expected& expected,
                 double chord_m = kRounding) {
  ASSERT_TRUE(mesh) << mesh.error().detail;
  EXPECT_TRUE(IsClosed(*mesh));
  EXPECT_EQ(mesh->surfaces.size(), mesh->triangles.size());
  EXPECT_NEAR(Volume(*mesh), expected.volume_m3, chord_m * expected.area_m2);
  EXPECT_EQ(Genus(*mesh), expected.genus);
  EXPECT_EQ(ShellCount(*mesh), 1);
}

TEST(SolidShape, SlabsAndWedgesAreExact) {
  ExpectSolid(SlabMesh(Askew(), {4, 3, 2}), {24, 52});
  ExpectSolid(SlabMesh(Askew(), {-4, 3, -2}), {24, 52});
  ExpectSolid(WedgeMesh(Askew(), {4, 3, 2}), {12, 40});
  EXPECT_FALSE(SlabMesh(Askew(), {4, 0, 2}));
}

TEST(SolidShape, RoundOnesComeWithinTheChordOfTheSmoothOnes) {
  const double r = 2, h = 5;
  ExpectSolid(CylinderMesh(Askew(), r, h, kFine), {kPi * r * r * h, 2 * kPi * r * (r + h)}, 1e-4);
  ExpectSolid(ConeMesh(Askew(), r, 0, h, kFine), {kPi * r * r * h / 3, 47.5}, 1e-4);
  ExpectSolid(ConeMesh(Askew(), r, 1, h, kFine), {kPi * h * (r * r + r + 1) / 3, 64}, 1e-4);
  ExpectSolid(SphereMesh(Askew(), r, kFine), {4 * kPi * r * r * r / 3, 4 * kPi * r * r}, 1e-4);
  ExpectSolid(TorusMesh(Askew(), r, 0.5, 2 * kPi, kFine),
              {2 * kPi * kPi * r * 0.25, 4 * kPi * kPi * r * 0.5, 1}, 1e-4);
  ExpectSolid(TorusMesh(Askew(), r, 0.5, kPi / 2, kFine), {kPi * kPi * r * 0.25 / 2, 12}, 1e-4);
}

TEST(SolidShape, FacetsArePrismsOfTheCountAskedFor) {
  const Tolerance facets = {1e-3, 6};
  const double hexagon = 6 * 0.5 * std::sin(kPi / 3);
  ExpectSolid(CylinderMesh({}, 1, 2, facets), {2 * hexagon, 20});
  ExpectSolid(ConeMesh({}, 1, 0, 3, facets), {hexagon, 20});
  const auto sphere = SphereMesh({}, 1, facets);
  ASSERT_TRUE(sphere);
  double highest = 0, widest = 0;
  for (const Vec3& p : sphere->positions) {
    EXPECT_NEAR(p.norm(), 1, kRounding);
    highest = std::max(highest, p.z()), widest = std::max(widest, p.x());
  }
  EXPECT_EQ(highest, 1);  // a pole is a vertex
  EXPECT_NEAR(widest, std::sin(kPi / 3), kRounding);
}

TEST(SolidShape, AHoleIsLeftOpenThroughAProjection) {
  const Curve outer = Rectangle({0, 0, 0}, {4, 0, 0}, {0, 3, 0});
  const Curve hole = Rectangle({1, 1, 0}, {0, 1, 0}, {1, 0, 0});  // the other way round
  ExpectSolid(ProjectionMesh({outer, hole}, {0, 0, 2}, {}), {22, 60, 1});
  ExpectSolid(ProjectionMesh({outer, hole}, {1, 1, -2}, {}), {22, 60, 1});
  EXPECT_FALSE(ProjectionMesh({outer}, {1, 1, 0}, {}));
}

TEST(SolidShape, AnOutlineThatCrossesItselfIsRefused) {
  const Curve bow = Polyline{{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}}, true};
  const auto mesh = ProjectionMesh({bow}, {0, 0, 1}, {});
  ASSERT_FALSE(mesh);
  EXPECT_EQ(mesh.error().code, ErrorCode::kDegenerate);
}

TEST(SolidShape, ARevolutionClosesUpAlongItsAxis) {
  const Curve side = Rectangle({0, 0, 0}, {2, 0, 0}, {0, 0, 3});
  const Vec3 up = Vec3::UnitZ();
  ExpectSolid(RevolutionMesh({side}, {0, 0, 7}, up, 2 * kPi, kFine), {12 * kPi, 63}, 1e-4);
  ExpectSolid(RevolutionMesh({side}, {0, 0, 7}, up, kPi / 3, kFine), {2 * kPi, 30}, 1e-4);
  const auto crossing = RevolutionMesh({side}, {1, 0, 0}, up, kPi, kFine);
  ASSERT_FALSE(crossing);
  EXPECT_EQ(crossing.error().code, ErrorCode::kOutOfRange);
  const auto oblique = RevolutionMesh({side}, {0, 0, 0}, Vec3::UnitY(), kPi, kFine);
  ASSERT_FALSE(oblique);
  EXPECT_EQ(oblique.error().code, ErrorCode::kNotPlanar);
}

// A section of area A whose centroid runs along a path of length L fills A·L (Pappus).
TEST(SolidShape, ASweepIsMitredAtCorners) {
  const Curve section = Rectangle({-0.1, -0.2, 0}, {0.2, 0, 0}, {0, 0.4, 0});
  const Polyline corner = {{{0, 0, 0}, {5, 0, 0}, {5, 3, 0}, {9, 6, 2}}, false};
  const double length = Length(Curve(corner));
  ExpectSolid(SweepMesh({section}, corner, Vec3::UnitZ(), {}), {0.08 * length, 20});
  const Curve square = Rectangle({0, 0, 0}, {6, 0, 0}, {0, 4, 0});
  ExpectSolid(SweepMesh({section}, square, Vec3::UnitZ(), {}), {0.08 * 20, 30, 1});
  const Curve ring = Circle{{}, 3};
  ExpectSolid(SweepMesh({section}, ring, Vec3::UnitZ(), kFine), {0.08 * 6 * kPi, 23, 1}, 1e-4);
}

TEST(SolidShape, ASweepAlongAnArchEndsSquarely) {
  const Arc arch = {{{0, 0, 0}, Vec3::UnitX(), Vec3::UnitZ()}, 2, kPi};
  const Curve section = Rectangle({1.9, -0.3, 0}, {0.4, 0, 0}, {0, 0.6, 0});
  const auto mesh = SweepMeshInPlace({section}, Curve(arch), kFine);
  ExpectSolid(mesh, {0.4 * 0.6 * kPi * 2.1, 16}, 1e-4);
  EXPECT_NEAR(BoundingBox(*mesh).min.z(), 0, kRounding);
  EXPECT_NEAR(BoundingBox(*mesh).max.x(), 2.3, kRounding);
}

TEST(SolidShape, AClosedPathInSpaceIsClosedWithATwist) {
  const Curve section = Rectangle({-0.1, -0.1, 0}, {0.2, 0, 0}, {0, 0.2, 0});
  const Polyline path = {{{0, 0, 0}, {5, 0, 0}, {5, 5, 2}, {2, 7, 0}, {0, 5, 3}}, true};
  const auto mesh = SweepMesh({section}, path, Vec3::UnitZ(), {});
  ExpectSolid(mesh, {0.04 * Length(Curve(path)), 20, 1}, 2e-3);
}

TEST(SolidShape, APathThatTurnsTooTightlyIsRefused) {
  const Curve section = Rectangle({-2, -2, 0}, {4, 0, 0}, {0, 4, 0});
  for (const Curve& path :
       {Curve(Circle{{}, 1}), Curve(Polyline{{{0, 0, 0}, {5, 0, 0}, {1, 0, 0}}}),
        Curve(Polyline{{{0, 0, 0}, {5, 0, 0}, {5, 1, 0}, {0, 1, 0}}})}) {
    const auto mesh = SweepMesh({section}, path, Vec3::UnitZ(), kFine);
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().code, ErrorCode::kOutOfRange);
  }
}

TEST(SolidShape, ALoftMatchesCornersOrLengths) {
  const Curve below = Rectangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
  // Begins at another corner, and runs the other way.
  const Curve above = Rectangle({3, 3, 3}, {-2, 0, 0}, {0, -2, 0});
  const Curve turned = Rectangle({3, 3, 3}, {0, -2, 0}, {-2, 0, 0});
  ExpectSolid(LoftMesh({below, above}, {}), {28, 60});
  ExpectSolid(LoftMesh({below, turned}, {}), {28, 60});
  const auto round = LoftMesh({below, Circle{{{2, 2, 3}}, 1}}, kFine);
  ASSERT_TRUE(round);
  EXPECT_TRUE(IsClosed(*round));
  EXPECT_GT(Volume(*round), 3 * kPi);
  EXPECT_LT(Volume(*round), 3 * 16);
}

Surface Barrel(double radius_m) {
  const Arc arch = {{{0, 0, 0}, Vec3::UnitX(), Vec3::UnitZ()}, radius_m, kPi};
  return *Extrusion(Curve(arch), {0, 5, 0});
}

TEST(SolidShape, ThickenedSurfacesAreEvenlyThick) {
  const double half_ring = kPi / 2 * (3.3 * 3.3 - 3 * 3) * 5;
  ExpectSolid(ThickenedMesh({Barrel(3)}, {}, 0.3, 0, kFine), {half_ring, 100}, 1e-4);
  const double inner_ring = kPi / 2 * (3 * 3 - 2.7 * 2.7) * 5;
  ExpectSolid(ThickenedMesh({Barrel(3)}, {}, 0, 0.3, kFine), {inner_ring, 100}, 1e-4);
  const Curve meridian = Arc{{{0, 0, 0}, Vec3::UnitX(), Vec3::UnitZ()}, 2, kPi / 2};
  const auto dome = Revolution(meridian, {0, 0, 0}, Vec3::UnitZ(), 2 * kPi);
  const double shell = 2 * kPi / 3 * (std::pow(2.25, 3) - std::pow(1.75, 3));
  ExpectSolid(ThickenedMesh({*dome}, {}, 0.25, 0.25, kFine), {shell, 60}, 1e-4);
  const auto folded = ThickenedMesh({Barrel(1)}, {}, 0, 1.5, kFine);
  ASSERT_FALSE(folded);
  EXPECT_EQ(folded.error().code, ErrorCode::kOutOfRange);
}

TEST(SolidShape, SurfacesThatMeetAreThickenedAsOne) {
  const Polyline corner = {{{0, 0, 0}, {4, 0, 0}}, false}, turn = {{{4, 0, 0}, {4, 3, 0}}, false};
  const auto first = Extrusion(Curve(corner), {0, 0, 2}),
             second = Extrusion(Curve(turn), {0, 0, 2});
  ExpectSolid(ThickenedMesh({*first, *second}, {}, 0.25, 0.25, {}), {7 * 0.5 * 2, 40});
}

TEST(SolidShape, SurfacesEncloseAVolumeThoughTheirFacetsDiffer) {
  const Curve base = Circle{{}, 2};
  const auto side = Extrusion(base, {0, 0, 3});
  const Curve meridian = Arc{{{0, 0, 3}, Vec3::UnitX(), Vec3::UnitZ()}, 2, kPi / 2};
  const auto dome = Revolution(meridian, {0, 0, 0}, Vec3::UnitZ(), 2 * kPi);
  ExpectSolid(EnclosedMesh({*side, *dome}, {Face{base}}, kFine), {12 * kPi + 16 * kPi / 3, 75},
              1e-4);
  const auto open = EnclosedMesh({*side, *dome}, {}, kFine);
  ASSERT_FALSE(open);
  EXPECT_EQ(open.error().code, ErrorCode::kNotClosed);
}

WallShape Room() {
  WallShape wall;
  wall.line = {{0, 0, 0}, {8, 0, 0}, {8, 6, 0}, {0, 6, 0}};
  wall.closed = true;
  wall.left_m = 0.2, wall.right_m = 0.3, wall.height_m = 3;
  return wall;
}
WallOpening Window(std::size_t part, double along_m, double size_m) {
  const double s = size_m;
  return {part, {{along_m, 1}, {along_m + s, 1}, {along_m + s, 1 + s}, {along_m, 1 + s}}};
}

TEST(SolidShape, AWallIsMitredAndItsOpeningsAreHoles) {
  const double plan = 8.6 * 6.6 - 7.6 * 5.6;
  ExpectSolid(WallMesh(Room(), {}), {plan * 3, 250, 1});
  const auto mesh = WallMesh(Room(), {Window(0, 2, 1), Window(0, 5, 0.5), Window(2, 3, 1)});
  ExpectSolid(mesh, {plan * 3 - 0.5 * 2.25, 250, 4});
  WallShape open = Room();
  open.closed = false;
  ExpectSolid(WallMesh(open, {Window(1, 2, 1)}), {0.5 * 3 * 22 - 0.5 + 0.1 * 3, 200, 1});
}

TEST(SolidShape, OpeningsThatLeaveTheirFaceOrMeetAreTold) {
  for (const std::vector<WallOpening>& openings : {std::vector{Window(0, 7.5, 1)},
                                                   {Window(0, 2, 2.5)},
                                                   {Window(0, 2, 1), Window(0, 2.5, 1)},
                                                   {Window(0, 2, 1), Window(0, 2.2, 0.2)}}) {
    const auto mesh = WallMesh(Room(), openings);
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().code, ErrorCode::kDoNotMeet);
  }
  WallShape thick = Room();
  thick.left_m = 4;
  const auto mesh = WallMesh(thick, {});
  ASSERT_FALSE(mesh);
  EXPECT_EQ(mesh.error().code, ErrorCode::kOutOfRange);
}

TEST(SolidShape, FacesOfAWallLookOutward) {
  const auto faces = FacesOf(Room());
  ASSERT_TRUE(faces);
  ASSERT_EQ(faces->size(), 8u);
  EXPECT_TRUE((*faces)[0].frame.z().isApprox(-Vec3::UnitY()));
  EXPECT_TRUE((*faces)[0].frame.origin.isApprox(Vec3(-0.3, -0.3, 0)));
  EXPECT_NEAR((*faces)[0].length_m, 8.6, kRounding);
  EXPECT_TRUE((*faces)[4].frame.z().isApprox(Vec3::UnitY()));
}

TEST(SolidShape, ASectionHasTheAreaOfTheCut) {
  const auto ring = TorusMesh({}, 2, 0.5, 2 * kPi, kFine);
  const Frame level, upright = {{0, 0, 0}, Vec3::UnitX(), Vec3::UnitZ()};
  const auto area = [](const std::vector<Polyline>& lines) {
    double sum = 0;
    for (const Polyline& line : lines) {
      EXPECT_TRUE(line.closed);
      sum += *EnclosedArea(Curve(line));
    }
    return sum;
  };
  ASSERT_EQ(SectionOf(*ring, level).size(), 2u);
  EXPECT_NEAR(area(SectionOf(*ring, level)), kPi * (2.5 * 2.5 + 1.5 * 1.5), 1e-2);
  EXPECT_NEAR(area(SectionOf(*ring, upright)), 2 * kPi * 0.25, 1e-2);
  // A plane through the top of a slab cuts round it; one above it cuts nothing.
  const auto slab = SlabMesh({}, {4, 3, 2});
  EXPECT_NEAR(area(SectionOf(*slab, {{0, 0, 2}})), 12, kRounding);
  EXPECT_TRUE(SectionOf(*slab, {{0, 0, 2.1}}).empty());
}

TEST(SolidShape, MeasuresOfAMeshAgreeWithTheShape) {
  const auto slab = SlabMesh({}, {4, 3, 2});
  EXPECT_NEAR(Area(*slab), 52, kRounding);
  EXPECT_TRUE(Centroid(*slab).isApprox(Vec3(2, 1.5, 1), kRounding));
  const Nearest side = NearestPoint(*slab, {6, 1, 1});
  EXPECT_TRUE(side.point.isApprox(Vec3(4, 1, 1), kRounding));
  EXPECT_NEAR(NearestPoint(*slab, {5, 4, 3}).distance_m, std::sqrt(3), kRounding);
}

TEST(SolidShape, NormalsAreSharpBetweenSurfacesAndSmoothWithinOne) {
  const auto cylinder = CylinderMesh({}, 1, 2, {1e-3, 24});
  const Mesh facets = FacetsOf(*cylinder);
  for (std::size_t i = 0; i < facets.positions.size(); ++i) {
    const Vec3 out(facets.positions[i].x(), facets.positions[i].y(), 0);
    const bool cap = std::abs(facets.normals[i].z()) > 0.5;
    EXPECT_GT(cap ? std::abs(facets.normals[i].z()) : facets.normals[i].dot(out), 0.999);
  }
  EXPECT_EQ(facets.edges.size(), 2 * 24u);
  // A prism of six sides shows its edges.
  EXPECT_EQ(FacetsOf(*CylinderMesh({}, 1, 2, {1e-3, 6})).edges.size(), 18u);
}

}  // namespace
}  // namespace tranos::geom
