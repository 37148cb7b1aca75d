// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "model/faces.h"
#include "output/material.h"
#include "output/mesh_lines.h"
#include "output/parallel.h"
#include "output/parts.h"
#include "output/pasting.h"

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
  const Affine view_from_world = directions.WorldFromFrame().inverse();
  geom::Box view;
  for (const Placement& placement : parts.placements) {
    view.Add(geom::Carried(parts.parts[placement.part].box,
                           view_from_world * placement.world_from_part));
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
  std::vector<Borne> borne;

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
    scene.borne.push_back(std::move(borne));
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

// A part as the eye sees it where it is placed: in picture space.
Part SeenBy(const Eye& eye, const Part& part, const Affine& world_from_part) {
  Part seen;
  seen.element = part.element;
  seen.facets = eye.InPicture(part.facets, world_from_part);
  if (!seen.facets.mesh.triangles.empty()) {
    seen.ray_mesh = RayMeshOf(seen.facets.mesh, Vec3::Zero());
  }
  return seen;
}
PartLines SeenBy(const Eye& eye, const PartLines& lines, const Part& seen,
                 const Affine& world_from_part) {
  return {EdgesOf(seen.facets.mesh), eye.InPicture(lines.feature_lines, world_from_part),
          eye.InPicture(lines.form_lines, world_from_part)};
}

void AddTo(geom::Box& box, const Facets& facets) {
  for (const auto& triangle : facets.mesh.triangles) {
    for (const std::uint32_t corner : triangle) box.Add(facets.mesh.positions[corner]);
  }
  for (const auto& stroke : facets.strokes) {
    for (const Vec3& p : stroke) box.Add(p);
  }
  for (const Vec3& p : facets.points) box.Add(p);
}

// The triangles of a mesh, drawn for a placed part, that bear the scene's orthophotos.
std::vector<Borne> BorneBy(const Scene& scene, const Part& part, const Placement& placement,
                           const geom::Mesh& drawn) {
  const Affine& world_from_part = placement.world_from_part;
  const Eigen::Matrix3d world_from_normal = world_from_part.linear().inverse().transpose();
  const auto& eye = scene.eye;
  const auto in_world = [&](const Vec3& p) -> Vec3 {
    return eye ? eye->InWorld(p) : world_from_part * p;
  };
  const auto outward = [&](const Vec3& normal) -> Vec3 {
    if (!model::HasOutside(*part.element)) return Vec3::Zero();
    return eye ? eye->InWorldAlong(normal) : world_from_normal * normal;
  };
  std::vector<Borne> borne;
  for (std::size_t p = 0; p < scene.planes.size(); ++p) {
    const model::Orthophoto& of = *scene.planes[p].of;
    if (!Touches(of, part.box, world_from_part)) continue;
    std::vector<bool> by;
    for (const auto& t : drawn.triangles) {
      std::array<Vec3, 3> corners;
      Vec3 out = Vec3::Zero();
      for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = in_world(drawn.positions[t[i]]);
        out += outward(drawn.normals[t[i]]);
      }
      by.push_back(model::Bears(corners, out, of.plane, of.tolerance_m));
    }
    borne.push_back({p, std::move(by)});
  }
  return borne;
}

// Through the camera of a photograph.
Result<Scene> SceneThrough(const model::Photograph& photograph, const model::RenderRequest& request,
                           std::vector<PicturePlane> planes, int threads) {
  const camera::Camera& camera = photograph.estimate->camera;
  Parts parts = VisibleParts(request.model, threads);
  const geom::Box world = BoxInWorld(parts);
  Scene scene;
  scene.planes = std::move(planes);
  const Eye& eye = scene.eye.emplace(camera, photograph.frame, request.width_px, request.height_px);
  scene.camera.width_px = request.width_px;
  scene.camera.height_px = request.height_px;
  if (request.view.photo) scene.backdrop = PictureOf(photograph);
  const double pixel_m = FinestPixel_m(world, camera, photograph.frame);
  if (auto error = MakeFacets(parts, kChord_px * pixel_m, threads)) {
    return tl::unexpected(*std::move(error));
  }
  const model::RenderMode mode = request.view.mode;
  const std::vector<PartLines> lines = LinesOf(parts, mode, threads);
  geom::Box box;
  for (const Placement& placement : parts.placements) {
    const Affine& world_from_part = placement.world_from_part;
    const Part seen = SeenBy(eye, parts.parts[placement.part], world_from_part);
    const bool has_lines = mode != model::RenderMode::kPhong;
    const PartLines seen_lines =
        has_lines ? SeenBy(eye, lines[placement.part], seen, world_from_part) : PartLines{};
    AddTo(box, seen.facets);
    PlacementDrawer{scene,
                    mode,
                    seen,
                    seen_lines,
                    placement,
                    Affine::Identity(),
                    BorneBy(scene, parts.parts[placement.part], placement, seen.facets.mesh)}
        .AddAll();
  }
  if (!box.empty()) {
    scene.nearest = static_cast<float>(box.max.z());
    scene.farthest = static_cast<float>(box.min.z());
  }
  return scene;
}

