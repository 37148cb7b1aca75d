// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/element.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "model/state.h"
#include "tests/model/shapes.h"

namespace tranos::model {
namespace {

const geom::Line kLine{{0, 0, 0}, {3, 4, 0}};

AttributesPtr Coloured(std::uint32_t code, std::uint8_t own = 0) {
  Attributes attributes;
  attributes.colour.code = code;
  attributes.own = own;
  return std::make_shared<const Attributes>(attributes);
}

std::vector<std::uint32_t> LeafColours(const Element& element) {
  std::vector<std::uint32_t> codes;
  ForEachLeaf(element, [&](const Element&, const geom::Affine&, const Attributes& attributes) {
    codes.push_back(attributes.colour.code);
  });
  return codes;
}

TEST(Element, TypesHaveTheirWords) {
  using geom::Vec3;
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  EXPECT_EQ(TypeOf(*MakePoint(0)), "point");
  EXPECT_EQ(TypeOf(*MakeCurve(kLine)), "line");
  EXPECT_EQ(TypeOf(*MakeCurve(geom::Arc{{}, 1, 1})), "arc");
  EXPECT_EQ(TypeOf(*MakeCurve(geom::Circle{{}, 1})), "circle");
  EXPECT_EQ(TypeOf(*MakeCurve(geom::Polyline{corners, false})), "line string");
  EXPECT_EQ(TypeOf(*MakeCurve(geom::Polyline{corners, true})), "shape");
  EXPECT_EQ(TypeOf(*MakeCurve(geom::BsplineCurve{})), "curve");
  EXPECT_EQ(TypeOf(*MakeCurve(geom::Chain{})), "chain");
  EXPECT_EQ(TypeOf(*MakeRegion({geom::Circle{{}, 1}})), "region");
  EXPECT_EQ(TypeOf(*MakeGroupOf({})), "group");
  EXPECT_EQ(TypeOf(*MakeInstance({}, Translation(0))), "arch");
}

TEST(Element, EachChangeOfGeometryChangesTheHash) {
  geom::Frame turned;
  turned.x = geom::Vec3::UnitY();
  turned.y = -geom::Vec3::UnitX();
  const std::vector<ElementPtr> different = {
      MakePoint(0),
      MakePoint(1),
      MakeCurve(kLine),
      MakeCurve(geom::Line{kLine.end, kLine.start}),
      MakeCurve(geom::Polyline{{kLine.start, kLine.end}, false}),
      MakeCurve(geom::Chain{{kLine}, false}),
      MakeCurve(geom::Circle{{}, 1}),
      MakeCurve(geom::Circle{{}, 2}),
      MakeCurve(geom::Circle{turned, 1}),
      MakeCurve(geom::Arc{{}, 1, 1}),
      MakeCurve(geom::Arc{{}, 1, 2}),
      MakeRegion({geom::Circle{{}, 1}}),
      MakeRegion({geom::Circle{{}, 2}}),
      MakeRegion({geom::Circle{{}, 2}, geom::Circle{{}, 1}}),
      MakeGroupOf({MakePoint(0)}),
      MakeGroupOf({MakePoint(1)}),
      MakeInstance({MakePoint(0)}, Translation(0)),
      MakeInstance({MakePoint(0)}, Translation(1)),
      MakeInstance({MakePoint(1)}, Translation(0))};
  std::set<Hash128> hashes;
  for (const ElementPtr& element : different) hashes.insert(element->hash);
  EXPECT_EQ(hashes.size(), different.size());
  EXPECT_EQ(MakeGroupOf({MakePoint(0), MakePoint(1)})->hash,
            MakeGroupOf({MakePoint(1), MakePoint(0)})->hash);
}

TEST(Element, OrderAndDirectionOfOutlinesAreNoPartOfARegion) {
  const geom::Curve outer = geom::Circle{{}, 9}, hole = geom::Circle{{}, 1};
  const geom::Curve other = geom::Circle{{{3, 0, 0}}, 1};
  const ElementPtr region = MakeRegion({outer, hole, other});
  EXPECT_EQ(region->hash, MakeRegion({outer, other, hole})->hash);
  EXPECT_EQ(region->hash, MakeRegion({outer, geom::Reversed(hole), other})->hash);
}

TEST(Element, PartsInheritWhatTheyDoNotOwn) {
  const ElementPtr plain = WithAttributes(*MakePoint(0), Coloured(1));
  const ElementPtr own = WithAttributes(*MakePoint(1), Coloured(2, Attributes::kColour));
  const ElementPtr group = WithAttributes(*MakeGroupOf({}), Coloured(9, Attributes::kColour));
  const ElementPtr filled = WithGeometry(*group, MakeGroupOf({plain, own})->geometry);
  EXPECT_EQ(LeafColours(*filled), (std::vector<std::uint32_t>{1, 2}));
  const ElementPtr placed = MakeInstance({plain, own, filled}, Translation(0), Coloured(5));
  EXPECT_EQ(LeafColours(*placed), (std::vector<std::uint32_t>{5, 2, 5, 2}));
  const ElementPtr nested = MakeInstance({placed}, Translation(0), Coloured(7));
  EXPECT_EQ(LeafColours(*nested), (std::vector<std::uint32_t>{7, 2, 7, 2}));
}

TEST(Element, OwningASettingIsPartOfThePrototype) {
  const ElementPtr plain = MakePoint(0);
  const ElementPtr own = WithAttributes(*plain, Coloured(0, Attributes::kColour));
  EXPECT_EQ(plain->hash, own->hash);
  EXPECT_NE(MakeInstance({plain}, Translation(0))->hash, MakeInstance({own}, Translation(0))->hash);
}

TEST(Element, TransformedGroupsCarryTheirNames) {
  const ElementPtr member = MakePoint(1), gone = MakePoint(2);
  const ElementPtr group =
      MakeGroupOf({member}, {{"kept", {member}, false}, {"consumed", {gone}, false}});
  const ElementPtr transformed = Transformed(*group, Translation(10));
  const Group& moved = *std::get<GroupPtr>(transformed->geometry);
  EXPECT_EQ(moved.names[0].elements[0], moved.members[0]);
  EXPECT_EQ(BoundingBox(*moved.members[0]).min.x(), 11);
  EXPECT_EQ(BoundingBox(*moved.names[1].elements[0]).min.x(), 12);
}

TEST(Element, TransformedInstancesShareTheirPrototype) {
  const ElementPtr instance = MakeInstance({MakePoint(1)}, Translation(1));
  const ElementPtr moved = Transformed(*instance, Translation(0, 2));
  EXPECT_EQ(std::get<InstancePtr>(moved->geometry)->prototype,
            std::get<InstancePtr>(instance->geometry)->prototype);
  EXPECT_EQ(BoundingBox(*moved).max, geom::Vec3(2, 2, 0));
}

TEST(Element, EvidenceHasWords) {
  EXPECT_EQ(EvidenceOf("excavation"), Evidence::kExcavation);
  EXPECT_EQ(WordOf(Evidence::kConjecture), "conjecture");
  EXPECT_EQ(EvidenceOf(""), std::nullopt);
  EXPECT_EQ(EvidenceOf("hearsay"), std::nullopt);
}

TEST(Colour, PaletteIsDarkAtZeroAndTellsColoursApart) {
  const Rgb black = RgbOf({0});
  EXPECT_LT(black.r + black.g + black.b, 3 * 48);
  const auto distance = [](Rgb a, Rgb b) {
    return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
  };
  for (std::uint32_t i = 0; i < 256; ++i) {
    for (std::uint32_t j = 0; j < i; ++j) {
      EXPECT_GT(distance(RgbOf({i}), RgbOf({j})), i < 16 ? 60 : 0) << i << " " << j;
    }
  }
}

TEST(Colour, DescribesIndexAndTriple) {
  EXPECT_EQ(Describe(Colour{37}), "37");
  EXPECT_EQ(Describe(Colour{Colour::kRgb | 0xa0b0c0}), "#a0b0c0");
  EXPECT_EQ(RgbOf({Colour::kRgb | 0xa0b0c0}).g, 0xb0);
}

TEST(View, FramesAreOrthonormalAndLookTheRightWay) {
  const std::vector<std::pair<std::string, geom::Vec3>> towards_viewer = {
      {"front", {0, -1, 0}},
      {"back", {0, 1, 0}},
      {"right", {1, 0, 0}},
      {"left", {-1, 0, 0}},
      {"top", {0, 0, 1}},
      {"bottom", {0, 0, -1}},
      {"iso", geom::Vec3(1, -1, 1).normalized()},
      {"", geom::Vec3(1, -1, 1).normalized()}};
  for (const auto& [direction, z] : towards_viewer) {
    const geom::Frame frame = FrameOf(direction);
    EXPECT_LT((frame.z() - z).norm(), 1e-15) << direction;
    EXPECT_NEAR(frame.x.dot(frame.y), 0, 1e-15);
    EXPECT_NEAR(frame.y.norm(), 1, 1e-15);
  }
  EXPECT_EQ(FrameOf("front").x, geom::Vec3::UnitX());
  EXPECT_EQ(FrameOf("front").y, geom::Vec3::UnitZ());
  EXPECT_GT(FrameOf("iso").y.z(), 0.8);
}

TEST(Depth, CountsGroupsAndPlacedElementsInOneAnother) {
  const ElementPtr point = MakePoint(1);
  EXPECT_EQ(DepthOf(*point), 0);
  const ElementPtr group = MakeGroupOf({MakeGroupOf({point}), point});
  EXPECT_EQ(DepthOf(*group), 2);
  EXPECT_EQ(DepthOf(*Transformed(*group, Translation(1))), 2);
  EXPECT_EQ(DepthOf(*MakeInstance({point, group}, Translation(1))), 3);
}

}  // namespace
}  // namespace tranos::model
