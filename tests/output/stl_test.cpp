// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/stl.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>

#include "geom/solid_primitives.h"
#include "output/write.h"
#include "tests/output/models.h"

namespace tranos::output {
namespace {

using geom::Vec3;

struct Triangle {
  Vec3 normal;
  std::array<Vec3, 3> corners;
};
std::vector<Triangle> ReadBack(const std::string& stl) {
  std::uint32_t count = 0;
  std::memcpy(&count, &stl.at(80), 4);
  EXPECT_EQ(stl.size(), 84 + 50 * std::size_t{count});
  std::vector<Triangle> triangles;
  for (std::size_t at = 84; at < stl.size(); at += 50) {
    std::array<float, 12> f;
    std::memcpy(f.data(), &stl[at], 48);
    triangles.push_back(
        {{f[0], f[1], f[2]}, {{{f[3], f[4], f[5]}, {f[6], f[7], f[8]}, {f[9], f[10], f[11]}}}});
  }
  return triangles;
}
double Volume(const std::vector<Triangle>& triangles) {
  double volume = 0;
  for (const auto& [normal, p] : triangles) volume += p[0].dot(p[1].cross(p[2])) / 6;
  return volume;
}
// Each edge is run along once in either direction.
bool IsClosed(const std::vector<Triangle>& triangles) {
  std::map<std::array<double, 6>, int> balance;
  for (const auto& [normal, p] : triangles) {
    for (int i = 0; i < 3; ++i) {
      const Vec3 &a = p[i], &b = p[(i + 1) % 3];
      ++balance[{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()}];
      --balance[{b.x(), b.y(), b.z(), a.x(), a.y(), a.z()}];
    }
  }
  return std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return !edge.second; });
}
model::ElementPtr SlabOf(const Vec3& size) {
  return ElementOf(
      std::make_shared<const geom::Solid>(*geom::Solid::FromMesh(*geom::SlabMesh({}, size))));
}
model::ElementPtr Placed(const model::ElementPtr& part, const geom::Affine& where) {
  const auto prototype = std::make_shared<model::Prototype>();
  prototype->words = "block";
  prototype->parts = {part};
  const auto instance = std::make_shared<model::Instance>();
  instance->prototype = prototype;
  instance->world_from_prototype = where;
  return ElementOf(model::InstancePtr(instance));
}

TEST(Stl, ASolidIsClosedAndTurnedOutward) {
  const auto triangles = ReadBack(*StlOf(ModelOf({SlabOf({4, 3, 2})})));
  EXPECT_EQ(triangles.size(), 12u);
  EXPECT_TRUE(IsClosed(triangles));
  EXPECT_NEAR(Volume(triangles), 24, 1e-4);
  for (const auto& [normal, p] : triangles) {
    const Vec3 own = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    EXPECT_LT((normal - own).norm(), 1e-6);
  }
}

TEST(Stl, InstancesAreWrittenOutAndMirroredOnesStayOutward) {
  geom::Affine mirrored = geom::Affine::Identity();
  mirrored.linear() = Vec3(-1, 1, 2).asDiagonal();
  geom::Affine beside = geom::Affine::Identity();
  beside.translation() = Vec3(10, 0, 0);
  const model::ElementPtr slab = SlabOf({4, 3, 2});
  const auto triangles = ReadBack(*StlOf(ModelOf({Placed(slab, beside), Placed(slab, mirrored)})));
  EXPECT_EQ(triangles.size(), 24u);
  EXPECT_TRUE(IsClosed(triangles));
  EXPECT_NEAR(Volume(triangles), 24 + 48, 1e-3);
}

TEST(Stl, FarFromTheOriginItIsStillClosed) {
  // The sphere's smallest facets are below what single precision tells apart there.
  geom::Affine far = geom::Affine::Identity();
  far.translation() = Vec3(500000, 4649776, 12);
  EXPECT_TRUE(IsClosed(ReadBack(*StlOf(ModelOf({Placed(SphereOf(), far)})))));
}

TEST(Stl, CurvesAndHiddenLevelsAreLeftOut) {
  model::Attributes attic;
  attic.level = "attic";
  const auto wall = WallOf(Vec3::Zero(), 4, 3);
  model::Edit edit;
  edit.added = {LineOf({0, 0, 0}, {1, 0, 0}), wall, ElementOf(wall->geometry, attic)};
  edit.hidden_levels = {"attic"};
  const model::Model model = model::Apply(model::State{}, edit).state.model;
  EXPECT_EQ(ReadBack(*StlOf(model)).size(), 2u);
}

TEST(Stl, TheExtensionChoosesIt) {
  const model::Model model = ModelOf({SlabOf({1, 1, 1})});
  EXPECT_EQ(*ExportOf({model, "Hall.STL"}, 1), *StlOf(model));
}

}  // namespace
}  // namespace tranos::output
