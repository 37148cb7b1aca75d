// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/mesh_lines.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "geom/equal_positions.h"

namespace tranos::output {
namespace {

using geom::Vec3;
using Ends = std::array<std::uint32_t, 2>;

Ends Sorted(std::uint32_t a, std::uint32_t b) { return a < b ? Ends{a, b} : Ends{b, a}; }

Vec3 Normal(const geom::Mesh& mesh, std::uint32_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const Vec3& p = mesh.positions[t[0]];
  return (mesh.positions[t[1]] - p).cross(mesh.positions[t[2]] - p);
}

}  // namespace

std::vector<MeshEdge> EdgesOf(const geom::Mesh& mesh) {
  const std::vector<std::uint32_t> first = geom::FirstOfEqual(mesh.positions);
  struct Side {
    Ends ends;
    std::uint32_t triangle;
    bool operator<(const Side& other) const {
      return std::tie(ends, triangle) < std::tie(other.ends, other.triangle);
    }
  };
  std::vector<Side> sides;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const Ends ends = Sorted(first[t[k]], first[t[(k + 1) % 3]]);
      if (ends[0] != ends[1]) sides.push_back({ends, i});
    }
  }
  std::sort(sides.begin(), sides.end());
  std::vector<Ends> features;
  for (const auto& edge : mesh.edges) features.push_back(Sorted(first[edge[0]], first[edge[1]]));
  std::sort(features.begin(), features.end());
  std::vector<MeshEdge> edges;
  for (std::size_t i = 0; i < sides.size();) {
    const bool paired = i + 1 < sides.size() && sides[i + 1].ends == sides[i].ends;
    edges.push_back({sides[i].ends,
                     {sides[i].triangle, paired ? sides[i + 1].triangle : kNoTriangle},
                     std::binary_search(features.begin(), features.end(), sides[i].ends)});
    i += paired ? 2 : 1;
  }
  return edges;
}

namespace {

// Walks along edges that have not been taken yet.
class EdgeWalker {
 public:
  explicit EdgeWalker(const std::vector<MeshEdge>& edges) : edges_(edges), taken_(edges.size()) {
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
      for (const std::uint32_t end : edges[i].ends) at_vertex_.emplace_back(end, i);
    }
    std::sort(at_vertex_.begin(), at_vertex_.end());
  }

  std::vector<EdgeLine> Lines() {
    std::vector<EdgeLine> lines;
    for (const bool through_joints : {false, true}) {  // open lines from their ends, then rings
      for (std::uint32_t i = 0; i < edges_.size(); ++i) {
        for (const std::uint32_t end : edges_[i].ends) {
          if (!taken_[i] && (through_joints || !IsJoint(end))) lines.push_back(LineFrom(i, end));
        }
      }
    }
    return lines;
  }

 private:
  using Range = std::pair<std::size_t, std::size_t>;
  Range EdgesAt(std::uint32_t vertex) const {
    const auto begin = std::lower_bound(at_vertex_.begin(), at_vertex_.end(),
                                        std::pair<std::uint32_t, std::uint32_t>{vertex, 0});
    auto end = begin;
    while (end != at_vertex_.end() && end->first == vertex) ++end;
    return {static_cast<std::size_t>(begin - at_vertex_.begin()),
            static_cast<std::size_t>(end - at_vertex_.begin())};
  }
  bool IsJoint(std::uint32_t vertex) const {
    const auto [begin, end] = EdgesAt(vertex);
    return end - begin == 2;
  }
  EdgeLine LineFrom(std::uint32_t edge, std::uint32_t start) {
    EdgeLine line;
    line.vertices.push_back(start);
    for (;;) {
      taken_[edge] = true;
      line.edges.push_back(edge);
      const Ends& ends = edges_[edge].ends;
      const std::uint32_t next = ends[0] == line.vertices.back() ? ends[1] : ends[0];
      line.vertices.push_back(next);
      const auto [begin, end] = EdgesAt(next);
      if (end - begin != 2) return line;
      edge = at_vertex_[begin].second == edge ? at_vertex_[begin + 1].second
                                              : at_vertex_[begin].second;
      if (taken_[edge]) return line;
    }
  }

  const std::vector<MeshEdge>& edges_;
  std::vector<bool> taken_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> at_vertex_;  // (vertex, edge), sorted
};

template <class F>
std::vector<MeshEdge> InnerEdges(const std::vector<MeshEdge>& edges, F&& wanted) {
  std::vector<MeshEdge> result;
  for (const MeshEdge& edge : edges) {
    if (!edge.feature && edge.triangles[1] != kNoTriangle && wanted(edge)) result.push_back(edge);
  }
  return result;
}

}  // namespace

std::vector<EdgeLine> JoinEdges(const std::vector<MeshEdge>& edges) {
  return EdgeWalker(edges).Lines();
}

std::vector<MeshEdge> FeatureEdges(const std::vector<MeshEdge>& edges) {
  std::vector<MeshEdge> result;
  for (const MeshEdge& edge : edges) {
    if (edge.feature) result.push_back(edge);
  }
  return result;
}

std::vector<MeshEdge> FacetEdges(const geom::Mesh& mesh, const std::vector<MeshEdge>& edges) {
  const double sin_limit = std::sin(0.5 * geom::kPi / 180);
  return InnerEdges(edges, [&](const MeshEdge& edge) {
    const Vec3 a = Normal(mesh, edge.triangles[0]), b = Normal(mesh, edge.triangles[1]);
    return a.cross(b).norm() > sin_limit * a.norm() * b.norm();
  });
}

std::vector<MeshEdge> OutlineEdges(const geom::Mesh& mesh, const std::vector<MeshEdge>& edges,
                                   const geom::Affine& picture_from_mesh) {
  // The picture's z direction, so that a facet edge-on is told from one that is just about seen.
  const Vec3 x = picture_from_mesh.linear().row(0), y = picture_from_mesh.linear().row(1);
  const Vec3 towards_viewer = x.cross(y).normalized();
  std::vector<bool> front(mesh.triangles.size());
  for (std::uint32_t i = 0; i < front.size(); ++i) {
    const Vec3 n = Normal(mesh, i);
    front[i] = n.dot(towards_viewer) > 1e-7 * n.norm();
  }
  return InnerEdges(edges, [&](const MeshEdge& edge) {
    return front[edge.triangles[0]] != front[edge.triangles[1]];
  });
}

}  // namespace tranos::output
