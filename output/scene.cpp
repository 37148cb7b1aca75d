// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "output/material.h"
#include "output/mesh_lines.h"
#include "output/parallel.h"
#include "output/parts.h"

namespace tranos::output {
namespace {

using geom::Affine;
using geom::Vec3;

// Curved things deviate from their chords by no more than this, which no eye sees.
constexpr double kChord_px = 0.1;
// Lines across a smooth surface that show its form, in each direction, and the points of each.
constexpr int kIsoLines = 7;
constexpr int kIsoPoints = 96;
constexpr float kIsoOpacity = 0.4f;
constexpr float kPointArm_px = 4;  // from a point's cross's centre to its ends

// What a drawing shows of a part's mesh besides its faces.
struct PartLines {
  std::vector<MeshEdge> edges;
  std::vector<std::vector<Vec3>> feature_lines, form_lines;
};

// The length a pixel shows at most: from the boxes' corners, before there are facets to be
// measured.
double RoughPixel(const Parts& parts, const geom::Frame& directions,
                  const model::RenderRequest& request) {
  geom::Box view;
  for (const Placement& placement : parts.placements) {
    const geom::Box& box = parts.parts[placement.part].box;
    if (box.empty()) continue;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p(corner & 1 ? box.max.x() : box.min.x(), corner & 2 ? box.max.y() : box.min.y(),
                   corner & 4 ? box.max.z() : box.min.z());
      view.Add(directions.ToLocal(placement.world_from_part * p));
    }
  }
  return FitCamera(directions, view, request.width_px, request.height_px).pixel_m;
}

std::vector<std::vector<Vec3>> LinesAlong(const std::vector<MeshEdge>& edges,
                                          const geom::Mesh& mesh) {
  std::vector<std::vector<Vec3>> lines;
  for (const EdgeLine& line : JoinEdges(edges)) {
    std::vector<Vec3>& vertices = lines.emplace_back();
    for (const std::uint32_t vertex : line.vertices) vertices.push_back(mesh.positions[vertex]);
  }
  return lines;
}

bool IsFlat(const geom::Mesh& mesh) {
  return std::all_of(mesh.normals.begin(), mesh.normals.end(), [&](const Vec3& n) {
    return n.cross(mesh.normals.front()).squaredNorm() < 1e-16;
  });
}

std::vector<std::vector<Vec3>> IsoLines(const geom::Surface& surface) {
  std::vector<std::vector<Vec3>> lines;
  for (const bool along_u : {true, false}) {
    for (int i = 1; i <= kIsoLines; ++i) {
      const double fixed = static_cast<double>(i) / (kIsoLines + 1);
      std::vector<Vec3>& line = lines.emplace_back();
      for (int k = 0; k <= kIsoPoints; ++k) {
        const double t = static_cast<double>(k) / kIsoPoints;
        line.push_back(along_u ? geom::PointAt(surface, t, fixed)
                               : geom::PointAt(surface, fixed, t));
      }
    }
  }
  return lines;
}

PartLines LinesOf(const Part& part) {
  const geom::Mesh& mesh = part.facets.mesh;
  PartLines lines;
  lines.edges = EdgesOf(mesh);
  lines.feature_lines = LinesAlong(FeatureEdges(lines.edges), mesh);
  // A region's outlines are all there is to see of it.
  if (std::holds_alternative<model::RegionPtr>(part.element->geometry)) return lines;
  const auto* surface = std::get_if<model::SurfacePtr>(&part.element->geometry);
  if (part.element->tolerance.facets_per_turn > 0) {
    lines.form_lines = LinesAlong(FacetEdges(mesh, lines.edges), mesh);
  } else if (surface && !IsFlat(mesh)) {
    lines.form_lines = IsoLines(**surface);
  }
  return lines;
}

// Of each part; empty in shaded pictures, whose surfaces have no lines.
std::vector<PartLines> LinesOf(const Parts& parts, model::RenderMode mode, int threads) {
  std::vector<PartLines> lines(parts.parts.size());
  if (mode == model::RenderMode::kPhong) return lines;
  ParallelFor(parts.parts.size(), threads, [&](std::size_t i) {
    if (parts.parts[i].ray_mesh) lines[i] = LinesOf(parts.parts[i]);
  });
  return lines;
}

// Around what is drawn, along the view's axes.
geom::Box BoxInView(const Parts& parts, const geom::Frame& directions) {
  geom::Box view;
  for (const Placement& placement : parts.placements) {
    const Facets& facets = parts.parts[placement.part].facets;
    const auto add = [&](const std::vector<Vec3>& points) {
      for (const Vec3& p : points) view.Add(directions.ToLocal(placement.world_from_part * p));
    };
    add(facets.points);
    for (const auto& stroke : facets.strokes) add(stroke);
    add(facets.mesh.positions);
  }
  return view;
}

Shade ShadeOf(const model::Rgb& rgb) { return Shade(rgb.r, rgb.g, rgb.b) / 255.0f; }

// Adds one placement's lines and faces to the scene.
struct PlacementDrawer {
  Scene& scene;
  model::RenderMode mode;
  const Part& part;
  const PartLines& lines;
  const Placement& placement;
  Affine picture_from_part;

