// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/hash.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <limits>
#include <set>

#include "tests/model/shapes.h"

namespace tranos::model {
namespace {

Hash128 OfLength(double metres) { return Hasher().Length(metres).Finish(); }

TEST(Hash, RoundsLengthsToTheirGrid) {
  EXPECT_EQ(OfLength(0.0), OfLength(-0.0));
  EXPECT_EQ(OfLength(0.1 + 0.2), OfLength(0.3));
  EXPECT_NE(OfLength(1), OfLength(1 + 0x1p-29));
  EXPECT_NE(OfLength(1), OfLength(-1));
}

TEST(Hash, TakesNumbersBeyondTheGrid) {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> numbers = {
      0,         1e300,  -1e300,  infinity,
      -infinity, 0x1p31, -0x1p31, std::numeric_limits<double>::quiet_NaN()};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    EXPECT_EQ(OfLength(numbers[i]), OfLength(numbers[i]));
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(OfLength(numbers[i]), OfLength(numbers[j]));
  }
}

TEST(Hash, SumAndDifferenceCarry) {
  EXPECT_TRUE(rc::check([](std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint64_t d) {
    const Hash128 p{a, b}, q{c, d};
    RC_ASSERT((p + q) - q == p);
    RC_ASSERT(p + q == q + p);
  }));
  EXPECT_EQ((Hash128{0, ~0ull} + Hash128{0, 1}), (Hash128{1, 0}));
}

TEST(Hash, HexHasThirtyTwoDigits) {
  EXPECT_EQ(Hex({0x0123456789abcdef, 0xf}), "0123456789abcdef000000000000000f");
}

TEST(Hash, LongTextDependsOnEveryByte) {
  EXPECT_TRUE(rc::check([] {
    std::string text(*rc::gen::inRange<std::size_t>(1, 2000), 'a');
    const Hash128 before = Hasher().Text("x").Text(text).Integer(3).Finish();
    text[*rc::gen::inRange<std::size_t>(0, text.size())] = 'b';
    RC_ASSERT(before != Hasher().Text("x").Text(text).Integer(3).Finish());
  }));
}

TEST(Hash, OfTheModelIsFreeOfOrder) {
  EXPECT_TRUE(rc::check([](const std::vector<int>& places) {
    std::vector<ElementPtr> elements;
    for (const int x : places) elements.push_back(MakePoint(x));
    const Hash128 forward = With({}, elements).model.hash;
    std::reverse(elements.begin(), elements.end());
    RC_ASSERT(With({}, elements).model.hash == forward);
  }));
}

TEST(Hash, OfAnElementKnowsEachAttributeButNotIdOrTolerance) {
  const Attributes plain;
  const auto hash = [](const Attributes& attributes) {
    return MakeElement(0, Point{geom::Vec3::Zero()}, std::make_shared<const Attributes>(attributes),
                       nullptr, {})
        ->hash;
  };
  std::vector<Attributes> variants(7);
  variants[0].colour.code = 3;
  variants[1].linestyle = 1;
  variants[2].weight = 2;
  variants[3].level = "2";
  variants[4].material = "stone";
  variants[5].evidence = Evidence::kPhoto;
  variants[6].source = "archive";
  for (const Attributes& variant : variants) EXPECT_NE(hash(variant), hash(plain));
  Attributes owned;
  owned.own = Attributes::kColour;
  EXPECT_EQ(hash(owned), hash(plain));

  const ElementPtr point = MakePoint(1);
  EXPECT_EQ(WithId(*point, 9)->hash, point->hash);
  EXPECT_NE(WithName(*point, "sill")->hash, point->hash);
  EXPECT_EQ(MakeElement(4, point->geometry, point->attributes, nullptr, {0.5, 12})->hash,
            point->hash);
}

TEST(Hash, OfTheStateKnowsItsParts) {
  const State state = With({}, {MakePoint(0), MakePoint(1)});
  const Hash128 hash = HashOf(state);
  State other = state;
  other.drawing.last_point.x() = 1;
  EXPECT_NE(HashOf(other), hash);
  other = state;
  other.drawing.selection = {1, 0};
  const Hash128 chosen = HashOf(other);
  EXPECT_NE(chosen, hash);
  other.drawing.selection = {0, 1};
  EXPECT_NE(HashOf(other), chosen);
  other = state;
  other.drawing.names.Bind(0, 1, other.model.entries);
  EXPECT_NE(HashOf(other), hash);
  other = state;
  auto settings = std::make_shared<Settings>();
  settings->angle_rad = 1;
  other.drawing.settings = settings;
  EXPECT_NE(HashOf(other), hash);
}

TEST(Hash, OfTheStateKnowsHowTheNextPictureLooks) {
  const State state = With({}, {MakePoint(0), MakePoint(1)});
  const View plain;
  View direction, textured, photo, shadows, first, second;
  direction.direction = "top";
  textured.textured = true;
  photo.photo = true;
  shadows.shadows = true;
  first.camera = 0;
  second.camera = 1;
  std::set<std::string> hashes;
  for (const View& view : {plain, direction, textured, photo, shadows, first, second}) {
    State other = state;
    other.drawing.view = std::make_shared<const View>(view);
    hashes.insert(Hex(HashOf(other)));
  }
  EXPECT_EQ(hashes.size(), 7);
}

TEST(Hash, OfTheStateIsFreeOfIds) {
  const State direct = With({}, {MakePoint(1)});
  State detour = With(With({}, {MakePoint(7)}), {MakePoint(1)});
  Edit edit;
  edit.deleted = {0};
  detour = Apply(detour, edit).state;
  EXPECT_EQ(HashOf(detour), HashOf(direct));
}

}  // namespace
}  // namespace tranos::model
