// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/gltf_pictures.h"

#include <algorithm>

#include "output/material.h"
#include "output/orthophoto.h"
#include "output/parts.h"
#include "output/png.h"

namespace tranos::output {

using geom::Affine;
using geom::Vec2;
using geom::Vec3;
using model::Element;

namespace {

std::uint32_t CodeOf(const model::Rgb& colour) {
  return (std::uint32_t{colour.r} << 16) | (std::uint32_t{colour.g} << 8) | colour.b;
}
model::Rgb ColourOf(std::uint32_t code) {
  return {static_cast<std::uint8_t>(code >> 16), static_cast<std::uint8_t>(code >> 8),
          static_cast<std::uint8_t>(code)};
}

// The orthophoto's rectangle in the world.
geom::Mesh RectangleOf(const model::Orthophoto& orthophoto) {
  geom::Mesh mesh;
  for (const Vec3& corner : CornersOf(orthophoto)) mesh.positions.push_back(corner);
  mesh.normals.assign(4, orthophoto.plane.z());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

}  // namespace

std::optional<SplitMesh> GlbPictures::Split(const geom::Mesh& mesh, const Affine& world_from_mesh,
                                            bool has_outside) {
  auto split = pasting_.Split(mesh, world_from_mesh, has_outside);
  if (!split) return split;
  for (const std::size_t orthophoto : split->borne) is_borne_[orthophoto] = true;
  return split;
}

tinygltf::Primitive GlbPictures::PrimitiveOf(const BearingMesh& bearing, const Vec3& centre,
                                             const model::Rgb& beneath) {
  tinygltf::Primitive primitive = tables_.PrimitiveOf(bearing.mesh, centre);
  tables_.AddPlaces(bearing.places, &primitive);
  const auto [known, is_new] = materials_.try_emplace({bearing.orthophoto, CodeOf(beneath)});
  if (is_new) {
    const model::Orthophoto& orthophoto = pasting_.At(bearing.orthophoto);
    known->second = tables_.AddPictureMaterial("orthophoto of " + orthophoto.facade);
  }
  primitive.material = known->second;
  return primitive;
}

// Where later ones lie in the same place, those are seen.
std::vector<int> GlbPictures::AddUnborne() {
  std::vector<int> nodes;
  for (std::size_t i = 0; i < is_borne_.size(); ++i) {
    if (is_borne_[i]) continue;
    const Element& element = *pasting_.elements()[i];
    const geom::Mesh rectangle = RectangleOf(pasting_.At(i));
    const auto split = pasting_.Split(rectangle, Affine::Identity(), true);
    if (!split) continue;
    const auto own = std::find_if(split->bearing.begin(), split->bearing.end(),
                                  [&](const BearingMesh& each) { return each.orthophoto == i; });
    if (own == split->bearing.end()) continue;
    const Vec3 centre = 0.5 * (rectangle.positions[0] + rectangle.positions[2]);
    tinygltf::Node node = NodeOf(element, *element.attributes);
    Translate(node, centre);
    node.mesh =
        tables_.AddMesh({PrimitiveOf(*own, centre, SurfaceColour(element.attributes->colour, ""))});
    nodes.push_back(tables_.AddNode(std::move(node)));
  }
  return nodes;
}

double GlbPictures::PlaneDepth_m(const model::Photograph& photograph) {
  if (!visible_) visible_ = BoxInWorld(VisibleParts(model_, threads_));
  return FrameDepth_m(photograph, *visible_);
}

Result<int> GlbPictures::AddPhotographPlane(const Element& element,
                                            const model::Photograph& photograph) {
  const auto picture = PictureOf(photograph);
  if (!picture) return -1;
  Result<std::string> png = PngOf(*picture);
  if (!png) return tl::unexpected(png.error());
  const auto corners = FrameCorners(photograph, PlaneDepth_m(photograph));
  const Vec3 centre = 0.5 * (corners[0] + corners[2]);
  geom::Mesh mesh;
  mesh.positions.assign(corners.begin(), corners.end());
  mesh.normals.assign(4, (corners[1] - corners[0]).cross(corners[3] - corners[0]).normalized());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  tinygltf::Primitive primitive = tables_.PrimitiveOf(mesh, centre);
  tables_.AddPlaces({{0, 1}, {1, 1}, {1, 0}, {0, 0}}, &primitive);
  tinygltf::Node node = NodeOf(element, *element.attributes);
  node.name += " at its frame";
  primitive.material = tables_.AddPictureMaterial(node.name);
  tables_.SetPicture(primitive.material, *std::move(png));
  Translate(node, centre);
  node.mesh = tables_.AddMesh({std::move(primitive)});
  return tables_.AddNode(std::move(node));
}

// Two orthophotos are at hand at most: the one that is shown, and one that is seen through it.
std::optional<Error> GlbPictures::MakePictures() {
  for (auto each = materials_.begin(); each != materials_.end();) {
    const std::size_t shown = each->first.first;
    Result<RectifiedFacade> rectified = Rectify(pasting_.At(shown), threads_);
    if (!rectified) return rectified.error();
    Picture& picture = rectified->picture;
    const auto has_holes = [&] {
      return std::find(picture.alpha.begin(), picture.alpha.end(), 0) != picture.alpha.end();
    };
    for (std::size_t earlier = shown; earlier-- > 0 && has_holes();) {
      if (!LiesIn(pasting_.At(shown), pasting_.At(earlier))) continue;
      const Result<PicturePlane> plane = PlaneOf(pasting_.Shared(earlier), threads_);
      if (!plane) return plane.error();
      ShowBehind(*plane, pasting_.At(shown), threads_, &picture);
    }
    for (; each != materials_.end() && each->first.first == shown; ++each) {
      Result<std::string> png = PngOf(OverColour(picture, ColourOf(each->first.second)));
      if (!png) return png.error();
      tables_.SetPicture(each->second, *std::move(png));
    }
  }
  return std::nullopt;
}

}  // namespace tranos::output
