// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/gltf.h"

#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <cstring>

#include "output/facets.h"
#include "output/write.h"
#include "tests/output/models.h"

namespace tranos::output {
namespace {

using geom::Vec3;

tinygltf::Model ReadBack(const std::string& glb) {
  tinygltf::Model file;
  std::string error, warning;
  EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromMemory(
      &file, &error, &warning, reinterpret_cast<const unsigned char*>(glb.data()),
      static_cast<unsigned>(glb.size())))
      << error;
  EXPECT_EQ(error + warning, "");
  return file;
}
std::string Extra(const tinygltf::Node& node, const char* key) {
  return node.extras.Get(key).Get<std::string>();
}
Vec3 Translation(const tinygltf::Node& node) {
  return node.translation.empty() ? Vec3::Zero() : Vec3(Vec3::Map(node.translation.data()));
}
Vec3 Vertex(const tinygltf::Model& file, int mesh, std::size_t index) {
  const auto& primitive = file.meshes[mesh].primitives[0];
  const auto& accessor = file.accessors[primitive.attributes.at("POSITION")];
  const auto& view = file.bufferViews[accessor.bufferView];
  float xyz[3];
  std::memcpy(xyz, &file.buffers[0].data[view.byteOffset + accessor.byteOffset + 12 * index], 12);
  return {xyz[0], xyz[1], xyz[2]};
}

TEST(Gltf, FarLineKeepsItsMillimetres) {
  const Vec3 a(500000, 4649776.125, 12), b(500000.001, 4649776.125, 12);
  const tinygltf::Model file = ReadBack(*GlbOf(ModelOf({LineOf(a, b)}), {}));
  ASSERT_EQ(file.nodes.size(), 2u);
  EXPECT_EQ(file.meshes[0].primitives[0].mode, TINYGLTF_MODE_LINE);
  const Vec3 centre = Translation(file.nodes[1]);
  EXPECT_LT((centre + Vertex(file, 0, 0) - a).norm(), 1e-8);
  EXPECT_LT((centre + Vertex(file, 0, 1) - b).norm(), 1e-8);
}

TEST(Gltf, RegionIsAFaceWithItsHole) {
  const geom::Region region = *geom::RegionOf({geom::Circle{{}, 5}, geom::Circle{{}, 2}});
  const model::ElementPtr element = ElementOf(std::make_shared<const geom::Region>(region));
  const auto facets = FacetsOf(*element, {1e-4});
  ASSERT_TRUE(facets.has_value());
  double area = 0;
  for (const auto& t : facets->mesh.triangles) {
    const Vec3& p = facets->mesh.positions[t[0]];
    area += 0.5 * (facets->mesh.positions[t[1]] - p).cross(facets->mesh.positions[t[2]] - p).z();
  }
  EXPECT_NEAR(area, geom::kPi * 21, 1e-2);
  EXPECT_EQ(facets->mesh.edges.size(), facets->mesh.positions.size());
  const tinygltf::Model file = ReadBack(*GlbOf(ModelOf({element}), {}));
  EXPECT_EQ(file.meshes[0].primitives[0].mode, TINYGLTF_MODE_TRIANGLES);
}

TEST(Gltf, RootTurnsZUpIntoYUp) {
  const tinygltf::Model file = ReadBack(*GlbOf(ModelOf({LineOf({0, 0, 0}, {1, 0, 0})}), {}));
  const auto& q = file.nodes[0].rotation;
  const Vec3 up = Eigen::Quaterniond(q[3], q[0], q[1], q[2]) * Vec3::UnitZ();
  EXPECT_LT((up - Vec3::UnitY()).norm(), 1e-12);
}

TEST(Gltf, ExtrasTellNameLevelAndEvidence) {
  model::Attributes attributes;
  attributes.level = "walls";
  attributes.evidence = model::Evidence::kPhoto;
  attributes.source = "plate 12";
  const auto element = ElementOf(model::Point{{1, 2, 3}}, attributes, "north \"a\"\n");
  const tinygltf::Model file = ReadBack(*GlbOf(ModelOf({element}), {}));
  const tinygltf::Node& node = file.nodes[1];
  EXPECT_EQ(node.name, "north \"a\"\n");
  EXPECT_EQ(Extra(node, "level"), "walls");
  EXPECT_EQ(Extra(node, "evidence"), "photo");
  EXPECT_EQ(Extra(node, "source"), "plate 12");
  EXPECT_EQ(Extra(node, "type"), "point");
  EXPECT_EQ(Translation(node), Vec3(1, 2, 3));
}

TEST(Gltf, InstancesAndEqualPointsShareMeshes) {
  const auto prototype = std::make_shared<model::Prototype>();
  prototype->words = "ball";
  prototype->parts = {SphereOf()};
  std::vector<model::ElementPtr> elements;
  for (int i = 0; i < 10; ++i) {
    const auto instance = std::make_shared<model::Instance>();
    instance->prototype = prototype;
    instance->world_from_prototype = Eigen::Translation3d(3.0 * i, 0, 0);
    elements.push_back(ElementOf(model::InstancePtr(instance)));
    elements.push_back(ElementOf(model::Point{{3.0 * i, 5, 0}}));
  }
  const tinygltf::Model file = ReadBack(*GlbOf(ModelOf(elements), {}));
  EXPECT_EQ(file.meshes.size(), 2u);
  EXPECT_EQ(file.nodes[0].children.size(), 20u);
}

TEST(Gltf, ShearedInstanceLandsWhereItShould) {
  const auto prototype = std::make_shared<model::Prototype>();
  prototype->words = "bar";
  prototype->parts = {LineOf({1, 2, 3}, {2, 4, 7})};
  const auto instance = std::make_shared<model::Instance>();
  instance->prototype = prototype;
  instance->world_from_prototype.linear() << 1, 0.5, 0, 0, -2, 0.25, 0.1, 0, 3;
  instance->world_from_prototype.translation() = Vec3(7, 8, 9);
  const tinygltf::Model file =
      ReadBack(*GlbOf(ModelOf({ElementOf(model::InstancePtr(instance))}), {}));
  int index = file.nodes[0].children[0];
  geom::Affine world = geom::Affine::Identity();
  for (;;) {
    const tinygltf::Node& node = file.nodes[index];
    world.translate(Translation(node));
    if (!node.rotation.empty()) {
      const auto& q = node.rotation;
      world.rotate(Eigen::Quaterniond(q[3], q[0], q[1], q[2]));
    }
    if (!node.scale.empty()) world.scale(Vec3(Vec3::Map(node.scale.data())));
    if (node.children.empty()) break;
    index = node.children[0];
  }
  EXPECT_LT((world * Vertex(file, 0, 0) - instance->world_from_prototype * Vec3(1, 2, 3)).norm(),
            1e-6);
  EXPECT_LT((world * Vertex(file, 0, 1) - instance->world_from_prototype * Vec3(2, 4, 7)).norm(),
            1e-6);
}

TEST(Gltf, HiddenLevelsStayOut) {
  model::Model model = ModelOf({LineOf({0, 0, 0}, {1, 0, 0})});
  model.hidden_levels = std::make_shared<const std::vector<std::string>>(1, "1");
  EXPECT_TRUE(ReadBack(*GlbOf(model, {})).nodes[0].children.empty());
}

model::ElementPtr PhotographOn(const char* level) {
  camera::Estimate estimate;
  estimate.camera.parameters << 36, 1, 0, 0, geom::kPi / 2, 0, 0, 0, 0, -10, 2;
  model::Photograph photograph;
  photograph.attached = true;
  photograph.frame = {{36, 24}, {36, 24}};
  photograph.estimate = std::make_shared<const camera::Estimate>(estimate);
  camera::Photo pixels{36, 24, std::vector<std::uint8_t>(std::size_t{3} * 36 * 24)};
  photograph.picture = std::make_shared<const camera::PhotoFile>(
      std::make_shared<const camera::Photo>(std::move(pixels)));
  model::Attributes attributes;
  attributes.level = level;
  return ElementOf(std::make_shared<const model::Photograph>(photograph), attributes);
}

std::vector<tinygltf::Primitive> Textured(const tinygltf::Model& file) {
  std::vector<tinygltf::Primitive> textured;
  for (const tinygltf::Mesh& mesh : file.meshes) {
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      if (primitive.attributes.contains("TEXCOORD_0")) textured.push_back(primitive);
    }
  }
  return textured;
}

