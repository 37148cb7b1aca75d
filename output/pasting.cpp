// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/pasting.h"

#include <array>
#include <cmath>

namespace tranos::output {
namespace {

using geom::Affine;
using geom::Mesh;
using geom::Vec2;
using geom::Vec3;

// The cosine between a face and a plane, from which on it lies in it.
constexpr double kParallel = 0.9999;
// Slivers smaller than this are left out.
constexpr double kLeastArea_m2 = 1e-12;

struct Corner {
  Vec3 position, normal;  // in the mesh's frame
  Vec3 on_plane;          // in the orthophoto's
};
using Polygon = std::vector<Corner>;

Corner Between(const Corner& a, const Corner& b, double t) {
  return {a.position + t * (b.position - a.position), a.normal + t * (b.normal - a.normal),
          a.on_plane + t * (b.on_plane - a.on_plane)};
}

double AreaOf(const Polygon& polygon) {
  Vec3 twice = Vec3::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += (polygon[i - 1].position - polygon[0].position)
                 .cross(polygon[i].position - polygon[0].position);
  }
  return 0.5 * twice.norm();
}

// Takes the part away from the convex polygon that lies beyond side·axis = limit, and gives it.
Polygon CutAway(Polygon& polygon, int axis, double side, double limit) {
  Polygon kept, cut;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double over_a = side * a.on_plane[axis] - limit, over_b = side * b.on_plane[axis] - limit;
    (over_a > 0 ? cut : kept).push_back(a);
    if ((over_a > 0) != (over_b > 0) && over_a != 0 && over_b != 0) {
      const Corner border = Between(a, b, over_a / (over_a - over_b));
      kept.push_back(border);
      cut.push_back(border);
    }
  }
  polygon = std::move(kept);
  return cut;
}

void Add(const Polygon& polygon, Mesh* mesh) {
  const auto first = static_cast<std::uint32_t>(mesh->positions.size());
  for (const Corner& corner : polygon) {
    mesh->positions.push_back(corner.position);
    mesh->normals.push_back(corner.normal.normalized());
  }
  for (std::uint32_t i = 2; i < polygon.size(); ++i) {
    mesh->triangles.push_back({first, first + i - 1, first + i});
  }
}

// Whether the triangle lies in the orthophoto's plane and touches it; its corners' places there are
// noted.
bool Bears(const model::Orthophoto& orthophoto, const Affine& world_from_mesh, Polygon& triangle) {
  geom::Box box;
  for (Corner& corner : triangle) {
    corner.on_plane = orthophoto.plane.ToLocal(world_from_mesh * corner.position);
    box.Add(corner.on_plane);
  }
  const Vec2 size = orthophoto.size_m();
  if (box.min.z() < -orthophoto.tolerance_m || box.max.z() > orthophoto.tolerance_m) return false;
  if (box.max.x() <= 0 || box.max.y() <= 0 || box.min.x() >= size.x() || box.min.y() >= size.y()) {
    return false;
  }
  const Vec3 across = (triangle[1].on_plane - triangle[0].on_plane)
                          .cross(triangle[2].on_plane - triangle[0].on_plane);
  return std::abs(across.z()) > kParallel * across.norm();
}

}  // namespace

Pasting::Pasting(const model::Model& model) {
  model.ForEach([&](const model::ElementPtr& element) {
    const auto* orthophoto = std::get_if<model::OrthophotoPtr>(&element->geometry);
    if (orthophoto && (*orthophoto)->pixels && model.LevelIsOn(element->attributes->level)) {
      elements_.push_back(element);
    }
  });
}

const model::Orthophoto& Pasting::At(std::size_t index) const {
  return *std::get<model::OrthophotoPtr>(elements_[index]->geometry);
}

std::optional<SplitMesh> Pasting::Split(const Mesh& mesh, const Affine& world_from_mesh) const {
  SplitMesh split;
  for (std::size_t i = 0; i < elements_.size(); ++i) split.bearing.push_back({i, {}, {}});
  bool any = false;
  for (const auto& corners : mesh.triangles) {
    Polygon triangle;
    for (const std::uint32_t corner : corners) {
      triangle.push_back({mesh.positions[corner], mesh.normals[corner], Vec3::Zero()});
    }
    std::vector<Polygon> plain{triangle};
    for (std::size_t i = elements_.size(); i-- > 0;) {
      const model::Orthophoto& orthophoto = At(i);
      if (!Bears(orthophoto, world_from_mesh, triangle)) continue;
      const Vec2 size = orthophoto.size_m();
      std::vector<Polygon> rest;
      for (Polygon& polygon : plain) {
        for (Corner& corner : polygon) {
          corner.on_plane = orthophoto.plane.ToLocal(world_from_mesh * corner.position);
        }
        for (const auto& [axis, side, limit] :
             {std::tuple{0, -1.0, 0.0}, {0, 1.0, size.x()}, {1, -1.0, 0.0}, {1, 1.0, size.y()}}) {
          Polygon cut = CutAway(polygon, axis, side, limit);
          if (cut.size() > 2 && AreaOf(cut) > kLeastArea_m2) rest.push_back(std::move(cut));
        }
        if (polygon.size() < 3 || AreaOf(polygon) <= kLeastArea_m2) continue;
        any = true;
        Add(polygon, &split.bearing[i].mesh);
        for (const Corner& corner : polygon) {
          split.bearing[i].places.emplace_back(corner.on_plane.x() / size.x(),
                                               1 - corner.on_plane.y() / size.y());
        }
      }
      plain = std::move(rest);
    }
    for (const Polygon& polygon : plain) Add(polygon, &split.plain);
  }
  if (!any) return std::nullopt;
  std::erase_if(split.bearing, [](const BearingMesh& each) { return each.places.empty(); });
  return split;
}

Picture OverColour(const Picture& picture, const model::Rgb& colour) {
  Picture over{picture.width_px, picture.height_px, picture.rgb, {}};
  for (std::size_t i = 0; i < picture.alpha.size(); ++i) {
    if (picture.alpha[i] != 0) continue;
    over.rgb[3 * i] = colour.r, over.rgb[3 * i + 1] = colour.g, over.rgb[3 * i + 2] = colour.b;
  }
  return over;
}

}  // namespace tranos::output
