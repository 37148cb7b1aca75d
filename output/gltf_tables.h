// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of a glTF file: nodes, accessors and the buffer below them, pictures.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "model/element.h"
#include "output/facets.h"

namespace tranos::output {

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

  void AddPosition(const geom::Vec3& p) {
    for (int i = 0; i < 3; ++i) positions.push_back(static_cast<float>(p[i]) + 0.0f);
  }
};
// About the centre.
Content ContentOf(const Facets& facets, const geom::Vec3& centre);

// With the element's name, and in the extras what it is.
tinygltf::Node NodeOf(const model::Element& element, const model::Attributes& attributes);
std::vector<double> ListOf(const geom::Vec3& v);
void Translate(tinygltf::Node& node, const geom::Vec3& offset);

class GlbTables {
 public:
  tinygltf::Model file;

  int AddNode(tinygltf::Node node);
  // A mesh of its own with these.
  int AddMesh(std::vector<tinygltf::Primitive> primitives);
  // The index among geometries; equal content is in the buffer once.
  int AddGeometry(const Content& content);
  const Geometry& geometry(int index) const { return geometries_[static_cast<std::size_t>(index)]; }
  // Without a material.
  tinygltf::Primitive PrimitiveOf(const geom::Mesh& mesh, const geom::Vec3& centre);
  // The places on a picture of its vertices: (0, 0) the upper left corner, (1, 1) the lower right.
  void AddPlaces(const std::vector<geom::Vec2>& places, tinygltf::Primitive* primitive);
  // A material that shows a picture as it is; the picture's bytes, a png, may follow.
  int AddPictureMaterial(const std::string& name);
  void SetPicture(int picture_material, std::string png);

  // The file; an error if it is larger, or holds text that is not UTF-8.
  Result<std::string> Bytes(std::uint64_t max_bytes);

 private:
  int AddPositions(const std::vector<float>& positions);
  int AddVectors(const std::vector<float>& vectors);
  int AddIndices(const std::vector<std::uint32_t>& indices, std::size_t vertex_count);
  void AddBuffer();

  std::vector<float> vectors_;         // first buffer view: all positions and normals
  std::string indices_;                // second buffer view
  std::vector<float> places_;          // third buffer view: places on pictures
  std::vector<std::string> pictures_;  // files in further views, one each
  std::vector<Geometry> geometries_;
  std::unordered_map<std::string, int> geometry_by_content_;
  std::unordered_map<int, std::size_t> picture_of_material_;
};

}  // namespace tranos::output