TEST(Gltf, OfTwoOrthophotosInOnePlaceTheEarlierIsSeenWhereTheLaterShowsNothing) {
  // The later camera stands so far to the right that its photograph begins at x = 2.15 m.
  const double left_m = 2.15, half_m = 10 * 40.5 / 25 / 2;
  const std::vector<model::ElementPtr> two{EvenOrthophoto(90),
                                           EvenOrthophoto(200, {left_m + half_m, -10, 1.5})};
  for (const bool has_wall : {true, false}) {
    std::vector<model::ElementPtr> elements = two;
    if (has_wall) elements.push_back(WallOf({0, 0, 0}, 4, 3));
    const tinygltf::Model file = ReadBack(*GlbOf(ModelOf(elements), {}));
    ASSERT_EQ(Textured(file).size(), 1U) << "on a wall: " << has_wall;
    ASSERT_EQ(file.images.size(), 1U);
    const tinygltf::Image& image = file.images[0];
    ASSERT_EQ(image.width, 200);
    const auto tone = [&](int x) { return image.image[image.component * (75 * image.width + x)]; };
    EXPECT_EQ(tone(20), 90);
    EXPECT_EQ(tone(100), 90);
    EXPECT_EQ(tone(115), 200);
    EXPECT_EQ(tone(180), 200);
  }
}

