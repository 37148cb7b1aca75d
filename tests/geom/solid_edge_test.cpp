// SPDX-License-Identifier: GPL-3.0-or-later
// Edges of prisms in any position, cut off and rounded: volumes by the plan, closed, uncrossed.
#include "geom/solid_edge.h"

#include "geom/solid.h"
#include "geom/swept_solid.h"
#include "shapes.h"

namespace tranos::geom {
namespace {

constexpr double kHeight_m = 3;
// What prisms reach beyond what they change, and what rounding does.
constexpr double kHair_m3 = 1e-4;
constexpr double kChord_m = 1e-3;

// The edge of a prism between two of its sides that form this angle in plan, seen from inside.
struct Corner {
  TriangleMesh mesh;
  SolidEdge edge;
  double angle_rad;  // between the sides
};

// A prism over a corner of two sides of length 4, standing out or running in, its ends askew if the
// projection is.
Corner DrawCorner(bool is_convex, bool is_askew) {
  const Frame frame = DrawFrame();
  const double angle_rad = Within(0.3, 2.8);
  const Vec3 tip = frame.origin, a = tip + 4 * frame.x,
             b = tip + 4 * (std::cos(angle_rad) * frame.x + std::sin(angle_rad) * frame.y);
  const Vec3 middle = 0.5 * (a + b) - tip;
  Polyline plan{{tip, a, b}, true};
  if (!is_convex)
    plan.vertices = {tip, a, a - 2 * middle, tip - 8 * middle.normalized(), b - 2 * middle, b};
  const Vec3 vector = kHeight_m * frame.z() + (is_askew ? Vec3(0.5 * frame.x) : Vec3::Zero());
  Corner corner{*ProjectionMesh({plan}, vector, {}), {}, angle_rad};
  const std::vector<SolidEdge> edges = SolidEdgesOf(corner.mesh);
  const Vec3 at = tip + 0.5 * vector;
  corner.edge = *std::min_element(edges.begin(), edges.end(), [&](const auto& e, const auto& f) {
    return Distance(e, at) < Distance(f, at);
  });
  return corner;
}

double VolumeAfter(const Corner& corner, const TriangleMesh& prism) {
  const Solid solid = *Solid::FromMesh(corner.mesh), part = *Solid::FromMesh(prism);
  const auto facets =
      *(corner.edge.is_convex ? Solid::Difference(solid, {part}) : Solid::Union({solid, part}))
           .Facets();
  EXPECT_TRUE(IsClosed(*facets));
  EXPECT_FALSE(HasSelfIntersection(*facets));
  EXPECT_EQ(ShellCount(*facets), 1);
  return Volume(*facets);
}

RC_GTEST_PROP(SolidEdge, IsCutOff, (bool is_convex, bool is_askew)) {
  const Corner corner = DrawCorner(is_convex, is_askew);
  RC_ASSERT(corner.edge.is_convex == is_convex);
  const double a = Within(0.1, 1), b = Within(0.1, 1);
  const double taken = 0.5 * a * b * std::sin(corner.angle_rad) * kHeight_m;
  const double changed =
      std::abs(VolumeAfter(corner, *ChamferPrism(corner.edge, a, b)) - Volume(corner.mesh));
  if (!is_askew) RC_ASSERT(std::abs(changed - taken) < kHair_m3);
  RC_ASSERT(changed > 0.5 * taken && changed < 2 * taken);
}

RC_GTEST_PROP(SolidEdge, IsRounded, (bool is_convex)) {
  const Corner corner = DrawCorner(is_convex, false);
  const double half_rad = 0.5 * corner.angle_rad, r = Within(0.1, 1) * std::tan(half_rad);
  const double taken = r * r * (1 / std::tan(half_rad) - (kPi / 2 - half_rad)) * kHeight_m;
  const auto prism = FilletPrism(corner.edge, r, {kChord_m, 0});
  const double changed = std::abs(VolumeAfter(corner, *prism) - Volume(corner.mesh));
  const double round_m2 = r * (kPi - corner.angle_rad) * kHeight_m;
  RC_ASSERT(std::abs(changed - taken) < kChord_m * round_m2 + kHair_m3);
}

TEST(SolidEdge, HasRoomUpToTheNextBorder) {
  const Polyline plan{{{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}}, true};
  const std::vector<SolidEdge> edges = SolidEdgesOf(*ProjectionMesh({plan}, {0, 0, 2}, {}));
  EXPECT_EQ(edges.size(), 12u);
  for (const SolidEdge& edge : edges) {
    if (Distance(edge, {2, 0, 2}) > 1e-9) continue;
    EXPECT_NEAR(edge.across[0].y(), 1, 1e-12);  // the top first
    EXPECT_NEAR(edge.room_m[0], 3, 1e-12);
    EXPECT_NEAR(edge.room_m[1], 2, 1e-12);
    EXPECT_NEAR(edge.shared_room_m[0], 1.5, 1e-12);
    EXPECT_NEAR(LargestRadius(edge, true), 1, 1e-12);
  }
}

TEST(SolidEdge, IsNoneOnRoundSurfaces) {
  const Curve circle = Circle{{}, 2};
  EXPECT_TRUE(SolidEdgesOf(*ProjectionMesh({circle}, {0, 0, 2}, {})).empty());
}

}  // namespace
}  // namespace tranos::geom
