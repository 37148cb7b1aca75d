// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/gltf.h"

#include <cmath>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "model/faces.h"
#include "output/factors.h"
#include "output/gltf_pictures.h"
#include "output/gltf_tables.h"
#include "output/material.h"

namespace tranos::output {
namespace {

using geom::Affine;
using geom::Vec2;
using geom::Vec3;
using model::Attributes;
using model::Element;

// Builds the file from what is in the model, each thing once: accessors by content, materials by
// look, meshes by both.
class GlbBuilder {
 public:
  GlbBuilder(const model::Model& model, const GltfOptions& options)
      : model_(model), options_(options), pictures_(model, options.threads, &tables_) {}

  Result<std::string> Build();

 private:
  // The node of an element and of all below it, -1 where nothing of it is visible. `origin` is
  // where the parent node's origin lies in the element's frame, `world` where that frame lies.
  int AddElement(const Element& element, const Vec3& origin, const Affine& world,
                 const Attributes& attributes, bool shared);
  int AddLeaf(const Element& leaf, const Vec3& origin, const Affine& world,
              const Attributes& attributes, bool shared);
  // The mesh of a leaf some of whose faces bear orthophotos; -1 where none does.
  int PastedMesh(const Element& leaf, const Vec3& centre, const Affine& world,
                 const Attributes& attributes, bool shared);
  int AddGroup(const Element& element, const model::Group& group, const Vec3& origin,
               const Affine& world, const Attributes& attributes, bool shared);
  int AddCamera(const Element& element, const model::Photograph& photograph, const Vec3& origin);
  int AddInstance(const Element& element, const model::Instance& instance, const Vec3& origin,
                  const Affine& world, const Attributes& attributes);
  std::vector<int> AddMembers(const std::vector<model::ElementPtr>& members, const Vec3& origin,
                              const Affine& world, const Attributes& attributes, bool shared);

  struct PlacedGeometry {
    int geometry = -1;  // -1: nothing to draw
    Vec3 centre = Vec3::Zero();
  };
  PlacedGeometry GeometryOf(const Element& leaf, bool shared);
  const geom::Box& BoxOf(const Element& leaf, bool shared);
  const Facets* FacetsFor(const Element& leaf, bool shared);
  int MeshOf(int geometry, int material);
  int MaterialOf(const Attributes& attributes, bool surface);

