// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/gltf_tables.h"

#include <cstring>
#include <sstream>
#include <utility>

namespace tranos::output {
namespace {

using geom::Vec2;
using geom::Vec3;

constexpr int kVectorView = 0, kIndexView = 1, kPlaceView = 2, kFirstPictureView = 3;

template <class T>
void AppendBytes(std::string& bytes, const std::vector<T>& items) {
  bytes.append(reinterpret_cast<const char*>(items.data()), items.size() * sizeof(T));
}

std::string BytesOf(const Content& content) {
  std::string bytes = {static_cast<char>('0' + content.mode)};
  bytes +=
      std::to_string(content.positions.size()) + '/' + std::to_string(content.normals.size()) + '/';
  AppendBytes(bytes, content.positions);
  AppendBytes(bytes, content.normals);
  AppendBytes(bytes, content.indices);
  return bytes;
}

}  // namespace

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

std::vector<double> ListOf(const Vec3& v) { return {v.x() + 0.0, v.y() + 0.0, v.z() + 0.0}; }

void Translate(tinygltf::Node& node, const Vec3& offset) {
  if (offset != Vec3::Zero()) node.translation = ListOf(offset);
}

tinygltf::Node NodeOf(const model::Element& element, const model::Attributes& attributes) {
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

int GlbTables::AddNode(tinygltf::Node node) {
  file.nodes.push_back(std::move(node));
  return static_cast<int>(file.nodes.size()) - 1;
}

int GlbTables::AddMesh(std::vector<tinygltf::Primitive> primitives) {
  file.meshes.emplace_back().primitives = std::move(primitives);
  return static_cast<int>(file.meshes.size()) - 1;
}

int GlbTables::AddGeometry(const Content& content) {
  const auto [known, is_new] =
      geometry_by_content_.try_emplace(BytesOf(content), static_cast<int>(geometries_.size()));
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

int GlbTables::AddVectors(const std::vector<float>& vectors) {
  tinygltf::Accessor accessor;
  accessor.bufferView = kVectorView;
  accessor.byteOffset = vectors_.size() * sizeof(float);
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
  accessor.count = vectors.size() / 3;
  accessor.type = TINYGLTF_TYPE_VEC3;
  vectors_.insert(vectors_.end(), vectors.begin(), vectors.end());
  file.accessors.push_back(std::move(accessor));
  return static_cast<int>(file.accessors.size()) - 1;
}

int GlbTables::AddPositions(const std::vector<float>& positions) {
  const int index = AddVectors(positions);
  tinygltf::Accessor& accessor = file.accessors.back();
  accessor.minValues.assign(positions.begin(), positions.begin() + 3);
  accessor.maxValues = accessor.minValues;
  for (std::size_t i = 3; i < positions.size(); ++i) {
    const double value = positions[i];
    accessor.minValues[i % 3] = std::min(accessor.minValues[i % 3], value);
    accessor.maxValues[i % 3] = std::max(accessor.maxValues[i % 3], value);
  }
  return index;
}

int GlbTables::AddIndices(const std::vector<std::uint32_t>& indices, std::size_t vertex_count) {
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
  file.accessors.push_back(std::move(accessor));
  return static_cast<int>(file.accessors.size()) - 1;
}

tinygltf::Primitive GlbTables::PrimitiveOf(const geom::Mesh& mesh, const Vec3& centre) {
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

void GlbTables::AddPlaces(const std::vector<Vec2>& places, tinygltf::Primitive* primitive) {
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
  primitive->attributes["TEXCOORD_0"] = static_cast<int>(file.accessors.size());
  file.accessors.push_back(std::move(accessor));
}

int GlbTables::AddPictureMaterial(const std::string& name) {
  tinygltf::Image image;
  image.name = name;
  image.mimeType = "image/png";
  image.bufferView = kFirstPictureView + static_cast<int>(pictures_.size());
  if (file.samplers.empty()) {
    tinygltf::Sampler& sampler = file.samplers.emplace_back();
    sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
    sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
    sampler.wrapS = sampler.wrapT = TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
  }
  tinygltf::Texture texture;
  texture.source = static_cast<int>(file.images.size());
  texture.sampler = 0;
  file.images.push_back(std::move(image));
  file.textures.push_back(std::move(texture));
  tinygltf::Material material;
  material.name = name;
  material.doubleSided = true;
  material.pbrMetallicRoughness.baseColorTexture.index = static_cast<int>(file.textures.size()) - 1;
  material.pbrMetallicRoughness.metallicFactor = 0;
  material.pbrMetallicRoughness.roughnessFactor = 1;
  // A photograph has its own light: a viewer that can shows it as it is.
  material.extensions["KHR_materials_unlit"] = tinygltf::Value(tinygltf::Value::Object());
  if (file.extensionsUsed.empty()) file.extensionsUsed.emplace_back("KHR_materials_unlit");
  const auto index = static_cast<int>(file.materials.size());
  file.materials.push_back(std::move(material));
  picture_of_material_[index] = pictures_.size();
  pictures_.emplace_back();
  return index;
}

void GlbTables::SetPicture(int picture_material, std::string png) {
  pictures_[picture_of_material_.at(picture_material)] = std::move(png);
}

void GlbTables::AddBuffer() {
  if (vectors_.empty()) return;
  std::vector<unsigned char>& bytes = file.buffers.emplace_back().data;
  const auto add_view = [&](const void* data, std::size_t size, std::size_t stride, int target) {
    tinygltf::BufferView& view = file.bufferViews.emplace_back();
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

Result<std::string> GlbTables::Bytes(std::uint64_t max_bytes) {
  AddBuffer();
  const std::uint64_t content_bytes =
      (vectors_.size() + places_.size()) * sizeof(float) + indices_.size();
  std::ostringstream stream;
  try {
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&file, stream, false, true);
  } catch (const std::exception& cause) {  // text that is not UTF-8
    return tl::unexpected(Error{std::string("the glTF text cannot be written: ") + cause.what()});
  }
  std::string glb = std::move(stream).str();
  if (glb.size() > max_bytes || content_bytes > max_bytes) {
    return tl::unexpected(Error{"the glTF file would have " + std::to_string(glb.size()) +
                                " bytes, and it can have " + std::to_string(max_bytes)});
  }
  return glb;
}

}  // namespace tranos::output
