// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/gltf.h"

#include <tiny_gltf.h>

#include <cmath>
#include <cstring>
#include <map>
#include <sstream>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "output/facets.h"
#include "output/factors.h"
#include "output/material.h"
#include "output/pasting.h"
#include "output/picture_plane.h"
#include "output/png.h"

namespace tranos::output {
namespace {

using geom::Affine;
using geom::Vec2;
using geom::Vec3;
using model::Attributes;
using model::Element;

// A leaf's vertices and indices in the buffer, as accessors' indices; -1 for none.
struct Geometry {
  int mode = TINYGLTF_MODE_POINTS;
  int positions = -1, normals = -1, indices = -1;
};
// The same in plain numbers, before it is known whether the buffer already has it.
struct Content {
  int mode = TINYGLTF_MODE_POINTS;
  std::vector<float> positions, normals;
  std::vector<std::uint32_t> indices;

  void AddPosition(const Vec3& p) {
    for (int i = 0; i < 3; ++i) positions.push_back(static_cast<float>(p[i]) + 0.0f);
  }
  std::string Bytes() const;
};

template <class T>
void AppendBytes(std::string& bytes, const std::vector<T>& items) {
  bytes.append(reinterpret_cast<const char*>(items.data()), items.size() * sizeof(T));
}

std::string Content::Bytes() const {
  std::string bytes = {static_cast<char>('0' + mode)};
  bytes += std::to_string(positions.size()) + '/' + std::to_string(normals.size()) + '/';
  AppendBytes(bytes, positions);
  AppendBytes(bytes, normals);
  AppendBytes(bytes, indices);
  return bytes;
}

Content ContentOf(const Facets& facets, const Vec3& centre) {
  Content content;
  for (const Vec3& p : facets.points) content.AddPosition(p - centre);
  for (const auto& stroke : facets.strokes) {
    content.mode = TINYGLTF_MODE_LINE;
    const auto first = static_cast<std::uint32_t>(content.positions.size() / 3);
    const bool closed = stroke.size() > 2 && stroke.front() == stroke.back();
    const std::size_t count = stroke.size() - (closed ? 1 : 0);
    for (std::size_t i = 0; i < count; ++i) content.AddPosition(stroke[i] - centre);
    for (std::uint32_t i = 0; i + 1 < stroke.size(); ++i) {
      content.indices.push_back(first + i);
      content.indices.push_back(first + (i + 1 < count ? i + 1 : 0));
    }
  }
  if (!facets.mesh.triangles.empty()) {
    content.mode = TINYGLTF_MODE_TRIANGLES;
    for (const Vec3& p : facets.mesh.positions) content.AddPosition(p - centre);
    for (const Vec3& n : facets.mesh.normals) {
      for (int i = 0; i < 3; ++i) content.normals.push_back(static_cast<float>(n[i]) + 0.0f);
    }
    for (const auto& t : facets.mesh.triangles) {
      content.indices.insert(content.indices.end(), t.begin(), t.end());
    }
  }
  return content;
}

// Builds the file's tables, each thing once: accessors by content, materials by look, meshes by
// both.
class GlbBuilder {
 public:
  GlbBuilder(const model::Model& model, const GltfOptions& options)
      : model_(model), options_(options), pasting_(model) {}

  Result<std::string> Build();

 private:
  int AddNode(tinygltf::Node node);
  // The node of an element and of all below it, -1 where nothing of it is visible. `origin` is
  // where the parent node's origin lies in the element's frame, `world` where that frame lies.
  int AddElement(const Element& element, const Vec3& origin, const Affine& world,
                 const Attributes& attributes, bool shared);
  int AddLeaf(const Element& leaf, const Vec3& origin, const Affine& world,
              const Attributes& attributes, bool shared);
  // The mesh of a leaf some of whose faces bear orthophotos; -1 where none does.
  int PastedMesh(const Element& leaf, const Vec3& centre, const Affine& world,
                 const Attributes& attributes);
  int AddOrthophoto(const Element& element, std::size_t index, const Vec3& origin);
  // The photograph as a plane at its frame; -1 where its pixels are not at hand.
  int AddPhotographPlane(const Element& element, const model::Photograph& photograph,
                         const Vec3& origin);
  double PlaneDepth_m(const model::Photograph& photograph) const;
  int AddPictureMaterial(const Picture& picture, const std::string& name);
  void AddPlaces(const std::vector<Vec2>& places, tinygltf::Primitive* primitive);
  tinygltf::Primitive PrimitiveOf(const geom::Mesh& mesh, const Vec3& centre);
  tinygltf::Primitive PrimitiveOf(const BearingMesh& bearing, const Vec3& centre,
                                  const model::Rgb& beneath);
  // The material that shows the orthophoto, with what is not seen of it in a colour.
  int PictureMaterial(std::size_t orthophoto, const model::Rgb& beneath);
  int AddPicture(const Picture& picture, const std::string& name);
  int AddGroup(const Element& element, const model::Group& group, const Vec3& origin,
               const Affine& world, const Attributes& attributes, bool shared);
  int AddCamera(const Element& element, const model::Photograph& photograph, const Vec3& origin);
  int AddInstance(const Element& element, const model::Instance& instance, const Vec3& origin,
                  const Affine& world, const Attributes& attributes);
  std::vector<int> AddMembers(const std::vector<model::ElementPtr>& members, const Vec3& origin,
                              const Affine& world, const Attributes& attributes, bool shared);
  tinygltf::Node NodeOf(const Element& element, const Attributes& attributes) const;