  const model::Model& model_;
  const GltfOptions& options_;
  GlbTables tables_;
  GlbPictures pictures_;
  std::unordered_map<const Element*, PlacedGeometry> geometry_of_part_;  // of prototypes' parts
  std::unordered_map<const Element*, geom::Box> box_of_part_;            // likewise
  std::unordered_map<const Element*, Facets> facets_of_part_;  // of those that lie at orthophotos
  geom::Box box_;                                              // of the leaf asked for last
  Facets facets_;                                              // likewise
  std::map<std::pair<int, int>, int> mesh_by_geometry_and_material_;
  std::map<std::tuple<std::uint32_t, std::string, bool>, int> materials_;
  std::optional<Error> error_;
};

int GlbBuilder::AddElement(const Element& element, const Vec3& origin, const Affine& world,
                           const Attributes& attributes, bool shared) {
  if (const auto* group = std::get_if<model::GroupPtr>(&element.geometry)) {
    return AddGroup(element, **group, origin, world, attributes, shared);
  }
  if (const auto* instance = std::get_if<model::InstancePtr>(&element.geometry)) {
    return AddInstance(element, **instance, origin, world, attributes);
  }
  if (const auto* photograph = std::get_if<model::PhotographPtr>(&element.geometry)) {
    return AddCamera(element, **photograph, origin);
  }
  if (!model::IsBuilt(element)) return -1;
  return AddLeaf(element, origin, world, attributes, shared);
}

int GlbBuilder::AddLeaf(const Element& leaf, const Vec3& origin, const Affine& world,
                        const Attributes& attributes, bool shared) {
  if (!model_.LevelIsOn(attributes.level)) return -1;
  if (model::HasFaces(leaf) && pictures_.any() && pictures_.Touch(BoxOf(leaf, shared), world)) {
    const Vec3 centre = BoxOf(leaf, shared).centre();
    const int pasted = PastedMesh(leaf, centre, world, attributes, shared);
    if (error_) return -1;
    if (pasted >= 0) {
      tinygltf::Node node = NodeOf(leaf, attributes);
      Translate(node, centre - origin);
      node.mesh = pasted;
      return tables_.AddNode(std::move(node));
    }
  }
  const PlacedGeometry placed = GeometryOf(leaf, shared);
  if (error_) return -1;
  tinygltf::Node node = NodeOf(leaf, attributes);
  Translate(node, placed.centre - origin);
  if (placed.geometry >= 0) {
    const bool surface = tables_.geometry(placed.geometry).mode == TINYGLTF_MODE_TRIANGLES;
    node.mesh = MeshOf(placed.geometry, MaterialOf(attributes, surface));
  }
  return tables_.AddNode(std::move(node));
}

std::vector<int> GlbBuilder::AddMembers(const std::vector<model::ElementPtr>& members,
                                        const Vec3& origin, const Affine& world,
                                        const Attributes& attributes, bool shared) {
  std::vector<int> nodes;
  for (const model::ElementPtr& member : members) {
    const int node =
        AddElement(*member, origin, world, model::Inherit(*member->attributes, attributes), shared);
    if (node >= 0) nodes.push_back(node);
  }
  return nodes;
}

int GlbBuilder::AddGroup(const Element& element, const model::Group& group, const Vec3& origin,
                         const Affine& world, const Attributes& attributes, bool shared) {
  const geom::Box box = model::BoundingBox(element);
  const Vec3 centre = box.empty() ? origin : box.centre();
  std::vector<int> children = AddMembers(group.members, centre, world, attributes, shared);
  if (children.empty()) return -1;
  tinygltf::Node node = NodeOf(element, attributes);
  Translate(node, centre - origin);
  node.children = std::move(children);
  return tables_.AddNode(std::move(node));
}

void Rotate(tinygltf::Node& node, const Eigen::Matrix3d& rotation) {
  if (rotation.isIdentity(0)) return;
  const Eigen::Quaterniond q = Eigen::Quaterniond(rotation).normalized();
  node.rotation = {q.x() + 0.0, q.y() + 0.0, q.z() + 0.0, q.w() + 0.0};
}

// glTF cannot hold a shear in one node; two, one inside the other, can (a singular value
// decomposition), and the geometry stays shared.
int GlbBuilder::AddInstance(const Element& element, const model::Instance& instance,
                            const Vec3& origin, const Affine& world, const Attributes& attributes) {
  const Affine& placement = instance.world_from_prototype;
  std::vector<int> children =
      AddMembers(instance.prototype->parts, Vec3::Zero(), world * placement, attributes, true);
  if (children.empty()) return -1;
  const Factors factors = FactorsOf(placement.linear());
  if (!factors.before.isIdentity(0)) {
    tinygltf::Node inner;
    Rotate(inner, factors.before);
    inner.children = std::move(children);
    children = {tables_.AddNode(std::move(inner))};
  }
  tinygltf::Node node = NodeOf(element, attributes);
  Translate(node, placement.translation() - origin);
  Rotate(node, factors.rotation);
  if (factors.scale != Vec3::Ones()) node.scale = ListOf(factors.scale);
  node.children = std::move(children);
  return tables_.AddNode(std::move(node));
}

// A camera as glTF can hold it, with a centred principal point and no skew; what the photograph's
// own is stands in the extras: its parameters in millimetres and radians, and the exact matrix
// from the model to dots.
int GlbBuilder::AddCamera(const Element& element, const model::Photograph& photograph,
                          const Vec3& origin) {
  if (!HasCamera(photograph) || !model_.LevelIsOn(element.attributes->level)) return -1;
  using tinygltf::Value;
  const camera::Camera& camera = photograph.estimate->camera;
  const Vec2 size_mm = photograph.frame.size_mm;
  const double fx = camera[camera::kFocal], fy = fx * camera[camera::kAspect];
  tinygltf::Camera lens;
  lens.type = "perspective";
  lens.name = element.name ? *element.name : "camera";
  lens.perspective.yfov = 2 * std::atan2(size_mm.y() / 2, fy);
  lens.perspective.aspectRatio = (size_mm.x() / fx) / (size_mm.y() / fy);
  // Through the camera itself the plane at its frame is not seen, which would hide all else.
  lens.perspective.znear = options_.photographs ? 1.01 * pictures_.PlaneDepth_m(photograph) : 0.01;
  lens.perspective.zfar = 1e6;
  Value::Object extras;
  for (int i = 0; i < camera::kParameters; ++i) {
    extras.emplace(camera::kParameterNames[i], Value(camera.parameters[i]));
  }
  Value::Array matrix;
  const camera::ProjectionMatrix dot_from_world = camera::DotFromWorld(camera, photograph.frame);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) matrix.emplace_back(dot_from_world(row, column));
  }
  extras.emplace("dot_from_world", Value(std::move(matrix)));
  extras.emplace("photograph", Value(photograph.file));
  lens.extras = Value(std::move(extras));
  tinygltf::Node node = NodeOf(element, *element.attributes);
  node.camera = static_cast<int>(tables_.file.cameras.size());
  tables_.file.cameras.push_back(std::move(lens));
  Translate(node, camera.position_m() - origin);
  // glTF's cameras look along −z, with y up.
  const Eigen::Matrix3d world_from_camera =
      camera::CameraFromWorld(camera.parameters).transpose() * Vec3(1, -1, -1).asDiagonal();
  Rotate(node, world_from_camera);
  return tables_.AddNode(std::move(node));
}

