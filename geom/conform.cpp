// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/conform.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "geom/box_tree.h"
#include "geom/solid_rounding.h"  // PositionIndex

namespace tranos::geom {

namespace {

using Corners = std::array<std::uint32_t, 3>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;  // the lower position first

// Edges that pass one another nearer than this cross. More than kCoincident_m, so that no two edges
// that are drawn in one facet, each that near to it, cross there without a corner.
constexpr double kCrossing_m = 3 * kCoincident_m;

template <class T>
void MakeUnique(std::vector<T>* list) {
  std::sort(list->begin(), list->end());
  list->erase(std::unique(list->begin(), list->end()), list->end());
}

Edge EdgeOf(std::uint32_t a, std::uint32_t b) { return std::minmax(a, b); }

// The foot of a point on a line, as a share of the way from a to b.
double ShareAlong(const Vec3& a, const Vec3& b, const Vec3& p) {
  return (p - a).dot(b - a) / (b - a).squaredNorm();
}
bool IsOnEdge(const Vec3& a, const Vec3& b, const Vec3& p) {
  const double share = std::clamp(ShareAlong(a, b, p), 0.0, 1.0);
  return (a + share * (b - a) - p).norm() <= kCoincident_m;
}

// The positions that are joined to each by a part of an edge.
using Neighbours = std::unordered_map<std::uint32_t, std::vector<std::uint32_t>>;

// The edges of a mesh, each divided where corners lie on it and where others cross it.
class DividedEdges {
 public:
  DividedEdges(const TriangleMesh& mesh, std::vector<Vec3>* positions) : positions_(*positions) {
    std::vector<Vec3> same;
    for (const Vec3& p : *positions) index_.Of(p, &same);
    for (const Corners& t : mesh.triangles) {
      for (int k = 0; k < 3; ++k) {
        const Edge edge = EdgeOf(t[k], t[(k + 1) % 3]);
        chains_[edge] = {edge.first, edge.second};
        corners_.push_back(t[k]);
      }
    }
    MakeUnique(&corners_);
    constexpr int kMostRounds = 10;
    for (int round = 0; round < kMostRounds && DivideOnce(); ++round) {
    }
  }

  // The corners round a facet, in its direction.
  std::vector<std::uint32_t> Border(const Corners& t) const {
    std::vector<std::uint32_t> border;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      std::vector<std::uint32_t> chain = chains_.at(EdgeOf(a, b));
      if (a > b) std::reverse(chain.begin(), chain.end());
      border.insert(border.end(), chain.begin(), chain.end() - 1);
    }
    return border;
  }
  // All positions in use.
  const std::vector<std::uint32_t>& corners() const { return corners_; }
  Neighbours NeighboursOfAll() const {
    Neighbours neighbours;
    for (const Edge& part : Parts()) {
      neighbours[part.first].push_back(part.second);
      neighbours[part.second].push_back(part.first);
    }
    return neighbours;
  }

 private:
  const Vec3& At(std::uint32_t p) const { return positions_[p]; }

  std::vector<Edge> Parts() const {
    std::vector<Edge> parts;
    for (const auto& [edge, chain] : chains_) {
      for (std::size_t i = 1; i < chain.size(); ++i)
        parts.push_back(EdgeOf(chain[i - 1], chain[i]));
    }
    MakeUnique(&parts);
    return parts;
  }

  bool DivideOnce() {
    const std::vector<Edge> parts = Parts();
    std::vector<Box> boxes;
    const Vec3 reach = Vec3::Constant(kCrossing_m);
    for (const Edge& part : parts) {
      const Vec3 &a = At(part.first), &b = At(part.second);
      boxes.push_back({a.cwiseMin(b) - reach, a.cwiseMax(b) + reach});
    }
    const BoxTree tree(boxes);
    std::map<Edge, std::vector<std::uint32_t>> divisions;
    for (const std::uint32_t p : corners_) {
      tree.ForEachMeeting({At(p), At(p)}, [&](std::uint32_t i) {
        const auto [a, b] = parts[i];
        if (p != a && p != b && IsOnEdge(At(a), At(b), At(p))) divisions[parts[i]].push_back(p);
      });
    }
    if (divisions.empty()) {
      for (std::uint32_t i = 0; i < parts.size(); ++i) {
        tree.ForEachMeeting(boxes[i], [&](std::uint32_t other) {
          if (other > i) Cross(parts[i], parts[other], &divisions);
        });
      }
    }
    if (divisions.empty()) return false;
    for (auto& [edge, chain] : chains_) Divide(divisions, &chain);
    return true;
  }

