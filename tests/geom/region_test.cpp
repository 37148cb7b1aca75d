// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/region.h"

#include "geom/construction.h"
#include "shapes.h"

namespace tranos::geom {
namespace {

constexpr Tolerance kFine = {1e-4};

Curve Square(double from, double to) {
  return Polyline{{{from, from, 0}, {to, from, 0}, {to, to, 0}, {from, to, 0}}, true};
}
Curve Rectangle(double x0, double y0, double x1, double y1) {
  return Polyline{{{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}}, true};
}
Curve Round(double x, double y, double radius) {
  Frame frame;
  frame.origin = {x, y, 0};
  return Circle{frame, radius};
}
Region MustRegion(const std::vector<Curve>& outlines) {
  auto region = RegionOf(outlines);
  EXPECT_TRUE(region.has_value()) << region.error().detail << " at " << region.error().part;
  return region.value_or(Region{});
}
Region Combined(const Region& a, const Region& b, SetOperation operation) {
  const bool less = operation == SetOperation::kDifference;
  auto region = less ? Combine({a}, {b}, operation, kFine) : Combine({a, b}, {}, operation, kFine);
  EXPECT_TRUE(region.has_value()) << region.error().detail;
  return region.value_or(Region{});
}

// The triangles' area; each looks along plane.z.
double FacetArea(const Region& region, const Tolerance& tolerance) {
  const auto facets = Triangulate(region, tolerance);
  EXPECT_TRUE(facets.has_value()) << facets.error().detail;
  if (!facets) return 0;
  double sum = 0;
  for (const auto& t : facets->triangles) {
    const Vec3& p = facets->positions[t[0]];
    const double twofold =
        (facets->positions[t[1]] - p).cross(facets->positions[t[2]] - p).dot(region.plane.z());
    EXPECT_GT(twofold, 0);
    sum += 0.5 * twofold;
  }
  return sum;
}

TEST(RegionOf, NestsOutlinesInAnyOrder) {
  const Region region = MustRegion(
      {Round(5, 5, 1), Square(0, 10), Square(20, 21), Square(3, 7), Round(20.5, 20.5, 0.1)});
  ASSERT_EQ(region.parts.size(), 3u);  // the island, the square, the small square
  EXPECT_EQ(region.parts[0].holes.size(), 0u);
  EXPECT_EQ(region.parts[1].holes.size(), 1u);
  EXPECT_EQ(region.parts[2].holes.size(), 1u);
  EXPECT_NEAR(Area(region), kPi + 100 - 16 + 1 - 0.01 * kPi, 1e-9);
  EXPECT_NEAR(Perimeter(region), 2 * kPi + 40 + 16 + 4 + 0.2 * kPi, 1e-9);
}

TEST(RegionOf, DirectsOutlines) {
  const Region region = MustRegion({Square(0, 10), Square(2, 4), Reversed(Square(6, 8))});
  ForEachOutline(region, [&](const Curve& outline, bool is_hole) {
    EXPECT_EQ(PlaneOf(outline)->z().dot(region.plane.z()) > 0, !is_hole);
  });
}

TEST(RegionOf, NamesTheOutlineAtFault) {
  const auto fault = [](const std::vector<Curve>& outlines) {
    const auto region = RegionOf(outlines);
    return region ? std::pair{ErrorCode::kTooLarge, -1}
                  : std::pair{region.error().code, region.error().part};
  };
  using Fault = std::pair<ErrorCode, int>;
  EXPECT_EQ(fault({Square(0, 4), Line{{0, 0, 0}, {1, 0, 0}}}), Fault(ErrorCode::kNotClosed, 1));
  EXPECT_EQ(fault({Square(0, 4), Square(2, 6)}), Fault(ErrorCode::kDegenerate, 1));
  EXPECT_EQ(fault({Square(0, 4), Round(1, 1, 1)}), Fault(ErrorCode::kDegenerate, 1));  // touches
  EXPECT_EQ(fault({Square(0, 4), Rectangle(4, 1, 6, 2)}), Fault(ErrorCode::kDegenerate, 1));
  EXPECT_EQ(fault({Round(0, 0, 1), Round(0, 0, 1)}), Fault(ErrorCode::kDegenerate, 1));
  EXPECT_EQ(fault({Polyline{{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 3, 0}}, true}}),
            Fault(ErrorCode::kDegenerate, 0));
  Frame above;
  above.origin = {1, 1, 1};
  EXPECT_EQ(fault({Square(0, 4), Circle{above, 0.5}}), Fault(ErrorCode::kNotPlanar, 1));
  EXPECT_EQ(fault({Square(0, 4), Round(1, 1, 1e-12)}), Fault(ErrorCode::kDegenerate, 1));
  EXPECT_EQ(fault({}), Fault(ErrorCode::kDegenerate, -1));
}

TEST(RegionOf, TellsApartWhatChordsWouldCross) {
  // The hole comes within a tenth of a millimetre, chords deviate by up to a centimetre.
  const Region region = MustRegion({Round(0, 0, 10), Round(4.9999, 0, 5)});
  EXPECT_NEAR(Area(region), kPi * 75, 1e-9);
  EXPECT_NEAR(FacetArea(region, {1e-2}), kPi * 75, 1);
}

TEST(RegionOf, TakesManyOutlinesAndLiesFarOut) {
  std::vector<Curve> outlines;
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) outlines.push_back(Round(1e6 + i, j, 0.3));
  }
  outlines.push_back(Rectangle(1e6 - 1, -1, 1e6 + 40, 40));
  const Region region = MustRegion(outlines);
  ASSERT_EQ(region.parts.size(), 1u);
  EXPECT_EQ(region.parts[0].holes.size(), 1600u);
  EXPECT_NEAR(Area(region), 41 * 41 - 1600 * 0.09 * kPi, 1e-6);
  EXPECT_NEAR(FacetArea(region, kFine), Area(region), 1);
}