GlbBuilder::PlacedGeometry GlbBuilder::GeometryOf(const Element& leaf, bool shared) {
  if (const auto* point = std::get_if<model::Point>(&leaf.geometry)) {
    Content origin;
    origin.AddPosition(Vec3::Zero());
    return {tables_.AddGeometry(origin), point->position};
  }
  if (shared) {
    const auto known = geometry_of_part_.find(&leaf);
    if (known != geometry_of_part_.end()) return known->second;
  }
  const Result<Facets> facets = FacetsOf(leaf, leaf.tolerance);
  if (!facets) {
    error_ = facets.error();
    return {};
  }
  PlacedGeometry placed;
  const geom::Box box = model::BoundingBox(leaf);
  if (!box.empty()) placed.centre = box.centre();
  const Content content = ContentOf(*facets, placed.centre);
  if (!content.positions.empty()) placed.geometry = tables_.AddGeometry(content);
  if (shared) geometry_of_part_.emplace(&leaf, placed);
  return placed;
}

const geom::Box& GlbBuilder::BoxOf(const Element& leaf, bool shared) {
  if (!shared) return box_ = model::BoundingBox(leaf);
  const auto [known, is_new] = box_of_part_.try_emplace(&leaf);
  if (is_new) known->second = model::BoundingBox(leaf);
  return known->second;
}

// Null where they cannot be made.
const Facets* GlbBuilder::FacetsFor(const Element& leaf, bool shared) {
  const auto known = shared ? facets_of_part_.find(&leaf) : facets_of_part_.end();
  if (known != facets_of_part_.end()) return &known->second;
  Result<Facets> facets = FacetsOf(leaf, leaf.tolerance);
  if (!facets) {
    error_ = facets.error();
    return nullptr;
  }
  Facets& kept = shared ? facets_of_part_[&leaf] : facets_;
  return &(kept = *std::move(facets));
}