  void Cross(const Edge& s, const Edge& t, std::map<Edge, std::vector<std::uint32_t>>* divisions) {
    if (s.first == t.first || s.first == t.second || s.second == t.first || s.second == t.second) {
      return;
    }
    const Vec3 &a = At(s.first), &c = At(t.first);
    const Vec3 u = At(s.second) - a, v = At(t.second) - c, w = a - c;
    const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm();
    const double sine2 = (uu * vv - uv * uv) / (uu * vv);
    if (!(sine2 > 1e-12)) return;  // side by side: their ends tell
    const double at_s = (uv * v.dot(w) - vv * u.dot(w)) / (uu * vv - uv * uv);
    const double at_t = (uu * v.dot(w) - uv * u.dot(w)) / (uu * vv - uv * uv);
    if (at_s < 0 || at_s > 1 || at_t < 0 || at_t > 1) return;
    const Vec3 p = a + at_s * u, q = c + at_t * v;
    if ((p - q).norm() > kCrossing_m) return;
    const Vec3 middle = 0.5 * (p + q);
    for (const std::uint32_t end : {s.first, s.second, t.first, t.second}) {
      if ((At(end) - middle).norm() <= kConformed_m) return;
    }
    const std::size_t count = positions_.size();
    const std::uint32_t corner = index_.Of(middle, &positions_);
    if (corner == count) corners_.push_back(corner);
    (*divisions)[s].push_back(corner);
    (*divisions)[t].push_back(corner);
  }

  void Divide(const std::map<Edge, std::vector<std::uint32_t>>& divisions,
              std::vector<std::uint32_t>* chain) const {
    std::vector<std::uint32_t> divided{chain->front()};
    for (std::size_t i = 1; i < chain->size(); ++i) {
      const std::uint32_t a = (*chain)[i - 1], b = (*chain)[i];
      const auto found = divisions.find(EdgeOf(a, b));
      if (found != divisions.end()) {
        std::vector<std::pair<double, std::uint32_t>> between;
        for (const std::uint32_t p : found->second) {
          between.emplace_back(ShareAlong(At(std::min(a, b)), At(std::max(a, b)), At(p)), p);
        }
        MakeUnique(&between);
        if (a > b) std::reverse(between.begin(), between.end());
        for (const auto& [share, p] : between) {
          // Not there and back.
          if (std::find(chain->begin(), chain->end(), p) == chain->end()) divided.push_back(p);
        }
      }
      divided.push_back(b);
    }
    *chain = std::move(divided);
  }

  std::vector<Vec3>& positions_;
  PositionIndex index_{kConformed_m};
  std::map<Edge, std::vector<std::uint32_t>> chains_;
  std::vector<std::uint32_t> corners_;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
// Delaunay, points on one circle included: what has the same corners and edges is divided alike.
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, Structure, CGAL::No_constraint_intersection_requiring_constructions_tag>;

// Facets that lie in one another are looked at along the same axis: no bound between the axes lies
// where buildings have slopes.
int AxisFor(const Vec3& normal) {
  constexpr double kSteep = 0.5321;
  if (std::abs(normal.z()) > kSteep) return 2;
  return std::abs(normal.y()) > kSteep ? 1 : 0;
}

// A facet with the corners and edges that lie in it.
class FacetDivision {
 public:
  FacetDivision(const std::vector<Vec3>& positions, const Corners& facet)
      : positions_(positions), facet_(facet) {
    normal_ = (At(facet[1]) - At(facet[0])).cross(At(facet[2]) - At(facet[0]));
    const int axis = AxisFor(normal_.normalized());
    u_ = (axis + 1) % 3, v_ = (axis + 2) % 3;
    is_turned_ = normal_[axis] < 0;
  }

  // Whether the position is between the sides and near the plane.
  bool Holds(std::uint32_t p) const {
    if (!(std::abs(normal_.normalized().dot(At(p) - At(facet_[0]))) <= kCoincident_m)) return false;
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = At(facet_[k]), &b = At(facet_[(k + 1) % 3]);
      if (normal_.dot((b - a).cross(At(p) - a)) < 0) return false;
    }
    return true;
  }

  // `border` goes round the facet as it looks.
  std::vector<Corners> Divided(const std::vector<std::uint32_t>& border,
                               const std::vector<std::uint32_t>& corners,
                               const std::vector<Edge>& edges) {
    for (const std::uint32_t p : corners) Insert(p);
    try {
      for (const auto& [a, b] : edges) Constrain(a, b);
    } catch (const Triangulation::Intersection_of_constraints_exception&) {
      return Fan(border);
    }
    std::vector<Corners> parts = Inside(border);
    return IsBounded(parts, border) ? parts : Fan(border);
  }

 private:
  using Vertex = Triangulation::Vertex_handle;
  using Face = Triangulation::Face_handle;