  struct PlacedGeometry {
    int geometry = -1;  // -1: nothing to draw
    Vec3 centre = Vec3::Zero();
  };
  PlacedGeometry GeometryOf(const Element& leaf, bool shared);
  int AddGeometry(const Content& content);
  int AddPositions(const std::vector<float>& positions);
  int AddVectors(const std::vector<float>& vectors);
  int AddIndices(const std::vector<std::uint32_t>& indices, std::size_t vertex_count);
  int MeshOf(int geometry, int material);
  int MaterialOf(const Attributes& attributes, bool surface);
  void AddBuffer();

  const model::Model& model_;
  const GltfOptions& options_;
  const Pasting pasting_;
  std::vector<std::optional<RectifiedFacade>> rectified_;  // by orthophoto, once asked for
  std::vector<bool> is_borne_;                             // by orthophoto
  std::map<std::pair<std::size_t, std::uint32_t>, int> picture_materials_;
  std::vector<float> places_;          // third buffer view: places on pictures
  std::vector<std::string> pictures_;  // files in further views, one each
  tinygltf::Model file_;
  std::vector<float> vectors_;  // first buffer view: all positions and normals
  std::string indices_;         // second buffer view
  std::vector<Geometry> geometries_;
  std::unordered_map<std::string, int> geometry_by_content_;
  std::unordered_map<const Element*, PlacedGeometry> geometry_of_part_;  // of prototypes' parts
  std::map<std::pair<int, int>, int> mesh_by_geometry_and_material_;
  std::map<std::tuple<std::uint32_t, std::string, bool>, int> materials_;
  std::optional<Error> error_;
};

constexpr int kVectorView = 0, kIndexView = 1, kPlaceView = 2, kFirstPictureView = 3;

int GlbBuilder::AddNode(tinygltf::Node node) {
  file_.nodes.push_back(std::move(node));
  return static_cast<int>(file_.nodes.size()) - 1;
}

std::vector<double> ListOf(const Vec3& v) { return {v.x() + 0.0, v.y() + 0.0, v.z() + 0.0}; }

void Translate(tinygltf::Node& node, const Vec3& offset) {
  if (offset != Vec3::Zero()) node.translation = ListOf(offset);
}

tinygltf::Node GlbBuilder::NodeOf(const Element& element, const Attributes& attributes) const {
  using tinygltf::Value;
  Value::Object extras;
  const auto put = [&](const char* key, std::string text) {
    extras.emplace(key, Value(std::move(text)));
  };
  std::string type = model::TypeOf(element);
  tinygltf::Node node;
  node.name = element.name ? *element.name : type;
  if (element.name) put("name", *element.name);
  put("type", std::move(type));
  put("level", attributes.level);
  put("evidence", std::string(model::WordOf(attributes.evidence)));
  if (!attributes.source.empty()) put("source", attributes.source);
  if (!attributes.material.empty()) put("material", attributes.material);
  put("hash", model::Hex(element.hash));
  node.extras = Value(std::move(extras));
  return node;
}

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
  if (!pasting_.elements().empty()) {
    const geom::Box box = model::BoundingBox(leaf);
    const Vec3 centre = box.empty() ? Vec3(Vec3::Zero()) : box.centre();
    const int pasted = PastedMesh(leaf, centre, world, attributes);
    if (error_) return -1;
    if (pasted >= 0) {
      tinygltf::Node node = NodeOf(leaf, attributes);
      Translate(node, centre - origin);
      node.mesh = pasted;
      return AddNode(std::move(node));
    }
  }
  const PlacedGeometry placed = GeometryOf(leaf, shared);
  if (error_) return -1;
  tinygltf::Node node = NodeOf(leaf, attributes);
  Translate(node, placed.centre - origin);
  if (placed.geometry >= 0) {
    const bool surface = geometries_[placed.geometry].mode == TINYGLTF_MODE_TRIANGLES;
    node.mesh = MeshOf(placed.geometry, MaterialOf(attributes, surface));
  }
  return AddNode(std::move(node));
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
  return AddNode(std::move(node));
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
    children = {AddNode(std::move(inner))};
  }
  tinygltf::Node node = NodeOf(element, attributes);
  Translate(node, placement.translation() - origin);
  Rotate(node, factors.rotation);
  if (factors.scale != Vec3::Ones()) node.scale = ListOf(factors.scale);
  node.children = std::move(children);
  return AddNode(std::move(node));
}