int GlbBuilder::PastedMesh(const Element& leaf, const Vec3& centre, const Affine& world,
                           const Attributes& attributes, bool shared) {
  const Facets* const facets = FacetsFor(leaf, shared);
  if (!facets) return -1;
  const auto split = pictures_.Split(facets->mesh, world, model::HasOutside(leaf));
  if (!split) return -1;
  std::vector<tinygltf::Primitive> primitives;
  if (!split->plain.triangles.empty()) {
    primitives.push_back(tables_.PrimitiveOf(split->plain, centre));
    primitives.back().material = MaterialOf(attributes, true);
  }
  const model::Rgb beneath = SurfaceColour(attributes.colour, attributes.material);
  for (const BearingMesh& bearing : split->bearing) {
    primitives.push_back(pictures_.PrimitiveOf(bearing, centre, beneath));
  }
  return tables_.AddMesh(std::move(primitives));
}

int GlbBuilder::MeshOf(int geometry, int material) {
  const auto [known, is_new] = mesh_by_geometry_and_material_.try_emplace(
      {geometry, material}, static_cast<int>(tables_.file.meshes.size()));
  if (is_new) {
    const Geometry& accessors = tables_.geometry(geometry);
    tinygltf::Primitive primitive;
    primitive.mode = accessors.mode;
    primitive.material = material;
    primitive.indices = accessors.indices;
    primitive.attributes["POSITION"] = accessors.positions;
    if (accessors.normals >= 0) primitive.attributes["NORMAL"] = accessors.normals;
    tables_.file.meshes.emplace_back().primitives.push_back(std::move(primitive));
  }
  return known->second;
}

int GlbBuilder::MaterialOf(const Attributes& attributes, bool surface) {
  const auto [known, is_new] =
      materials_.try_emplace({attributes.colour.code, attributes.material, surface},
                             static_cast<int>(tables_.file.materials.size()));
  if (is_new) {
    const model::Rgb rgb = surface ? SurfaceColour(attributes.colour, attributes.material)
                                   : model::RgbOf(attributes.colour);
    tinygltf::Material material;
    material.name = attributes.material.empty() ? "colour " + model::Describe(attributes.colour)
                                                : attributes.material;
    material.doubleSided = surface;
    material.pbrMetallicRoughness.baseColorFactor = {LinearFromSrgb(rgb.r), LinearFromSrgb(rgb.g),
                                                     LinearFromSrgb(rgb.b), 1.0};
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = 0.8;
    tables_.file.materials.push_back(std::move(material));
  }
  return known->second;
}

Result<std::string> GlbBuilder::Build() {
  tinygltf::Model& file = tables_.file;
  file.asset.version = "2.0";
  file.asset.generator = "Tranos";
  tinygltf::Node root;
  root.name = "Z up, in metres";
  root.rotation = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
  tables_.AddNode(std::move(root));
  file.nodes.reserve(model_.live + 1);
  std::vector<int> children;
  model_.ForEach([&](const model::ElementPtr& element) {
    if (error_) return;
    const int node =
        AddElement(*element, Vec3::Zero(), Affine::Identity(), *element->attributes, false);
    if (node < 0) return;
    children.push_back(node);
    const auto* photograph = std::get_if<model::PhotographPtr>(&element->geometry);
    if (!photograph || !options_.photographs) return;
    const Result<int> plane = pictures_.AddPhotographPlane(*element, **photograph);
    if (!plane) error_ = plane.error();
    if (plane && *plane >= 0) children.push_back(*plane);
  });
  if (error_) return tl::unexpected(*error_);
  for (const int node : pictures_.AddUnborne()) children.push_back(node);
  if (auto error = pictures_.MakePictures()) return tl::unexpected(*std::move(error));
  file.nodes[0].children = std::move(children);
  file.defaultScene = 0;
  file.scenes.emplace_back().nodes = {0};
  return tables_.Bytes(options_.max_bytes);
}

}  // namespace

Result<std::string> GlbOf(const model::Model& model, const GltfOptions& options) {
  return GlbBuilder(model, options).Build();
}

}  // namespace tranos::output