  const Vec3& At(std::uint32_t p) const { return positions_[p]; }
  void Insert(std::uint32_t p) {
    const Vertex vertex = cuts_.insert({At(p)[u_], At(p)[v_]});
    vertex->info() = p;
    vertices_[p] = vertex;
  }
  void Constrain(std::uint32_t a, std::uint32_t b) {
    if (vertices_.at(a) != vertices_.at(b)) {
      cuts_.insert_constraint(vertices_.at(a), vertices_.at(b));
    }
  }
  // Where corners and edges miss the plane by a hair more than counts as meeting, and so cross in
  // the projection: the border at least is kept, that the surface stays closed.
  static std::vector<Corners> Fan(const std::vector<std::uint32_t>& border) {
    std::vector<Corners> parts;
    for (std::size_t i = 2; i < border.size(); ++i) {
      const Corners part{border[0], border[i - 1], border[i]};
      if (!HasTwice(part)) parts.push_back(part);
    }
    return parts;
  }
  static bool IsBounded(const std::vector<Corners>& parts,
                        const std::vector<std::uint32_t>& border) {
    std::map<Edge, int> balance;
    const auto add = [&](std::uint32_t from, std::uint32_t to, int times) {
      balance[EdgeOf(from, to)] += from < to ? times : -times;
    };
    for (const Corners& part : parts) {
      for (int k = 0; k < 3; ++k) add(part[k], part[(k + 1) % 3], 1);
    }
    for (std::size_t i = 0; i < border.size(); ++i) {
      add(border[i], border[(i + 1) % border.size()], -1);
    }
    return std::all_of(balance.begin(), balance.end(), [](const auto& b) { return b.second == 0; });
  }
  // What the border encloses: reached from outside across it once.
  std::vector<Corners> Inside(const std::vector<std::uint32_t>& border) const {
    std::set<Edge> walls;  // those that are gone along once; of a sliver some are, there and back
    for (std::size_t i = 0; i < border.size(); ++i) {
      const Edge edge = EdgeOf(border[i], border[(i + 1) % border.size()]);
      if (!walls.insert(edge).second) walls.erase(edge);
    }
    std::unordered_map<Face, bool> is_inside{{cuts_.infinite_face(), false}};
    std::vector<Face> open{cuts_.infinite_face()};
    while (!open.empty()) {
      const Face at = open.back();
      open.pop_back();
      for (int i = 0; i < 3; ++i) {
        const Face next = at->neighbor(i);
        if (is_inside.contains(next)) continue;
        const bool is_wall =
            at->is_constrained(i) && walls.contains(EdgeOf(at->vertex(cuts_.cw(i))->info(),
                                                           at->vertex(cuts_.ccw(i))->info()));
        is_inside[next] = is_inside.at(at) != is_wall;
        open.push_back(next);
      }
    }
    std::vector<Corners> parts;
    for (const Face face : cuts_.finite_face_handles()) {
      if (!is_inside.at(face)) continue;
      Corners part{face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
      if (is_turned_) std::swap(part[1], part[2]);
      parts.push_back(part);
    }
    return parts;
  }

  const std::vector<Vec3>& positions_;
  const Corners& facet_;
  Vec3 normal_;
  int u_, v_;
  bool is_turned_;
  Triangulation cuts_;
  std::map<std::uint32_t, Vertex> vertices_;
};

// The parts of edges that join two of the corners, which are sorted.
std::vector<Edge> EdgesAmong(const std::vector<std::uint32_t>& corners,
                             const Neighbours& neighbours) {
  std::vector<Edge> edges;
  for (const std::uint32_t p : corners) {
    for (const std::uint32_t q : neighbours.at(p)) {
      if (p < q && std::binary_search(corners.begin(), corners.end(), q)) edges.emplace_back(p, q);
    }
  }
  return edges;
}

TriangleMesh ConformedOnce(const TriangleMesh& mesh) {
  TriangleMesh result{mesh.positions, {}, {}};
  const DividedEdges edges(mesh, &result.positions);
  const Neighbours neighbours = edges.NeighboursOfAll();
  std::vector<Box> boxes;
  const Vec3 reach = Vec3::Constant(kCoincident_m);
  for (const std::uint32_t p : edges.corners()) {
    boxes.push_back({result.positions[p] - reach, result.positions[p] + reach});
  }
  const BoxTree corner_tree(boxes);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Corners& t = mesh.triangles[i];
    FacetDivision division(result.positions, t);
    const std::vector<std::uint32_t> border = edges.Border(t);
    std::vector<std::uint32_t> on_facet = border;
    Box box;
    for (const std::uint32_t c : t) box.Add(result.positions[c]);
    corner_tree.ForEachMeeting(box, [&](std::uint32_t k) {
      if (division.Holds(edges.corners()[k])) on_facet.push_back(edges.corners()[k]);
    });
    MakeUnique(&on_facet);
    std::vector<Corners> parts{t};
    if (on_facet.size() > 3 || border.size() > 3) {
      parts = division.Divided(border, on_facet, EdgesAmong(on_facet, neighbours));
    }
    result.triangles.insert(result.triangles.end(), parts.begin(), parts.end());
    result.surfaces.insert(result.surfaces.end(), parts.size(), mesh.surfaces[i]);
  }
  return result;
}

}  // namespace

TriangleMesh Conformed(TriangleMesh mesh) {
  // What is divided is bent by a hair, and may come to lie in something else. Facets that lie in
  // one another in part only, at an angle of next to nothing, never come to rest.
  constexpr int kMostRounds = 3;
  mesh = Merged(std::move(mesh), kConformed_m);
  for (int round = 0; round < kMostRounds; ++round) {
    const std::size_t count = mesh.triangles.size();
    mesh = ConformedOnce(mesh);
    if (mesh.triangles.size() == count) break;
  }
  return mesh;
}

}  // namespace tranos::geom
