// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/stl.h"

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>

#include "model/element_leaves.h"
#include "output/facets.h"

namespace tranos::output {
namespace {

using geom::Affine;
using geom::Vec3;
using Corner = std::array<float, 3>;

constexpr std::size_t kHeaderBytes = 80;

class StlBuilder {
 public:
  explicit StlBuilder(const model::Model& model) : model_(model) {}

  Result<std::string> Build();

 private:
  void AddLeaf(const model::Element& leaf, const Affine& world_from_leaf);
  const geom::Mesh* MeshOf(const model::Element& leaf);
  void AddTriangle(const Corner& a, const Corner& b, const Corner& c);
  void AddNumber(std::uint32_t number);
  void AddVector(const Corner& v);

  const model::Model& model_;
  std::string bytes_;
  std::uint32_t count_ = 0;
  std::unordered_map<const model::Element*, geom::Mesh> mesh_of_leaf_;
  std::optional<Error> error_;
};

// Little-endian on any machine.
void StlBuilder::AddNumber(std::uint32_t number) {
  for (int shift = 0; shift < 32; shift += 8) bytes_ += static_cast<char>(number >> shift & 0xff);
}

void StlBuilder::AddVector(const Corner& v) {
  for (const float coordinate : v) AddNumber(std::bit_cast<std::uint32_t>(coordinate));
}

Corner Rounded(const Vec3& p) {
  return {static_cast<float>(p.x()) + 0.0f, static_cast<float>(p.y()) + 0.0f,
          static_cast<float>(p.z()) + 0.0f};
}

Vec3 PointOf(const Corner& c) { return {c[0], c[1], c[2]}; }

// Corners that single precision makes one close the triangle up: its neighbours then meet there.
void StlBuilder::AddTriangle(const Corner& a, const Corner& b, const Corner& c) {
  if (a == b || b == c || c == a) return;
  const Vec3 n = (PointOf(b) - PointOf(a)).cross(PointOf(c) - PointOf(a));
  const double length = n.norm();
  AddVector(Rounded(length > 0 ? Vec3(n / length) : Vec3(Vec3::Zero())));
  AddVector(a);
  AddVector(b);
  AddVector(c);
  bytes_.append(2, '\0');
  ++count_;
}

// A part of a prototype is met once for each instance, its facets are made once.
const geom::Mesh* StlBuilder::MeshOf(const model::Element& leaf) {
  const auto known = mesh_of_leaf_.find(&leaf);
  if (known != mesh_of_leaf_.end()) return &known->second;
  Result<Facets> facets = FacetsOf(leaf, leaf.tolerance);
  if (!facets) {
    error_ = facets.error();
    return nullptr;
  }
  return &mesh_of_leaf_.emplace(&leaf, std::move(facets->mesh)).first->second;
}

void StlBuilder::AddLeaf(const model::Element& leaf, const Affine& world_from_leaf) {
  const geom::Mesh* mesh = MeshOf(leaf);
  if (!mesh) return;
  const bool mirrored = world_from_leaf.linear().determinant() < 0;
  std::vector<Corner> corners;
  corners.reserve(mesh->positions.size());
  for (const Vec3& p : mesh->positions) corners.push_back(Rounded(world_from_leaf * p));
  for (const auto& [a, b, c] : mesh->triangles) {
    AddTriangle(corners[a], corners[mirrored ? c : b], corners[mirrored ? b : c]);
  }
}

Result<std::string> StlBuilder::Build() {
  // Not "solid": by that word readers tell the format of text.
  bytes_ = "Tranos: binary STL, Z up, in metres";
  bytes_.resize(kHeaderBytes + 4, '\0');
  model_.ForEach([&](const model::ElementPtr& element) {
    model::ForEachLeaf(*element, [&](const model::Element& leaf, const Affine& world_from_leaf,
                                     const model::Attributes& attributes) {
      if (error_ || !model::IsBuilt(leaf) || !model_.LevelIsOn(attributes.level)) return;
      AddLeaf(leaf, world_from_leaf);
    });
  });
  if (error_) return tl::unexpected(*error_);
  std::string whole = std::move(bytes_);
  bytes_.clear();
  AddNumber(count_);
  return whole.replace(kHeaderBytes, 4, bytes_);
}

}  // namespace

Result<std::string> StlOf(const model::Model& model) { return StlBuilder(model).Build(); }

}  // namespace tranos::output