TEST(Region, MeasuresAsItsParts) {
  const Region region = MustRegion({Rectangle(0, 0, 6, 2), Rectangle(1, 0.5, 2, 1.5)});
  const Vec3 expected = (12 * Vec3(3, 1, 0) - Vec3(1.5, 1, 0)) / 11;
  EXPECT_TRUE((Centroid(region) - expected).norm() < 1e-12);
  EXPECT_TRUE(Contains(region, {0.5, 0.5, 3}));
  EXPECT_FALSE(Contains(region, {1.5, 1, 0}));
  EXPECT_NEAR(NearestPoint(region, {1.5, 1.1, 0}).distance_m, 0.4, 1e-12);
  EXPECT_NEAR(NearestPoint(region, {5, 1, 2}).distance_m, 2, 1e-12);
  EXPECT_NEAR(NearestPoint(region, {9, 1, 4}).distance_m, 5, 1e-12);
}

RC_GTEST_PROP(Region, KeepsItsFactsUnderSimilarities, ()) {
  const BsplineCurve ellipse = Ellipse(Frame{}, 3, 2);
  const Region region = MustRegion({Square(-6, 6), ellipse, Round(0.2, 0.1, 1)});
  double scale = 1;
  const Affine m = DrawSimilarity(&scale);
  const Region image = Transformed(region, m);
  RC_ASSERT(std::abs(Area(image) - scale * scale * Area(region)) < 1e-8 * Area(image));
  RC_ASSERT(Near(Centroid(image), m * Centroid(region), 1e-8));
  RC_ASSERT(std::abs(FacetArea(image, {1e-3 * scale}) - Area(image)) < 0.01 * Area(image));
  ForEachOutline(image, [&](const Curve& outline, bool is_hole) {
    RC_ASSERT((PlaneOf(outline)->z().dot(image.plane.z()) > 0) == !is_hole);
  });
}

TEST(Triangulate, AddsNoPointAndGivesTheLoops) {
  const Region region = MustRegion({Square(0, 10), Round(5, 5, 2), Round(1.5, 1.5, 1)});
  const auto facets = Triangulate(region, {1e-3, 24});
  ASSERT_TRUE(facets.has_value());
  ASSERT_EQ(facets->loops.size(), 3u);
  EXPECT_EQ(facets->loops[1].end - facets->loops[1].begin, 24u);
  EXPECT_TRUE(facets->loops[1].is_hole);
  EXPECT_EQ(facets->positions.size(), 4u + 24 + 24);
  EXPECT_EQ(facets->triangles.size(), 4u - 2 + 2 * (24 + 2) / 2 * 2);
  // The sides of the loops are the only ones that belong to one triangle alone, each run in its
  // loop's direction.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const auto& t : facets->triangles) {
    for (int i = 0; i < 3; ++i) ++sides[{t[i], t[(i + 1) % 3]}];
  }
  std::size_t free = 0;
  for (const auto& [side, count] : sides) {
    EXPECT_EQ(count, 1);
    free += sides.count({side.second, side.first}) == 0;
  }
  EXPECT_EQ(free, facets->positions.size());
  for (const auto& loop : facets->loops) {
    for (std::uint32_t i = loop.begin; i < loop.end; ++i) {
      const std::uint32_t next = i + 1 < loop.end ? i + 1 : loop.begin;
      EXPECT_EQ(sides.count({i, next}), 1u);
    }
  }
}

TEST(Combine, OverlappingSquares) {
  const Region a = MustRegion({Square(0, 4)}), b = MustRegion({Square(2, 6)});
  EXPECT_DOUBLE_EQ(Area(Combined(a, b, SetOperation::kUnion)), 28);
  EXPECT_DOUBLE_EQ(Area(Combined(a, b, SetOperation::kDifference)), 12);
  EXPECT_DOUBLE_EQ(Area(Combined(a, b, SetOperation::kIntersection)), 4);
}