  Eigen::Vector3f InPicture(const Vec3& p) const { return (picture_from_part * p).cast<float>(); }
  Stroke Empty() const {
    Stroke stroke;
    stroke.colour = ShadeOf(model::RgbOf(placement.colour));
    stroke.linestyle = placement.linestyle;
    stroke.width_px = static_cast<float>(std::max(placement.weight, 1));
    return stroke;
  }
  void AddLines(const std::vector<std::vector<Vec3>>& polylines, const Stroke& like) {
    for (const auto& line : polylines) {
      Stroke& stroke = scene.strokes.emplace_back(like);
      for (const Vec3& p : line) stroke.vertices.push_back(InPicture(p));
    }
  }
  void AddPoint(const Vec3& point) {
    const Eigen::Vector3f centre = InPicture(point);
    for (const Eigen::Vector3f& arm :
         {Eigen::Vector3f(kPointArm_px, 0, 0), Eigen::Vector3f(0, kPointArm_px, 0)}) {
      Stroke stroke = Empty();
      stroke.linestyle = 0;
      stroke.vertices = {centre - arm, centre + arm};
      scene.strokes.push_back(std::move(stroke));
    }
  }
  void AddOutlines() {
    const geom::Mesh& mesh = part.facets.mesh;
    const std::vector<MeshEdge> edges = OutlineEdges(mesh, lines.edges, picture_from_part);
    for (const EdgeLine& line : JoinEdges(edges)) {
      Stroke stroke = Empty();
      for (const std::uint32_t vertex : line.vertices) {
        stroke.vertices.push_back(InPicture(mesh.positions[vertex]));
      }
      for (std::size_t i = 0; i < line.edges.size(); ++i) {
        stroke.outward.push_back(
            Outward(stroke.vertices[i], stroke.vertices[i + 1], edges[line.edges[i]].triangles[0]));
      }
      scene.strokes.push_back(std::move(stroke));
    }
  }
  // Across the edge, away from its triangle.
  Eigen::Vector2f Outward(const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                          std::uint32_t triangle) const {
    const Eigen::Vector2f along = (b - a).head<2>();
    Eigen::Vector2f across = Eigen::Vector2f(-along.y(), along.x()).normalized();
    float side = 0;  // of the corner that is farthest from the edge
    for (const std::uint32_t corner : part.facets.mesh.triangles[triangle]) {
      const Eigen::Vector2f p = InPicture(part.facets.mesh.positions[corner]).head<2>();
      const float distance = across.dot(p - a.head<2>());
      if (std::abs(distance) > std::abs(side)) side = distance;
    }
    return side > 0 ? Eigen::Vector2f(-across) : across;
  }
  void AddSurface() {
    Affine picture_from_mesh = picture_from_part;
    picture_from_mesh.translation() = picture_from_part * part.centre;
    scene.surfaces.push_back({part.ray_mesh, picture_from_mesh.affine().cast<float>()});
    scene.surface_colours.push_back(ShadeOf(SurfaceColour(placement.colour, placement.material)));
    if (mode == model::RenderMode::kPhong) return;
    Stroke form = Empty();
    form.opacity = kIsoOpacity;
    form.linestyle = 0;
    form.width_px = 1;
    AddLines(lines.form_lines, form);
    AddLines(lines.feature_lines, Empty());
    if (mode == model::RenderMode::kHidden) AddOutlines();
  }
  void AddAll() {
    for (const Vec3& point : part.facets.points) AddPoint(point);
    AddLines(part.facets.strokes, Empty());
    if (part.ray_mesh) AddSurface();
  }
};

}  // namespace

Result<Scene> SceneOf(const model::RenderRequest& request, int threads) {
  const model::View& view = request.view;
  const geom::Frame directions =
      model::FrameOf(view.direction.empty() ? std::string_view("iso") : view.direction);
  Parts parts = VisibleParts(request.model, threads);
  const double pixel_m = RoughPixel(parts, directions, request);
  if (auto error = MakeFacets(parts, kChord_px * pixel_m, threads)) {
    return tl::unexpected(*std::move(error));
  }
  const std::vector<PartLines> lines = LinesOf(parts, view.mode, threads);
  Scene scene;
  const geom::Box box = BoxInView(parts, directions);
  scene.camera = FitCamera(directions, box, request.width_px, request.height_px);
  if (!box.empty()) {
    const double half_depth = 0.5 * (box.max.z() - box.min.z()) / scene.camera.pixel_m;
    scene.nearest = static_cast<float>(half_depth);
    scene.farthest = -scene.nearest;
  }
  const Affine picture_from_world = scene.camera.picture_from_world();
  for (const Placement& placement : parts.placements) {
    PlacementDrawer{scene,
                    view.mode,
                    parts.parts[placement.part],
                    lines[placement.part],
                    placement,
                    picture_from_world * placement.world_from_part}
        .AddAll();
  }
  return scene;
}

}  // namespace tranos::output
