// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <unordered_map>
#include <utility>

#include "output/facets.h"
#include "output/mesh_lines.h"
#include "output/parallel.h"
#include "output/surface_colour.h"

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

// A visible part: where it stands and how it looks; what it is, is shared by all its placements.
struct Placement {
  std::size_t part;
  Affine world_from_part;
  model::Colour colour;
  int linestyle, weight;
};
struct Part {
  const model::Element* element = nullptr;
  double largest_scale = 0;  // of its placements
  geom::Box box;
  Facets facets;
  Vec3 centre = Vec3::Zero();
  std::shared_ptr<const RayMesh> ray_mesh;
  std::vector<MeshEdge> edges;
  std::vector<std::vector<Vec3>> feature_lines, form_lines;
};
struct Parts {
  std::vector<Part> parts;
  std::vector<Placement> placements;
};

Parts VisibleParts(const model::Model& model) {
  Parts result;
  std::unordered_map<const model::Element*, std::size_t> known;
  model.ForEach([&](const model::ElementPtr& element) {
    model::ForEachLeaf(*element, [&](const model::Element& leaf, const Affine& world_from_leaf,
                                     const model::Attributes& attributes) {
      if (!model.LevelIsOn(attributes.level)) return;
      const auto [entry, is_new] = known.try_emplace(&leaf, result.parts.size());
      if (is_new) result.parts.emplace_back().element = &leaf;
      Part& part = result.parts[entry->second];
      part.largest_scale =
          std::max(part.largest_scale, world_from_leaf.linear().colwise().norm().maxCoeff());
      result.placements.push_back({entry->second, world_from_leaf, attributes.colour,
                                   attributes.linestyle, attributes.weight});
    });
  });
  return result;
}

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

std::shared_ptr<const RayMesh> RayMeshOf(const geom::Mesh& mesh, const Vec3& centre) {
  const auto result = std::make_shared<RayMesh>();
  const auto rounded = [](const Vec3& v) {
    return std::array<float, 3>{static_cast<float>(v.x()), static_cast<float>(v.y()),
                                static_cast<float>(v.z())};
  };
  for (const Vec3& p : mesh.positions) result->positions.push_back(rounded(p - centre));
  for (const Vec3& n : mesh.normals) result->normals.push_back(rounded(n));
  result->triangles = mesh.triangles;
  return result;
}

std::optional<Error> CompletePart(Part& part, double pixel_m, model::RenderMode mode) {
  const geom::Tolerance tolerance = {kChord_px * pixel_m / std::max(part.largest_scale, 1e-12),
                                     part.element->tolerance.facets_per_turn};
  Result<Facets> facets = FacetsOf(*part.element, tolerance);
  if (!facets) return facets.error();
  part.facets = *std::move(facets);
  const geom::Mesh& mesh = part.facets.mesh;
  if (mesh.triangles.empty()) return std::nullopt;
  part.centre = part.box.centre();
  part.ray_mesh = RayMeshOf(mesh, part.centre);
  if (mode == model::RenderMode::kPhong) return std::nullopt;
  part.edges = EdgesOf(mesh);
  part.feature_lines = LinesAlong(FeatureEdges(part.edges), mesh);
  // A region's outlines are all there is to see of it.
  if (std::holds_alternative<model::RegionPtr>(part.element->geometry)) return std::nullopt;
  const auto* surface = std::get_if<model::SurfacePtr>(&part.element->geometry);
  if (tolerance.facets_per_turn > 0) {
    part.form_lines = LinesAlong(FacetEdges(mesh, part.edges), mesh);
  } else if (surface && !IsFlat(mesh)) {
    part.form_lines = IsoLines(**surface);
  }
  return std::nullopt;
}

std::optional<Error> CompleteParts(Parts& parts, const geom::Frame& directions,
                                   const model::RenderRequest& request, int threads) {
  const std::size_t count = parts.parts.size();
  ParallelFor(count, threads, [&](std::size_t i) {
    parts.parts[i].box = model::BoundingBox(*parts.parts[i].element);
  });
  const double pixel_m = RoughPixel(parts, directions, request);
  std::vector<std::optional<Error>> errors(count);
  ParallelFor(count, threads, [&](std::size_t i) {
    errors[i] = CompletePart(parts.parts[i], pixel_m, request.view.mode);
  });
  for (const std::optional<Error>& error : errors) {
    if (error) return error;
  }
  return std::nullopt;
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
  void AddLines(const std::vector<std::vector<Vec3>>& lines, const Stroke& like) {
    for (const auto& line : lines) {
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
    const std::vector<MeshEdge> edges = OutlineEdges(mesh, part.edges, picture_from_part);
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
    scene.surface_colours.push_back(ShadeOf(SurfaceColour(placement.colour)));
    if (mode == model::RenderMode::kPhong) return;
    Stroke form = Empty();
    form.opacity = kIsoOpacity;
    form.linestyle = 0;
    form.width_px = 1;
    AddLines(part.form_lines, form);
    AddLines(part.feature_lines, Empty());
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
  Parts parts = VisibleParts(request.model);
  if (auto error = CompleteParts(parts, directions, request, threads)) {
    return tl::unexpected(*std::move(error));
  }
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
    PlacementDrawer{scene, view.mode, parts.parts[placement.part], placement,
                    picture_from_world * placement.world_from_part}
        .AddAll();
  }
  return scene;
}

}  // namespace tranos::output