TEST(Gltf, APhotographsPlaneIsPlacedByWhatIsVisible) {
  model::Attributes off;
  off.level = "off";
  model::Model model = ModelOf({PhotographOn("1"), WallOf({0, 0, 0}, 4, 3)});
  const auto plane_of = [](const model::Model& shown) {
    const tinygltf::Model file = ReadBack(*GlbOf(shown, {.photographs = true}));
    for (const tinygltf::Node& node : file.nodes) {
      if (node.name == "photograph at its frame") return Translation(node);
    }
    return Vec3(0, 0, 0);
  };
  const Vec3 alone = plane_of(model);
  EXPECT_NEAR(alone.y(), -10 + Vec3(2, 10, -0.5).norm() / 7, 1e-6);
  const auto far_off = ElementOf(std::make_shared<const geom::Surface>(*geom::Extrusion(
                                     geom::Line{{0, 300, 0}, {9, 300, 0}}, Vec3(0, 0, 9))),
                                 off);
  model = ModelOf({PhotographOn("1"), WallOf({0, 0, 0}, 4, 3), far_off});
  EXPECT_GT((plane_of(model) - alone).norm(), 1);
  model.hidden_levels = std::make_shared<const std::vector<std::string>>(1, "off");
  EXPECT_EQ(plane_of(model), alone);
}

TEST(Gltf, APhotographOnALevelThatIsOffIsNotThere) {
  model::Model model = ModelOf({PhotographOn("off"), WallOf({0, 0, 0}, 4, 3)});
  EXPECT_EQ(ReadBack(*GlbOf(model, {.photographs = true})).nodes.size(), 4U);
  model.hidden_levels = std::make_shared<const std::vector<std::string>>(1, "off");
  EXPECT_EQ(ReadBack(*GlbOf(model, {.photographs = true})).nodes.size(), 2U);
}

TEST(Gltf, SameModelSameBytes) {
  EXPECT_EQ(*GlbOf(ModelOf({SphereOf()}), {}), *GlbOf(ModelOf({SphereOf()}), {}));
}

TEST(Gltf, TooLargeIsAnError) {
  EXPECT_FALSE(GlbOf(ModelOf({SphereOf()}), {.max_bytes = 1000}).has_value());
}

TEST(Write, UnknownExtensionListsThoseThereAre) {
  const auto result = ExportOf({ModelOf({}), "church.dwg"}, 1);
  ASSERT_FALSE(result.has_value());
  EXPECT_NE(result.error().message.find(".glb"), std::string::npos);
  EXPECT_TRUE(ExportOf({ModelOf({}), "a.b/church.GLB"}, 1).has_value());
}

}  // namespace
}  // namespace tranos::output
