// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/stitch.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "geom/mesh_edges.h"
#include "geom/union_find.h"

namespace tranos::geom {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
constexpr double kSamePlace_m = 1e-6;
constexpr double kSameNormal = 1 - 1e-6;  // cosine

// Parts of a mesh that share vertices: creases have two rows of them.
UnionFind PartsOf(const Mesh& mesh) {
  UnionFind parts(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    parts.Unite(t[0], t[1]);
    parts.Unite(t[0], t[2]);
  }
  return parts;
}

class Stitcher {
 public:
  explicit Stitcher(double tolerance_m) : tolerance_m_(tolerance_m) {}

  void Add(const Mesh& mesh) {
    const UnionFind parts = PartsOf(mesh);
    std::map<std::uint32_t, std::uint32_t> surface_of_root;
    std::vector<std::uint32_t> joined;
    for (const Vec3& p : mesh.positions) joined.push_back(PositionAt(p));
    for (const Triangle& t : mesh.triangles) {
      const Triangle corners = {joined[t[0]], joined[t[1]], joined[t[2]]};
      if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
        continue;
      const auto [entry, is_new] = surface_of_root.try_emplace(parts.Root(t[0]), surface_count_);
      if (is_new) ++surface_count_;
      for (std::size_t k = 0; k < 3; ++k) NoteNormal(entry->second, corners[k], mesh.normals[t[k]]);
      mesh_.triangles.push_back(corners);
      mesh_.surfaces.push_back(entry->second);
    }
  }

  Stitched Finish() {
    SplitBorders();
    Orient();
    Stitched result;
    result.normals.resize(mesh_.positions.size());
    for (const auto& [key, normal] : normals_) {
      const Vec3 outward = flipped_[key.second] ? Vec3(-normal) : normal;
      std::vector<Vec3>& at = result.normals[key.first];
      const bool known = std::any_of(at.begin(), at.end(),
                                     [&](const Vec3& n) { return n.dot(outward) > kSameNormal; });
      if (!known) at.push_back(outward);
    }
    result.mesh = std::move(mesh_);
    return result;
  }

 private:
  // New corners of borders, by the border's ends, the lower first; from there on.
  using Inserted = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>>;
  using Cell = std::array<std::int64_t, 3>;
  static Cell CellOf(const Vec3& p) {
    Cell cell;
    for (int i = 0; i < 3; ++i) {
      cell[static_cast<std::size_t>(i)] =
          static_cast<std::int64_t>(std::floor(p[i] / kSamePlace_m));
    }
    return cell;
  }

  // The position in this place: one known, or a new one.
  std::uint32_t PositionAt(const Vec3& p) {
    const Cell cell = CellOf(p);
    for (int i = 0; i < 27; ++i) {
      const Cell near = {cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1};
      const auto found = in_cell_.find(near);
      if (found != in_cell_.end() && (mesh_.positions[found->second] - p).norm() <= kSamePlace_m) {
        return found->second;
      }
    }
    const auto index = static_cast<std::uint32_t>(mesh_.positions.size());
    in_cell_.try_emplace(cell, index);
    mesh_.positions.push_back(p);
    return index;
  }

  void NoteNormal(std::uint32_t surface, std::uint32_t position, const Vec3& normal) {
    if (normal.squaredNorm() > 0.5) normals_.try_emplace({position, surface}, normal);
  }

  struct Border {
    std::uint32_t from, to, surface;
  };
  std::vector<Border> Borders() const {
    std::vector<Border> borders;
    const std::vector<HalfEdge> edges = SortedHalfEdges(mesh_);
    for (std::size_t i = 0; i < edges.size();) {
      std::size_t end = i + 1;
      while (end < edges.size() && edges[end].SameEdge(edges[i])) ++end;
      if (end == i + 1) {
        borders.push_back({edges[i].low, edges[i].high, mesh_.surfaces[edges[i].triangle]});
      }
      i = end;
    }
    return borders;
  }