// A camera as glTF can hold it, with a centred principal point and no skew; what the photograph's
// own is stands in the extras: its parameters in millimetres and radians, and the exact matrix
// from the model to dots.
int GlbBuilder::AddCamera(const Element& element, const model::Photograph& photograph,
                          const Vec3& origin) {
  if (!HasCamera(photograph)) return -1;
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
  lens.perspective.znear = options_.photographs ? 1.01 * PlaneDepth_m(photograph) : 0.01;
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
  node.camera = static_cast<int>(file_.cameras.size());
  file_.cameras.push_back(std::move(lens));
  Translate(node, camera.position_m() - origin);
  // glTF's cameras look along −z, with y up.
  const Eigen::Matrix3d world_from_camera =
      camera::CameraFromWorld(camera.parameters).transpose() * Vec3(1, -1, -1).asDiagonal();
  Rotate(node, world_from_camera);
  return AddNode(std::move(node));
}

GlbBuilder::PlacedGeometry GlbBuilder::GeometryOf(const Element& leaf, bool shared) {
  if (const auto* point = std::get_if<model::Point>(&leaf.geometry)) {
    Content origin;
    origin.AddPosition(Vec3::Zero());
    return {AddGeometry(origin), point->position};
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
  if (!content.positions.empty()) placed.geometry = AddGeometry(content);
  if (shared) geometry_of_part_.emplace(&leaf, placed);
  return placed;
}

int GlbBuilder::AddGeometry(const Content& content) {
  const auto [known, is_new] =
      geometry_by_content_.try_emplace(content.Bytes(), static_cast<int>(geometries_.size()));
  if (is_new) {
    Geometry geometry;
    geometry.mode = content.mode;
    geometry.positions = AddPositions(content.positions);
    if (!content.normals.empty()) geometry.normals = AddVectors(content.normals);
    if (!content.indices.empty()) {
      geometry.indices = AddIndices(content.indices, content.positions.size() / 3);
    }
    geometries_.push_back(geometry);
  }
  return known->second;
}

int GlbBuilder::AddVectors(const std::vector<float>& vectors) {
  tinygltf::Accessor accessor;
  accessor.bufferView = kVectorView;
  accessor.byteOffset = vectors_.size() * sizeof(float);
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
  accessor.count = vectors.size() / 3;
  accessor.type = TINYGLTF_TYPE_VEC3;
  vectors_.insert(vectors_.end(), vectors.begin(), vectors.end());
  file_.accessors.push_back(std::move(accessor));
  return static_cast<int>(file_.accessors.size()) - 1;
}

int GlbBuilder::AddPositions(const std::vector<float>& positions) {
  const int index = AddVectors(positions);
  tinygltf::Accessor& accessor = file_.accessors.back();
  accessor.minValues.assign(positions.begin(), positions.begin() + 3);
  accessor.maxValues = accessor.minValues;
  for (std::size_t i = 3; i < positions.size(); ++i) {
    const double value = positions[i];
    accessor.minValues[i % 3] = std::min(accessor.minValues[i % 3], value);
    accessor.maxValues[i % 3] = std::max(accessor.maxValues[i % 3], value);
  }
  return index;
}

int GlbBuilder::AddIndices(const std::vector<std::uint32_t>& indices, std::size_t vertex_count) {
  tinygltf::Accessor accessor;
  accessor.bufferView = kIndexView;
  accessor.byteOffset = indices_.size();
  accessor.count = indices.size();
  accessor.type = TINYGLTF_TYPE_SCALAR;
  if (vertex_count < 0xffff) {
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    AppendBytes(indices_, std::vector<std::uint16_t>(indices.begin(), indices.end()));
    indices_.resize((indices_.size() + 3) / 4 * 4, '\0');
  } else {
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    AppendBytes(indices_, indices);
  }
  file_.accessors.push_back(std::move(accessor));
  return static_cast<int>(file_.accessors.size()) - 1;
}

int GlbBuilder::MeshOf(int geometry, int material) {
  const auto [known, is_new] = mesh_by_geometry_and_material_.try_emplace(
      {geometry, material}, static_cast<int>(file_.meshes.size()));
  if (is_new) {
    const Geometry& accessors = geometries_[geometry];
    tinygltf::Primitive primitive;
    primitive.mode = accessors.mode;
    primitive.material = material;
    primitive.indices = accessors.indices;
    primitive.attributes["POSITION"] = accessors.positions;
    if (accessors.normals >= 0) primitive.attributes["NORMAL"] = accessors.normals;
    file_.meshes.emplace_back().primitives.push_back(std::move(primitive));
  }
  return known->second;
}

int GlbBuilder::MaterialOf(const Attributes& attributes, bool surface) {
  const auto [known, is_new] =
      materials_.try_emplace({attributes.colour.code, attributes.material, surface},
                             static_cast<int>(file_.materials.size()));
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
    file_.materials.push_back(std::move(material));
  }
  return known->second;
}

