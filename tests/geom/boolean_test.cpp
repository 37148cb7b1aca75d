// SPDX-License-Identifier: GPL-3.0-or-later
// Booleans of solids: volumes by inclusion and exclusion, places by membership, and what lies
// flush, touches, coincides or is empty.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <ostream>

#include "geom/solid.h"
#include "geom/solid_primitives.h"

namespace tranos::geom {
namespace {

Solid SolidOf(const Result<TriangleMesh>& mesh) {
  EXPECT_TRUE(mesh) << mesh.error().detail;
  return *Solid::FromMesh(*mesh);
}
Solid Box(const Vec3& corner, const Vec3& size) {
  return SolidOf(SlabMesh({corner, Vec3::UnitX(), Vec3::UnitY()}, size));
}
Solid Unit(double x, double y, double z) { return Box({x, y, z}, Vec3::Ones()); }

TriangleMesh FacetsOf(const Solid& solid) {
  const auto facets = solid.Facets();
  EXPECT_TRUE(facets) << facets.error().detail;
  return facets ? **facets : TriangleMesh{};
}
double VolumeOf(const Solid& solid) { return Volume(FacetsOf(solid)); }

void ExpectSound(const TriangleMesh& mesh) {
  EXPECT_TRUE(IsClosed(mesh));
  EXPECT_FALSE(HasSelfIntersection(mesh));
  EXPECT_EQ(mesh.surfaces.size(), mesh.triangles.size());
}

struct Case {
  const char* name;
  Solid solid;
  double volume_m3, area_m2;
  std::size_t triangles;
  int shells;
};

TEST(Boolean, FlushTouchingCoincidentAndEmptyBoxes) {
  const Solid a = Unit(0, 0, 0);
  const std::vector<Case> cases = {
      {"flush", Solid::Union({a, Unit(1, 0, 0)}), 2, 10, 12, 1},
      {"shifted along the common face", Solid::Union({a, Unit(1, 0.25, 0)}), 2, 10.5, 28, 1},
      {"along an edge", Solid::Union({a, Unit(1, 1, 0)}), 2, 12, 24, 1},
      {"at a corner", Solid::Union({a, Unit(1, 1, 1)}), 2, 12, 24, 2},
      {"the same twice", Solid::Union({a, a}), 1, 6, 12, 1},
      {"itself taken away", Solid::Difference(a, {a}), 0, 0, 0, 0},
      {"its neighbour taken away", Solid::Difference(a, {Unit(1, 0, 0)}), 1, 6, 12, 1},
      {"in common with a neighbour", Solid::Intersection({a, Unit(1, 0, 0)}), 0, 0, 0, 0},
      {"in common with a stranger", Solid::Intersection({a, Unit(7, 0, 0)}), 0, 0, 0, 0},
      {"in common with itself", Solid::Intersection({a, a}), 1, 6, 12, 1},
      {"a corner taken off", Solid::Difference(a, {Unit(.5, .5, .5)}), 0.875, 6, 24, 1},
      {"hollow", Solid::Difference(a, {Box({.25, .25, .25}, {.5, .5, .5})}), 0.875, 7.5, 24, 2},
      {"a channel flush with the top",
       Solid::Difference(Box({0, 0, 0}, {3, 1, 2}), {Unit(1, 0, 1)}), 5, 22, 28, 1},
      {"a step whose floor lies in another's top",
       Solid::Union({Box({0, 0, 0}, {2, 1, 1}),
                     Solid::Difference(Box({2, 0, 0}, {1, 1, 2}), {Unit(2, 0, 1)})}),
       3, 14, 12, 1},
  };
  for (const Case& expected : cases) {
    SCOPED_TRACE(expected.name);
    const TriangleMesh mesh = FacetsOf(expected.solid);
    ExpectSound(mesh);
    EXPECT_NEAR(Volume(mesh), expected.volume_m3, 1e-12);
    EXPECT_NEAR(Area(mesh), expected.area_m2, 1e-12);
    EXPECT_EQ(mesh.triangles.size(), expected.triangles);
    EXPECT_EQ(ShellCount(mesh), expected.shells);
    EXPECT_EQ(Genus(mesh), 0);
  }
}

TEST(Boolean, TheOrderOfPartsAndTheDepthOfTheTreeMakeNoDifference) {
  const Solid a = Unit(0, 0, 0), b = Unit(.5, .25, .125), c = Unit(.25, .75, .5);
  const TriangleMesh flat = FacetsOf(Solid::Union({a, b, c}));
  for (const Solid& other : {Solid::Union({Solid::Union({a, b}), c}),
                             Solid::Union({a, Solid::Union({b, c})}), Solid::Union({c, b, a})}) {
    const TriangleMesh mesh = FacetsOf(other);
    EXPECT_EQ(mesh.triangles.size(), flat.triangles.size());
    EXPECT_NEAR(Volume(mesh), Volume(flat), 1e-12);
  }
  EXPECT_NEAR(VolumeOf(Solid::Difference(Solid::Difference(a, {b}), {c})),
              VolumeOf(Solid::Difference(a, {Solid::Union({b, c})})), 1e-12);
  // Cutting away what was cut away before fills nothing in: a − (b − c).
  EXPECT_NEAR(VolumeOf(Solid::Difference(a, {Solid::Difference(b, {c})})),
              1 - VolumeOf(Solid::Intersection({a, b})) + VolumeOf(Solid::Intersection({a, b, c})),
              1e-12);
}

TEST(Boolean, FiveHundredNestedStepsAreAsGoodAsOne) {
  Solid comb = Box({0, 0, 0}, {1000, 1, 1});
  for (int i = 0; i < 500; ++i) comb = Solid::Difference(comb, {Box({2. * i, -1, 0.5}, {1, 3, 1})});
  const TriangleMesh mesh = FacetsOf(comb);
  ExpectSound(mesh);
  EXPECT_NEAR(Volume(mesh), 1000 - 500 * 0.5, 1e-9);
}

TEST(Boolean, AHundredThousandUnionsInARowAreTakenApartAgain) {
  Solid row = Unit(0, 0, 0);
  for (int i = 1; i < 100'000; ++i) row = Solid::Union({row, Unit(2. * i, 0, 0)});
  EXPECT_NEAR(VolumeOf(row), 100'000, 1e-6);
}

TEST(Boolean, ATurnedSolidIsTheTurnedResult) {
  Affine turn = Affine::Identity();
  turn.linear() = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  turn.translation() = Vec3(10, -3, 2);
  const Solid a = Box({0, 0, 0}, {3, 2, 1}), b = Box({1, 1, 0.5}, {1, 3, 2});
  const TriangleMesh mesh = FacetsOf(Solid::Difference(a, {b}).Transformed(turn));
  ExpectSound(mesh);
  EXPECT_NEAR(Volume(mesh), 5.5, 1e-12);
  Affine mirror = Affine::Identity();
  mirror.linear().diagonal() = Vec3(-1, 1, 1);
  EXPECT_NEAR(VolumeOf(Solid::Difference(a, {b}).Transformed(mirror)), 5.5, 1e-12);
}

// Bricks that share parts of their faces, each carried to its place on its own.
std::vector<Solid> BrickWall(const Affine& world_from_wall) {
  std::vector<Solid> bricks;
  for (int course = 0; course < 5; ++course) {
    for (int i = 0; i < 6; ++i) {
      const Vec3 corner(0.3 * i - (course % 2 ? 0.15 : 0), 0, 0.1 * course);
      bricks.push_back(Box(corner, {0.3, 0.2, 0.1}).Transformed(world_from_wall));
    }
  }
  return bricks;
}

// Turned, the faces lie in one another no better than doubles can say.
TEST(Boolean, ABrickWallIsOneBodyWhicheverWayItIsTurned) {
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    Affine world_from_wall = Affine::Identity();
    world_from_wall.translate(Vec3(0.1 * i, -0.7, 0.3))
        .rotate(Eigen::AngleAxisd(0.31 * i, Vec3(0.1 * (i % 7), 0.2, 1).normalized()));
    const std::vector<Solid> bricks = BrickWall(world_from_wall);
    const TriangleMesh wall = FacetsOf(Solid::Union(bricks));
    ExpectSound(wall);
    EXPECT_NEAR(Volume(wall), 0.18, 1e-9);
    EXPECT_EQ(ShellCount(wall), 1);
    EXPECT_EQ(Genus(wall), 0);
    // What goes along joints, too.
    const Solid hole = Box({0.3, 0, 0.1}, {0.6, 0.2, 0.2}).Transformed(world_from_wall);
    const TriangleMesh frame = FacetsOf(Solid::Difference(Solid::Union(bricks), {hole}));
    ExpectSound(frame);
    EXPECT_NEAR(Volume(frame), 0.18 - 0.6 * 0.2 * 0.2, 1e-9);
    EXPECT_EQ(Genus(frame), 1);
  }
}

TEST(Boolean, AGapOfARoundingErrorIsNone) {
  const double height = 0.27 - 0.5e-16;
  const Solid base = Box({0, 0, 0}, {0.8, 0.8, height});
  const Solid shaft = Box({0.1, 0.1, std::nextafter(height, 1)}, {0.6, 0.6, 3});
  const TriangleMesh pillar = FacetsOf(Solid::Union({base, shaft}));
  ExpectSound(pillar);
  EXPECT_EQ(ShellCount(pillar), 1);
  EXPECT_NEAR(Volume(pillar), 0.8 * 0.8 * 0.27 + 0.6 * 0.6 * 3, 1e-9);
}

// Two of the box's sides meet its top in a line that runs on beyond it, so that the facets between
// have no width.
TEST(Boolean, FacetsWithoutWidthDoNoHarm) {
  TriangleMesh box = FacetsOf(Unit(0, 0, 0));
  const std::array<std::uint32_t, 3> first = box.triangles[0];
  const Vec3 middle = 0.5 * (box.positions[first[0]] + box.positions[first[1]]);
  box.positions.push_back(middle);
  const auto added = static_cast<std::uint32_t>(box.positions.size() - 1);
  box.triangles[0] = {added, first[1], first[2]};
  box.triangles.push_back({first[0], added, first[2]});
  box.triangles.push_back({first[0], first[1], added});
  box.surfaces.insert(box.surfaces.end(), {box.surfaces[0], box.surfaces[0]});
  ASSERT_TRUE(IsClosed(box));
  const Solid solid = *Solid::FromMesh(box);
  for (const Vec3& corner : {Vec3(.5, .5, .5), Vec3(-.5, -.5, -.5), Vec3(.5, -.5, .25)}) {
    const TriangleMesh mesh =
        FacetsOf(Solid::Union({solid, Unit(corner.x(), corner.y(), corner.z())}));
    ExpectSound(mesh);
    EXPECT_NEAR(Volume(mesh),
                2 - VolumeOf(Solid::Intersection(
                        {Unit(0, 0, 0), Unit(corner.x(), corner.y(), corner.z())})),
                1e-9);
  }
}

// Boxes on a grid of quarters lie flush and touch as often as not; cylinders and balls on the same
// grid touch them in lines and points, and share axes. Turned by eighths, their sides press on one
// another but for rounding.
struct Shape {
  int kind;  // 0 a box, 1 a cylinder, 2 a ball
  int eighths;
  Vec3 at;
  Vec3 size;
};
void showValue(const Shape& shape, std::ostream& out) {  // NOLINT: found by this name
  out << std::array{"box", "cylinder", "ball"}[static_cast<std::size_t>(shape.kind)] << " at "
      << shape.at.transpose() << " of " << shape.size.transpose() << " turned " << shape.eighths;
}
Solid SolidOf(const Shape& shape) {
  const double angle = shape.eighths * kPi / 4, c = std::cos(angle), s = std::sin(angle);
  const Frame frame{shape.at, {c, s, 0}, {-s, c, 0}};
  const Tolerance coarse{1e-3, 12};
  if (shape.kind == 0) return SolidOf(SlabMesh(frame, shape.size));
  if (shape.kind == 1) return SolidOf(CylinderMesh(frame, shape.size.x(), shape.size.z(), coarse));
  return SolidOf(SphereMesh(frame, shape.size.x(), coarse));
}
rc::Gen<Shape> AnyShape() {
  const auto quarter = [](int low, int high) {
    return rc::gen::map(rc::gen::inRange(low, high), [](int n) { return 0.25 * n; });
  };
  return rc::gen::apply(
      [](int kind, int eighths, double x, double y, double z, double a, double b, double c) {
        return Shape{kind, eighths, {x, y, z}, {a, b, c}};
      },
      rc::gen::inRange(0, 3), rc::gen::element(0, 0, 0, 1, 2, 3), quarter(0, 7), quarter(0, 7),
      quarter(0, 7), quarter(1, 6), quarter(1, 6), quarter(1, 6));
}

// Inside, by the solid angle under which the facets are seen (A. van Oosterom, J. Strackee, 1983).
bool IsInside(const TriangleMesh& mesh, const Vec3& p) {
  double half_angle = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = (mesh.positions[t[0]] - p).normalized(),
               b = (mesh.positions[t[1]] - p).normalized(),
               c = (mesh.positions[t[2]] - p).normalized();
    half_angle += std::atan2(a.dot(b.cross(c)), 1 + a.dot(b) + b.dot(c) + c.dot(a));
  }
  return half_angle > kPi;
}
bool IsNearSurface(const TriangleMesh& mesh, const Vec3& p) {
  return !mesh.triangles.empty() && NearestPoint(mesh, p).distance_m <= 1e-6;
}

RC_GTEST_PROP(Boolean, ChainsKeepVolumesAndPlaces, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(2, 6);
  const auto shapes = *rc::gen::container<std::vector<Shape>>(count, AnyShape());
  const auto operations = *rc::gen::container<std::vector<int>>(count, rc::gen::inRange(0, 3));
  Solid chain = SolidOf(shapes[0]);
  std::function<bool(const Vec3&)> contains = [mesh = FacetsOf(chain)](const Vec3& p) {
    return IsInside(mesh, p);
  };
  std::vector<TriangleMesh> surfaces{FacetsOf(chain)};
  for (std::size_t i = 1; i < shapes.size(); ++i) {
    const Solid next = SolidOf(shapes[i]);
    const TriangleMesh mesh = FacetsOf(next);
    surfaces.push_back(mesh);
    const double a = VolumeOf(chain), b = Volume(mesh);
    const TriangleMesh both = FacetsOf(Solid::Intersection({chain, next})),
                       either = FacetsOf(Solid::Union({chain, next})),
                       less = FacetsOf(Solid::Difference(chain, {next}));
    for (const TriangleMesh* result : {&both, &either, &less}) {
      RC_ASSERT(IsClosed(*result));
      RC_ASSERT(!HasSelfIntersection(*result));
    }
    const double tolerance = 1e-6 * (a + b);
    RC_ASSERT(std::abs(Volume(either) - (a + b - Volume(both))) <= tolerance);
    RC_ASSERT(std::abs(Volume(less) - (a - Volume(both))) <= tolerance);
    const auto before = contains;
    const auto in_next = [mesh](const Vec3& p) { return IsInside(mesh, p); };
    if (operations[i] == 0) {
      chain = Solid::Union({chain, next});
      contains = [=](const Vec3& p) { return before(p) || in_next(p); };
    } else if (operations[i] == 1) {
      chain = Solid::Difference(chain, {next});
      contains = [=](const Vec3& p) { return before(p) && !in_next(p); };
    } else {
      chain = Solid::Intersection({chain, next});
      contains = [=](const Vec3& p) { return before(p) && in_next(p); };
    }
  }
  const TriangleMesh result = FacetsOf(chain);
  for (int k = 0; k < 1'000; ++k) {
    const auto place = [] { return *rc::gen::inRange(-1'500'000, 3'000'000) * 1e-6; };
    const Vec3 p(place(), place(), place());
    bool is_near = false;
    for (const TriangleMesh& surface : surfaces) is_near |= IsNearSurface(surface, p);
    if (!is_near) RC_ASSERT(IsInside(result, p) == contains(p));
  }
}

}  // namespace
}  // namespace tranos::geom