TEST(Combine, FlushRectanglesBecomeOneWithoutASeam) {
  const Region both = Combined(MustRegion({Rectangle(0, 0, 2, 1)}),
                               MustRegion({Rectangle(2, 0, 5, 1)}), SetOperation::kUnion);
  ASSERT_EQ(both.parts.size(), 1u);
  EXPECT_EQ(std::get<Polyline>(both.parts[0].outer).vertices.size(), 4u);
  EXPECT_DOUBLE_EQ(Area(both), 5);
}

TEST(Combine, ADifferenceFromInsideMakesAHole) {
  const Region ring =
      Combined(MustRegion({Square(0, 4)}), MustRegion({Square(1, 3)}), SetOperation::kDifference);
  ASSERT_EQ(ring.parts.size(), 1u);
  EXPECT_EQ(ring.parts[0].holes.size(), 1u);
  EXPECT_DOUBLE_EQ(Area(ring), 12);
  const Region filled = Combined(ring, MustRegion({Square(1, 3)}), SetOperation::kUnion);
  EXPECT_EQ(filled.parts[0].holes.size(), 0u);
  EXPECT_DOUBLE_EQ(Area(filled), 16);
}

TEST(Combine, LeavesNothingOfEqualsAndOfWhatIsApart) {
  const Region a = MustRegion({Square(0, 4)}), far = MustRegion({Square(10, 14)});
  EXPECT_TRUE(Combined(a, a, SetOperation::kDifference).parts.empty());
  EXPECT_TRUE(Combined(a, far, SetOperation::kIntersection).parts.empty());
  EXPECT_EQ(Combined(a, far, SetOperation::kUnion).parts.size(), 2u);
  EXPECT_DOUBLE_EQ(Area(Combined(a, a, SetOperation::kUnion)), 16);
}

TEST(Combine, TakesAnyNumber) {
  std::vector<Region> row, cutters;
  for (int i = 0; i < 20; ++i) {
    row.push_back(MustRegion({Rectangle(i, 0, i + 1.5, 1)}));
    cutters.push_back(MustRegion({Rectangle(i + 0.25, 0.25, i + 0.5, 0.5)}));
  }
  EXPECT_DOUBLE_EQ(Area(Combined(row[0], row[1], SetOperation::kUnion)), 2.5);
  EXPECT_NEAR(Area(*Combine(row, {}, SetOperation::kUnion, kFine)), 20.5, 1e-12);
  const auto cut = Combine(row, cutters, SetOperation::kDifference, kFine);
  EXPECT_NEAR(Area(*cut), 20.5 - 20 * 0.0625, 1e-12);
  ASSERT_EQ(cut->parts.size(), 1u);
  EXPECT_EQ(cut->parts[0].holes.size(), 20u);
  const auto common = Combine({row[0], row[1], MustRegion({Square(-1, 0.5)})}, {},
                              SetOperation::kIntersection, kFine);
  EXPECT_TRUE(common->parts.empty());
}

TEST(Combine, RefusesAnotherPlane) {
  Frame upright;
  upright.y = Vec3::UnitZ();
  const auto combined = Combine({MustRegion({Square(0, 4)}), MustRegion({Circle{upright, 1}})}, {},
                                SetOperation::kUnion, kFine);
  ASSERT_FALSE(combined.has_value());
  EXPECT_EQ(combined.error().code, ErrorCode::kNotPlanar);
}

// V(A∪B) = V(A) + V(B) − V(A∩B), and V(A−B) = V(A) − V(A∩B), in any plane, flush or not.
RC_GTEST_PROP(Combine, KeepsAreas, ()) {
  const auto draw = [](double reach) {
    const double x = *rc::gen::inRange(0, 5), y = *rc::gen::inRange(0, 5);
    const bool round = *rc::gen::arbitrary<bool>();
    const double size = *rc::gen::inRange(1, 4) + reach;
    return round ? Round(x, y, size) : Rectangle(x, y, x + size, y + size);
  };
  const Affine m = Moved(DrawRotation(), DrawPoint());
  const Region a = Transformed(MustRegion({draw(0)}), m), b = Transformed(MustRegion({draw(0)}), m);
  const double area_a = FacetArea(a, kFine), area_b = FacetArea(b, kFine);
  const double both = Area(Combined(a, b, SetOperation::kIntersection));
  RC_ASSERT(std::abs(Area(Combined(a, b, SetOperation::kUnion)) - (area_a + area_b - both)) < 1e-7);
  RC_ASSERT(std::abs(Area(Combined(a, b, SetOperation::kDifference)) - (area_a - both)) < 1e-7);
}

}  // namespace
}  // namespace tranos::geom