int GlbBuilder::PastedMesh(const Element& leaf, const Vec3& centre, const Affine& world,
                           const Attributes& attributes) {
  const Result<Facets> facets = FacetsOf(leaf, leaf.tolerance);
  if (!facets) {
    error_ = facets.error();
    return -1;
  }
  const auto split = pasting_.Split(facets->mesh, world);
  if (!split) return -1;
  std::vector<tinygltf::Primitive> primitives;
  if (!split->plain.triangles.empty()) {
    primitives.push_back(PrimitiveOf(split->plain, centre));
    primitives.back().material = MaterialOf(attributes, true);
  }
  const model::Rgb beneath = SurfaceColour(attributes.colour, attributes.material);
  for (const BearingMesh& bearing : split->bearing) {
    primitives.push_back(PrimitiveOf(bearing, centre, beneath));
    if (error_) return -1;
    is_borne_[bearing.orthophoto] = true;
  }
  file_.meshes.emplace_back().primitives = std::move(primitives);
  return static_cast<int>(file_.meshes.size()) - 1;
}

// An orthophoto that no face bears stands by itself.
int GlbBuilder::AddOrthophoto(const Element& element, std::size_t index, const Vec3& origin) {
  const model::Orthophoto& orthophoto = pasting_.At(index);
  const Vec2 size = orthophoto.size_m();
  BearingMesh bearing{index, {}, {{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
  for (const Vec3& corner :
       {Vec3(0, 0, 0), Vec3(size.x(), 0, 0), Vec3(size.x(), size.y(), 0), Vec3(0, size.y(), 0)}) {
    bearing.mesh.positions.push_back(orthophoto.plane.ToWorld(corner));
    bearing.mesh.normals.push_back(orthophoto.plane.z());
  }
  bearing.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Vec3 centre = orthophoto.plane.ToWorld({size.x() / 2, size.y() / 2, 0});
  const model::Rgb beneath = SurfaceColour(element.attributes->colour, "");
  const tinygltf::Primitive primitive = PrimitiveOf(bearing, centre, beneath);
  if (error_) return -1;
  tinygltf::Node node = NodeOf(element, *element.attributes);
  Translate(node, centre - origin);
  node.mesh = static_cast<int>(file_.meshes.size());
  file_.meshes.emplace_back().primitives = {primitive};
  return AddNode(std::move(node));
}

tinygltf::Primitive GlbBuilder::PrimitiveOf(const geom::Mesh& mesh, const Vec3& centre) {
  Facets facets;
  facets.mesh = mesh;
  const Content content = ContentOf(facets, centre);
  tinygltf::Primitive primitive;
  primitive.mode = content.mode;
  primitive.attributes["POSITION"] = AddPositions(content.positions);
  primitive.attributes["NORMAL"] = AddVectors(content.normals);
  primitive.indices = AddIndices(content.indices, mesh.positions.size());
  return primitive;
}

tinygltf::Primitive GlbBuilder::PrimitiveOf(const BearingMesh& bearing, const Vec3& centre,
                                            const model::Rgb& beneath) {
  tinygltf::Primitive primitive = PrimitiveOf(bearing.mesh, centre);
  AddPlaces(bearing.places, &primitive);
  primitive.material = PictureMaterial(bearing.orthophoto, beneath);
  return primitive;
}

void GlbBuilder::AddPlaces(const std::vector<Vec2>& places, tinygltf::Primitive* primitive) {
  tinygltf::Accessor accessor;
  accessor.bufferView = kPlaceView;
  accessor.byteOffset = places_.size() * sizeof(float);
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
  accessor.count = places.size();
  accessor.type = TINYGLTF_TYPE_VEC2;
  for (const Vec2& place : places) {
    places_.push_back(static_cast<float>(place.x()));
    places_.push_back(static_cast<float>(place.y()));
  }
  primitive->attributes["TEXCOORD_0"] = static_cast<int>(file_.accessors.size());
  file_.accessors.push_back(std::move(accessor));
}

double GlbBuilder::PlaneDepth_m(const model::Photograph& photograph) const {
  geom::Box built;
  model_.ForEach([&](const model::ElementPtr& element) {
    if (model::IsBuilt(*element)) built.Add(model::BoundingBox(*element));
  });
  return FrameDepth_m(photograph, built);
}

int GlbBuilder::AddPhotographPlane(const Element& element, const model::Photograph& photograph,
                                   const Vec3& origin) {
  if (!photograph.picture) return -1;
  const auto pixels = photograph.picture->Pixels();
  if (!pixels) return -1;
  const auto corners = FrameCorners(photograph, PlaneDepth_m(photograph));
  const Vec3 centre = 0.5 * (corners[0] + corners[2]);
  geom::Mesh mesh;
  mesh.positions.assign(corners.begin(), corners.end());
  mesh.normals.assign(4, (corners[1] - corners[0]).cross(corners[3] - corners[0]).normalized());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  tinygltf::Primitive primitive = PrimitiveOf(mesh, centre);
  AddPlaces({{0, 1}, {1, 1}, {1, 0}, {0, 0}}, &primitive);
  tinygltf::Node node = NodeOf(element, *element.attributes);
  node.name += " at its frame";
  primitive.material =
      AddPictureMaterial({(*pixels)->width_px, (*pixels)->height_px, (*pixels)->rgb}, node.name);
  if (error_) return -1;
  Translate(node, centre - origin);
  node.mesh = static_cast<int>(file_.meshes.size());
  file_.meshes.emplace_back().primitives = {std::move(primitive)};
  return AddNode(std::move(node));
}

int GlbBuilder::PictureMaterial(std::size_t orthophoto, const model::Rgb& beneath) {
  const std::uint32_t code =
      (std::uint32_t{beneath.r} << 16) | (std::uint32_t{beneath.g} << 8) | beneath.b;
  const auto [known, is_new] =
      picture_materials_.try_emplace({orthophoto, code}, static_cast<int>(file_.materials.size()));
  if (!is_new) return known->second;
  std::optional<RectifiedFacade>& rectified = rectified_[orthophoto];
  if (!rectified) {
    Result<RectifiedFacade> made = Rectify(pasting_.At(orthophoto), options_.threads);
    if (!made) {
      error_ = made.error();
      return -1;
    }
    rectified = *std::move(made);
  }
  return AddPictureMaterial(OverColour(rectified->picture, beneath),
                            "orthophoto of " + pasting_.At(orthophoto).facade);
}

int GlbBuilder::AddPictureMaterial(const Picture& picture, const std::string& name) {
  tinygltf::Material material;
  material.name = name;
  material.doubleSided = true;
  material.pbrMetallicRoughness.baseColorTexture.index = AddPicture(picture, name);
  material.pbrMetallicRoughness.metallicFactor = 0;
  material.pbrMetallicRoughness.roughnessFactor = 1;
  // A photograph has its own light: a viewer that can shows it as it is.
  material.extensions["KHR_materials_unlit"] = tinygltf::Value(tinygltf::Value::Object());
  if (file_.extensionsUsed.empty()) file_.extensionsUsed.emplace_back("KHR_materials_unlit");
  file_.materials.push_back(std::move(material));
  return static_cast<int>(file_.materials.size()) - 1;
}

// The index of its texture.
int GlbBuilder::AddPicture(const Picture& picture, const std::string& name) {
  Result<std::string> bytes = PngOf(picture);
  if (!bytes) {
    error_ = bytes.error();
    return -1;
  }
  tinygltf::Image image;
  image.name = name;
  image.mimeType = "image/png";
  image.bufferView = kFirstPictureView + static_cast<int>(pictures_.size());
  pictures_.push_back(*std::move(bytes));
  if (file_.samplers.empty()) {
    tinygltf::Sampler& sampler = file_.samplers.emplace_back();
    sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
    sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
    sampler.wrapS = sampler.wrapT = TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
  }
  tinygltf::Texture texture;
  texture.source = static_cast<int>(file_.images.size());
  texture.sampler = 0;
  file_.images.push_back(std::move(image));
  file_.textures.push_back(std::move(texture));
  return static_cast<int>(file_.textures.size()) - 1;
}

void GlbBuilder::AddBuffer() {
  if (vectors_.empty()) return;
  std::vector<unsigned char>& bytes = file_.buffers.emplace_back().data;
  const auto add_view = [&](const void* data, std::size_t size, std::size_t stride, int target) {
    tinygltf::BufferView& view = file_.bufferViews.emplace_back();
    view.buffer = 0;
    view.byteOffset = bytes.size();
    view.byteLength = size;
    view.byteStride = stride;
    view.target = target;
    bytes.resize((bytes.size() + size + 3) / 4 * 4);
    std::memcpy(bytes.data() + view.byteOffset, data, size);
  };
  add_view(vectors_.data(), vectors_.size() * sizeof(float), 3 * sizeof(float),
           TINYGLTF_TARGET_ARRAY_BUFFER);
  if (indices_.empty()) return;
  add_view(indices_.data(), indices_.size(), 0, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  if (places_.empty()) return;
  add_view(places_.data(), places_.size() * sizeof(float), 2 * sizeof(float),
           TINYGLTF_TARGET_ARRAY_BUFFER);
  for (const std::string& picture : pictures_) add_view(picture.data(), picture.size(), 0, 0);
}

Result<std::string> GlbBuilder::Build() {
  file_.asset.version = "2.0";
  file_.asset.generator = "Tranos";
  tinygltf::Node root;
  root.name = "Z up, in metres";
  root.rotation = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
  AddNode(std::move(root));
  rectified_.resize(pasting_.elements().size());
  is_borne_.resize(pasting_.elements().size());
  file_.nodes.reserve(model_.live + 1);
  std::vector<int> children;
  model_.ForEach([&](const model::ElementPtr& element) {
    if (error_) return;
    const int node =
        AddElement(*element, Vec3::Zero(), Affine::Identity(), *element->attributes, false);
    if (node < 0) return;
    children.push_back(node);
    const auto* photograph = std::get_if<model::PhotographPtr>(&element->geometry);
    if (!photograph || !options_.photographs) return;
    const int plane = AddPhotographPlane(*element, **photograph, Vec3::Zero());
    if (plane >= 0) children.push_back(plane);
  });
  if (error_) return tl::unexpected(*error_);
  for (std::size_t i = 0; i < is_borne_.size() && !error_; ++i) {
    if (is_borne_[i]) continue;
    const int node = AddOrthophoto(*pasting_.elements()[i], i, Vec3::Zero());
    if (node >= 0) children.push_back(node);
  }
  if (error_) return tl::unexpected(*error_);
  file_.nodes[0].children = std::move(children);
  file_.defaultScene = 0;
  file_.scenes.emplace_back().nodes = {0};
  AddBuffer();
  const std::uint64_t content_bytes =
      (vectors_.size() + places_.size()) * sizeof(float) + indices_.size();
  std::ostringstream stream;
  try {
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&file_, stream, false, true);
  } catch (const std::exception& cause) {  // text that is not UTF-8
    return tl::unexpected(Error{std::string("the glTF text cannot be written: ") + cause.what()});
  }
  std::string glb = std::move(stream).str();
  if (glb.size() > options_.max_bytes || content_bytes > options_.max_bytes) {
    return tl::unexpected(Error{"the glTF file would have " + std::to_string(glb.size()) +
                                " bytes, and it can have " + std::to_string(options_.max_bytes)});
  }
  return glb;
}

}  // namespace

Result<std::string> GlbOf(const model::Model& model, const GltfOptions& options) {
  return GlbBuilder(model, options).Build();
}

}  // namespace tranos::output