  // Corners of other surfaces' borders that lie along a border, in order from its start.
  void SplitBorders() {
    const std::vector<Border> borders = Borders();
    Inserted inserted;
    for (const Border& border : borders) {
      std::map<double, std::uint32_t> along;
      for (const Border& other : borders) {
        if (other.surface == border.surface) continue;
        for (const std::uint32_t corner : {other.from, other.to}) {
          const double share = ShareOn(border, corner);
          if (share > 0) along.try_emplace(share, corner);
        }
      }
      for (const auto& [share, corner] : along) {
        inserted[{border.from, border.to}].push_back(corner);
        InterpolateNormal(border, share, corner);
      }
    }
    if (inserted.empty()) return;
    TriangleMesh whole = std::move(mesh_);
    mesh_ = {std::move(whole.positions), {}, {}};
    for (std::size_t i = 0; i < whole.triangles.size(); ++i) {
      AddSplit(whole.triangles[i], {true, true, true}, whole.surfaces[i], inserted);
    }
  }
  // Where along the border the corner lies, in (0, 1); 0 if it lies elsewhere.
  double ShareOn(const Border& border, std::uint32_t corner) const {
    if (corner == border.from || corner == border.to) return 0;
    const Vec3 &a = mesh_.positions[border.from], &b = mesh_.positions[border.to];
    const Vec3 along = b - a, d = mesh_.positions[corner] - a;
    const double share = d.dot(along) / along.squaredNorm();
    if (!(share > 0 && share < 1)) return 0;
    return (d - share * along).norm() <= tolerance_m_ ? share : 0;
  }
  void InterpolateNormal(const Border& border, double share, std::uint32_t corner) {
    const auto from = normals_.find({border.from, border.surface}),
               to = normals_.find({border.to, border.surface});
    if (from == normals_.end() || to == normals_.end()) return;
    const Vec3 normal = (1 - share) * from->second + share * to->second;
    NoteNormal(border.surface, corner, normal.normalized());
  }
  // The triangle, or a fan for each of its sides that was split. `whole` says which sides (the one
  // from corner k first) are still as they were: parts of a split one are not split again.
  void AddSplit(const Triangle& t, const std::array<bool, 3>& whole, std::uint32_t surface,
                const Inserted& inserted) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3], apex = t[(k + 2) % 3];
      const auto found = whole[k] ? inserted.find(std::minmax(a, b)) : inserted.end();
      if (found == inserted.end()) continue;
      std::vector<std::uint32_t> row = found->second;
      if (a > b) std::reverse(row.begin(), row.end());
      row.push_back(b);
      std::uint32_t from = a;
      for (const std::uint32_t to : row) {
        const std::array<bool, 3> sides = {from == a && whole[(k + 2) % 3], false,
                                           to == b && whole[(k + 1) % 3]};
        AddSplit({apex, std::exchange(from, to), to}, sides, surface, inserted);
      }
      return;
    }
    mesh_.triangles.push_back(t);
    mesh_.surfaces.push_back(surface);
  }

  // Turns triangles over so that neighbours run their common edge in opposite directions.
  void Orient() {
    flipped_.assign(surface_count_, false);
    const std::vector<HalfEdge> edges = SortedHalfEdges(mesh_);
    struct Neighbour {
      std::uint32_t triangle;
      bool opposed;  // the edge is run in opposite directions
    };
    std::vector<std::vector<Neighbour>> neighbours(mesh_.triangles.size());
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
      const HalfEdge &a = edges[i], &b = edges[i + 1];
      if (!a.SameEdge(b)) continue;
      neighbours[a.triangle].push_back({b.triangle, a.rises != b.rises});
      neighbours[b.triangle].push_back({a.triangle, a.rises != b.rises});
    }
    std::vector<int> turned(mesh_.triangles.size(), -1);
    for (std::uint32_t first = 0; first < turned.size(); ++first) {
      if (turned[first] >= 0) continue;
      turned[first] = 0;
      std::vector<std::uint32_t> open = {first};
      while (!open.empty()) {
        const std::uint32_t t = open.back();
        open.pop_back();
        for (const Neighbour& n : neighbours[t]) {
          if (turned[n.triangle] >= 0) continue;
          turned[n.triangle] = n.opposed ? turned[t] : 1 - turned[t];
          open.push_back(n.triangle);
        }
      }
    }
    for (std::size_t t = 0; t < turned.size(); ++t) {
      if (turned[t] == 0) continue;
      std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
      flipped_[mesh_.surfaces[t]] = true;
    }
  }

  double tolerance_m_;
  TriangleMesh mesh_;
  std::uint32_t surface_count_ = 0;
  std::map<Cell, std::uint32_t> in_cell_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Vec3> normals_;  // by position and surface
  std::vector<bool> flipped_;                                        // by surface
};

}  // namespace

Stitched Stitch(const std::vector<Mesh>& meshes, double tolerance_m) {
  Stitcher stitcher(std::max(tolerance_m, kSamePlace_m));
  for (const Mesh& mesh : meshes) stitcher.Add(mesh);
  return stitcher.Finish();
}

}  // namespace tranos::geom
