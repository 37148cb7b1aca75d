// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/pasting.h"

#include <algorithm>
#include <tuple>

namespace tranos::output {
namespace {

using geom::Affine;
using geom::Mesh;
using geom::Vec2;
using geom::Vec3;

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
// What lies on the border belongs to both.
Polygon CutAway(Polygon& polygon, int axis, double side, double limit) {
  Polygon kept, cut;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double over_a = side * a.on_plane[axis] - limit, over_b = side * b.on_plane[axis] - limit;
    if (over_a >= 0) cut.push_back(a);
    if (over_a <= 0) kept.push_back(a);
    if (over_a * over_b < 0) {
      const Corner border = Between(a, b, over_a / (over_a - over_b));
      kept.push_back(border);
      cut.push_back(border);
    }
  }
  polygon = std::move(kept);
  return cut;
}

bool IsLarge(const Polygon& polygon) {
  return polygon.size() > 2 && AreaOf(polygon) > kLeastArea_m2;
}

// What of the convex polygon lies beside the orthophoto, in convex parts; it keeps the rest.
std::vector<Polygon> CutAlong(const model::Orthophoto& orthophoto, const Affine& world_from_mesh,
                              Polygon& polygon) {
  for (Corner& corner : polygon) {
    corner.on_plane = orthophoto.plane.ToLocal(world_from_mesh * corner.position);
  }
  const Vec2 size = orthophoto.size_m();
  std::vector<Polygon> beside;
  for (const auto& [axis, side, limit] :
       {std::tuple{0, -1.0, 0.0}, {0, 1.0, size.x()}, {1, -1.0, 0.0}, {1, 1.0, size.y()}}) {
    Polygon cut = CutAway(polygon, axis, side, limit);
    if (IsLarge(cut)) beside.push_back(std::move(cut));
  }
  return beside;
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

}  // namespace

Pasting::Pasting(const model::Model& model) {
  model.ForEach([&](const model::ElementPtr& element) {
    const auto* orthophoto = std::get_if<model::OrthophotoPtr>(&element->geometry);
    if (orthophoto && (*orthophoto)->pixels && model.LevelIsOn(element->attributes->level)) {
      elements_.push_back(element);
    }
  });
}

const model::OrthophotoPtr& Pasting::Shared(std::size_t index) const {
  return std::get<model::OrthophotoPtr>(elements_[index]->geometry);
}

bool Pasting::Touch(const geom::Box& box, const Affine& world_from_box) const {
  return std::any_of(elements_.begin(), elements_.end(), [&](const model::ElementPtr& element) {
    return Touches(*std::get<model::OrthophotoPtr>(element->geometry), box, world_from_box);
  });
}

std::optional<SplitMesh> Pasting::Split(const Mesh& mesh, const Affine& world_from_mesh,
                                        bool has_outside) const {
  SplitMesh split;
  for (std::size_t i = 0; i < elements_.size(); ++i) split.bearing.push_back({i, {}, {}});
  std::vector<bool> is_borne(elements_.size());
  const Eigen::Matrix3d world_from_normal = world_from_mesh.linear().inverse().transpose();
  for (const auto& corners : mesh.triangles) {
    Polygon triangle;
    std::array<Vec3, 3> in_world;
    Vec3 outward = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.push_back({mesh.positions[corners[k]], mesh.normals[corners[k]], Vec3::Zero()});
      in_world[k] = world_from_mesh * mesh.positions[corners[k]];
      if (has_outside) outward += world_from_normal * mesh.normals[corners[k]];
    }
    std::vector<Polygon> plain{triangle};
    for (std::size_t i = elements_.size(); i-- > 0;) {
      const model::Orthophoto& orthophoto = At(i);
      if (!model::Bears(in_world, outward, orthophoto.plane, orthophoto.tolerance_m)) continue;
      Polygon whole = triangle;
      CutAlong(orthophoto, world_from_mesh, whole);
      if (!IsLarge(whole)) continue;
      is_borne[i] = true;
      std::vector<Polygon> rest;
      for (Polygon& polygon : plain) {
        for (Polygon& beside : CutAlong(orthophoto, world_from_mesh, polygon)) {
          rest.push_back(std::move(beside));
        }
        if (!IsLarge(polygon)) continue;
        Add(polygon, &split.bearing[i].mesh);
        const Vec2 size = orthophoto.size_m();
        for (const Corner& corner : polygon) {
          split.bearing[i].places.emplace_back(corner.on_plane.x() / size.x(),
                                               1 - corner.on_plane.y() / size.y());
        }
      }
      plain = std::move(rest);
    }
    for (const Polygon& polygon : plain) Add(polygon, &split.plain);
  }
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    if (is_borne[i]) split.borne.push_back(i);
  }
  if (split.borne.empty()) return std::nullopt;
  std::erase_if(split.bearing, [](const BearingMesh& each) { return each.places.empty(); });
  return split;
}

std::array<Vec3, 4> CornersOf(const model::Orthophoto& orthophoto) {
  const Vec2 size = orthophoto.size_m();
  std::array<Vec3, 4> corners{Vec3(0, 0, 0), Vec3(size.x(), 0, 0), Vec3(size.x(), size.y(), 0),
                              Vec3(0, size.y(), 0)};
  for (Vec3& corner : corners) corner = orthophoto.plane.ToWorld(corner);
  return corners;
}

bool Touches(const model::Orthophoto& orthophoto, const geom::Box& box,
             const Affine& world_from_box) {
  const geom::Box on_plane =
      geom::Carried(box, orthophoto.plane.WorldFromFrame().inverse() * world_from_box);
  const Vec2 size = orthophoto.size_m();
  const double tolerance_m = orthophoto.tolerance_m + geom::kCoincident_m;
  return !on_plane.empty() && on_plane.min.z() <= tolerance_m && on_plane.max.z() >= -tolerance_m &&
         on_plane.max.x() > 0 && on_plane.max.y() > 0 && on_plane.min.x() < size.x() &&
         on_plane.min.y() < size.y();
}

bool LiesIn(const model::Orthophoto& over, const model::Orthophoto& beneath) {
  const auto corners = CornersOf(over);
  geom::Box box;
  for (const Vec3& corner : corners) box.Add(corner);
  return Touches(beneath, box, Affine::Identity()) &&
         model::Bears({corners[0], corners[1], corners[2]}, over.plane.z(), beneath.plane,
                      beneath.tolerance_m) &&
         model::Bears({corners[0], corners[2], corners[3]}, over.plane.z(), beneath.plane,
                      beneath.tolerance_m);
}

}  // namespace tranos::output
