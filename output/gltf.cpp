// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/gltf.h"

#include <tiny_gltf.h>

#include <Eigen/SVD>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "output/facets.h"
#include "output/material.h"

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

double LinearFromSrgb(std::uint8_t value) {
  const double s = value / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

// Builds the file's tables, each thing once: accessors by content, materials by look, meshes by
// both.
class GlbBuilder {
 public:
  explicit GlbBuilder(const model::Model& model) : model_(model) {}

  Result<std::string> Build(const GltfOptions& options);

 private:
  int AddNode(tinygltf::Node node);
  // The node of an element and of all below it, -1 where nothing of it is visible. `origin` is
  // where the parent node's origin lies in the element's frame.
  int AddElement(const Element& element, const Vec3& origin, const Attributes& attributes,
                 bool shared);
  int AddLeaf(const Element& leaf, const Vec3& origin, const Attributes& attributes, bool shared);
  int AddGroup(const Element& element, const model::Group& group, const Vec3& origin,
               const Attributes& attributes, bool shared);
  int AddCamera(const Element& element, const model::Photograph& photograph, const Vec3& origin);
  int AddInstance(const Element& element, const model::Instance& instance, const Vec3& origin,
                  const Attributes& attributes);
  std::vector<int> AddMembers(const std::vector<model::ElementPtr>& members, const Vec3& origin,
                              const Attributes& attributes, bool shared);
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

constexpr int kVectorView = 0, kIndexView = 1;

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

int GlbBuilder::AddElement(const Element& element, const Vec3& origin, const Attributes& attributes,
                           bool shared) {
  if (const auto* group = std::get_if<model::GroupPtr>(&element.geometry)) {
    return AddGroup(element, **group, origin, attributes, shared);
  }
  if (const auto* instance = std::get_if<model::InstancePtr>(&element.geometry)) {
    return AddInstance(element, **instance, origin, attributes);
  }
  if (const auto* photograph = std::get_if<model::PhotographPtr>(&element.geometry)) {
    return AddCamera(element, **photograph, origin);
  }
  if (!model::IsBuilt(element)) return -1;
  return AddLeaf(element, origin, attributes, shared);
}

int GlbBuilder::AddLeaf(const Element& leaf, const Vec3& origin, const Attributes& attributes,
                        bool shared) {
  if (!model_.LevelIsOn(attributes.level)) return -1;
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
                                        const Vec3& origin, const Attributes& attributes,
                                        bool shared) {
  std::vector<int> nodes;
  for (const model::ElementPtr& member : members) {
    const int node =
        AddElement(*member, origin, model::Inherit(*member->attributes, attributes), shared);
    if (node >= 0) nodes.push_back(node);
  }
  return nodes;
}

int GlbBuilder::AddGroup(const Element& element, const model::Group& group, const Vec3& origin,
                         const Attributes& attributes, bool shared) {
  const geom::Box box = model::BoundingBox(element);
  const Vec3 centre = box.empty() ? origin : box.centre();
  std::vector<int> children = AddMembers(group.members, centre, attributes, shared);
  if (children.empty()) return -1;
  tinygltf::Node node = NodeOf(element, attributes);
  Translate(node, centre - origin);
  node.children = std::move(children);
  return AddNode(std::move(node));
}

// rotation · scale · before = the linear part, each of rotation and before a rotation.
struct Factors {
  Eigen::Matrix3d rotation, before;
  Vec3 scale;
};
Factors FactorsOf(const Eigen::Matrix3d& linear) {
  Factors factors;
  const Eigen::Matrix3d gram = linear.transpose() * linear;
  const double off_diagonal = std::abs(gram(0, 1)) + std::abs(gram(0, 2)) + std::abs(gram(1, 2));
  if (off_diagonal <= 1e-12 * gram.trace()) {
    factors.scale = linear.colwise().norm().transpose();
    factors.rotation = linear * factors.scale.cwiseInverse().asDiagonal();
    factors.before.setIdentity();
  } else {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
    factors.rotation = svd.matrixU();
    factors.scale = svd.singularValues();
    factors.before = svd.matrixV().transpose();
  }
  if (factors.rotation.determinant() < 0) {
    factors.rotation.col(0) *= -1;
    factors.scale.x() *= -1;
  }
  if (factors.before.determinant() < 0) {
    factors.before.row(0) *= -1;
    factors.scale.x() *= -1;
  }
  return factors;
}

void Rotate(tinygltf::Node& node, const Eigen::Matrix3d& rotation) {
  if (rotation.isIdentity(0)) return;
  const Eigen::Quaterniond q = Eigen::Quaterniond(rotation).normalized();
  node.rotation = {q.x() + 0.0, q.y() + 0.0, q.z() + 0.0, q.w() + 0.0};
}

// glTF cannot hold a shear in one node; two, one inside the other, can (a singular value
// decomposition), and the geometry stays shared.
int GlbBuilder::AddInstance(const Element& element, const model::Instance& instance,
                            const Vec3& origin, const Attributes& attributes) {
  const Affine& placement = instance.world_from_prototype;
  std::vector<int> children = AddMembers(instance.prototype->parts, Vec3::Zero(), attributes, true);
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
  if (!photograph.estimate || !photograph.estimate->determined()) return -1;
  using tinygltf::Value;
  const camera::Camera& camera = photograph.estimate->camera;
  const Vec2 size_mm = photograph.frame.size_mm;
  const double fx = camera[camera::kFocal], fy = fx * camera[camera::kAspect];
  tinygltf::Camera lens;
  lens.type = "perspective";
  lens.name = element.name ? *element.name : "camera";
  lens.perspective.yfov = 2 * std::atan2(size_mm.y() / 2, fy);
  lens.perspective.aspectRatio = (size_mm.x() / fx) / (size_mm.y() / fy);
  lens.perspective.znear = 0.01;
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

void GlbBuilder::AddBuffer() {
  if (vectors_.empty()) return;
  std::vector<unsigned char>& bytes = file_.buffers.emplace_back().data;
  const std::size_t vector_bytes = vectors_.size() * sizeof(float);
  bytes.resize(vector_bytes + indices_.size());
  std::memcpy(bytes.data(), vectors_.data(), vector_bytes);
  tinygltf::BufferView& vectors = file_.bufferViews.emplace_back();
  vectors.buffer = 0;
  vectors.byteLength = vector_bytes;
  vectors.byteStride = 3 * sizeof(float);
  vectors.target = TINYGLTF_TARGET_ARRAY_BUFFER;
  if (indices_.empty()) return;
  std::memcpy(bytes.data() + vector_bytes, indices_.data(), indices_.size());
  tinygltf::BufferView& indices = file_.bufferViews.emplace_back();
  indices.buffer = 0;
  indices.byteOffset = vector_bytes;
  indices.byteLength = indices_.size();
  indices.target = TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER;
}

Result<std::string> GlbBuilder::Build(const GltfOptions& options) {
  file_.asset.version = "2.0";
  file_.asset.generator = "Tranos";
  tinygltf::Node root;
  root.name = "Z up, in metres";
  root.rotation = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
  AddNode(std::move(root));
  file_.nodes.reserve(model_.live + 1);
  std::vector<int> children;
  model_.ForEach([&](const model::ElementPtr& element) {
    if (error_) return;
    const int node = AddElement(*element, Vec3::Zero(), *element->attributes, false);
    if (node >= 0) children.push_back(node);
  });
  if (error_) return tl::unexpected(*error_);
  file_.nodes[0].children = std::move(children);
  file_.defaultScene = 0;
  file_.scenes.emplace_back().nodes = {0};
  AddBuffer();
  const std::uint64_t content_bytes = vectors_.size() * sizeof(float) + indices_.size();
  std::ostringstream stream;
  try {
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&file_, stream, false, true);
  } catch (const std::exception& cause) {  // text that is not UTF-8
    return tl::unexpected(Error{std::string("the glTF text cannot be written: ") + cause.what()});
  }
  std::string glb = std::move(stream).str();
  if (glb.size() > options.max_bytes || content_bytes > options.max_bytes) {
    return tl::unexpected(Error{"the glTF file would have " + std::to_string(glb.size()) +
                                " bytes, and it can have " + std::to_string(options.max_bytes)});
  }
  return glb;
}

}  // namespace

Result<std::string> GlbOf(const model::Model& model, const GltfOptions& options) {
  return GlbBuilder(model).Build(options);
}

}  // namespace tranos::output