// A photograph that is shown as a plane at its frame.
struct ShownPhotograph {
  std::array<Vec3, 4> corners;
  PicturePlane plane;
};
std::vector<ShownPhotograph> ShownPhotographs(const model::Model& model, const geom::Box& built) {
  std::vector<ShownPhotograph> shown;
  model.ForEach([&](const model::ElementPtr& element) {
    const auto* photograph = std::get_if<model::PhotographPtr>(&element->geometry);
    if (!photograph || !HasCamera(**photograph)) return;
    if (!model.LevelIsOn(element->attributes->level)) return;
    auto picture = PictureOf(**photograph);
    if (!picture) return;
    const double depth_m = FrameDepth_m(**photograph, built);
    shown.push_back({FrameCorners(**photograph, depth_m),
                     PlaneAtFrame(**photograph, depth_m, std::move(picture))});
  });
  return shown;
}

void AddPhotograph(const ShownPhotograph& shown, const Affine& picture_from_world, Scene* scene) {
  geom::Mesh mesh;
  for (const Vec3& corner : shown.corners) mesh.positions.push_back(corner - shown.corners[0]);
  mesh.normals.assign(4, mesh.positions[1].cross(mesh.positions[3]).normalized());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  Affine picture_from_mesh = picture_from_world;
  picture_from_mesh.translation() = picture_from_world * shown.corners[0];
  scene->surfaces.push_back(
      {RayMeshOf(mesh, Vec3::Zero()), picture_from_mesh.affine().cast<float>()});
  scene->surface_colours.push_back(Shade::Ones());
  scene->borne.push_back({{scene->planes.size(), {true, true}}});
  scene->planes.push_back(shown.plane);
}

// In a parallel projection.
Result<Scene> SceneAlong(const model::RenderRequest& request, std::vector<PicturePlane> planes,
                         int threads) {
  const model::View& view = request.view;
  const geom::Frame directions = model::FrameOf(view, request.model, "iso");
  Parts parts = VisibleParts(request.model, threads);
  const double pixel_m = RoughPixel(parts, directions, request);
  if (auto error = MakeFacets(parts, kChord_px * pixel_m, threads)) {
    return tl::unexpected(*std::move(error));
  }
  const std::vector<PartLines> lines = LinesOf(parts, view.mode, threads);
  Scene scene;
  scene.planes = std::move(planes);
  geom::Box box = BoxInView(parts, directions);
  std::vector<ShownPhotograph> photographs;
  if (view.photo) photographs = ShownPhotographs(request.model, BoxInWorld(parts));
  for (const ShownPhotograph& shown : photographs) {
    for (const Vec3& corner : shown.corners) box.Add(directions.ToLocal(corner));
  }
  scene.camera = FitCamera(directions, box, request.width_px, request.height_px);
  if (!box.empty()) {
    const double half_depth = 0.5 * (box.max.z() - box.min.z()) / scene.camera.pixel_m;
    scene.nearest = static_cast<float>(half_depth);
    scene.farthest = -scene.nearest;
  }
  const Affine picture_from_world = scene.camera.picture_from_world();
  for (const Placement& placement : parts.placements) {
    const Part& part = parts.parts[placement.part];
    PlacementDrawer{scene,
                    view.mode,
                    part,
                    lines[placement.part],
                    placement,
                    picture_from_world * placement.world_from_part,
                    BorneBy(scene, part, placement, part.facets.mesh)}
        .AddAll();
  }
  for (const ShownPhotograph& shown : photographs) {
    AddPhotograph(shown, picture_from_world, &scene);
  }
  return scene;
}

}  // namespace

Result<Scene> SceneOf(const model::RenderRequest& request, int threads) {
  std::vector<PicturePlane> planes;
  if (request.view.textured) {
    auto made = OrthophotoPlanes(request.model, threads);
    if (!made) return tl::unexpected(made.error());
    planes = *std::move(made);
  }
  const model::ElementPtr through = model::CameraOf(request.view, request.model);
  if (!through) return SceneAlong(request, std::move(planes), threads);
  return SceneThrough(*std::get<model::PhotographPtr>(through->geometry), request,
                      std::move(planes), threads);
}

Vec3 Scene::InWorld(const Eigen::Vector3f& in_picture) const {
  if (eye) return eye->InWorld(in_picture.cast<double>());
  return camera.picture_from_world().inverse() * in_picture.cast<double>();
}

Vec3 Scene::DirectionInWorld(const Eigen::Vector3f& direction) const {
  if (eye) return eye->InWorldAlong(direction.cast<double>());
  return camera.frame.ToWorld(direction.cast<double>()) - camera.frame.origin;
}

Eigen::Vector3f Scene::TowardsViewer(float x, float y) const {
  return eye ? eye->TowardsViewer(x, y) : Eigen::Vector3f(Eigen::Vector3f::UnitZ());
}

Eigen::Vector3f Scene::Moving(const Eigen::Vector3f& from, const Eigen::Vector3f& direction) const {
  return eye ? eye->Moving(from, direction) : direction;
}

}  // namespace tranos::output
