// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/mesh_section.h"

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "geom/skin.h"

namespace tranos::geom {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;  // the lower index first

// Corners in a straight line, and those in one place, add nothing.
void Simplify(Polyline* line) {
  std::vector<Vec3> kept;
  const std::vector<Vec3>& all = line->vertices;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!kept.empty() && (all[i] - kept.back()).norm() <= kCoincident_m) continue;
    kept.push_back(all[i]);
  }
  if (line->closed && kept.size() > 1 && (kept.front() - kept.back()).norm() <= kCoincident_m) {
    kept.pop_back();
  }
  std::vector<Vec3> corners;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const bool end = !line->closed && (i == 0 || i + 1 == kept.size());
    const Vec3 before = kept[i] - kept[(i + kept.size() - 1) % kept.size()],
               after = kept[(i + 1) % kept.size()] - kept[i];
    const bool straight = before.cross(after).norm() <= 1e-9 * before.norm() * after.norm();
    if (end || !straight) corners.push_back(kept[i]);
  }
  line->vertices = std::move(corners);
}

class Section {
 public:
  Section(const TriangleMesh& mesh, const Frame& plane) : mesh_(mesh), plane_(plane) {
    for (const Vec3& p : mesh.positions) heights_m_.push_back(plane.ToLocal(p).z());
    for (const auto& triangle : mesh.triangles) AddTriangle(triangle);
  }

  std::vector<Polyline> Lines() {
    std::vector<Polyline> lines;
    // Open lines begin at an edge to which no other leads.
    std::set<Edge> reached;
    for (const auto& [from, to] : next_) reached.insert(to);
    std::vector<Edge> starts;
    for (const auto& [from, to] : next_) {
      if (!reached.contains(from)) starts.push_back(from);
    }
    for (const Edge& start : starts) AddLine(start, &lines);
    while (!next_.empty()) AddLine(next_.begin()->first, &lines);
    return lines;
  }

 private:
  bool IsAbove(std::uint32_t corner) const { return heights_m_[corner] >= -kCoincident_m; }
  // The cut through a triangle runs from the edge that goes down to the one that goes up.
  void AddTriangle(const std::array<std::uint32_t, 3>& t) {
    Edge from, to;
    bool cut = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (IsAbove(a) == IsAbove(b)) continue;
      cut = true;
      (IsAbove(a) ? from : to) = std::minmax(a, b);
    }
    if (cut) next_.emplace(from, to);
  }
  Vec3 PointOn(const Edge& edge) const {
    const double a = heights_m_[edge.first], b = heights_m_[edge.second];
    const double share = std::abs(a) <= kCoincident_m   ? 0
                         : std::abs(b) <= kCoincident_m ? 1
                                                        : a / (a - b);
    return mesh_.positions[edge.first] +
           share * (mesh_.positions[edge.second] - mesh_.positions[edge.first]);
  }
  void AddLine(Edge at, std::vector<Polyline>* lines) {
    Polyline line;
    const Edge start = at;
    line.vertices.push_back(PointOn(at));
    for (auto found = next_.find(at); found != next_.end(); found = next_.find(at)) {
      at = found->second;
      next_.erase(found);
      if (at != start) line.vertices.push_back(PointOn(at));
    }
    line.closed = at == start;
    Simplify(&line);
    if (line.vertices.size() >= (line.closed ? 3u : 2u)) lines->push_back(std::move(line));
  }

  const TriangleMesh& mesh_;
  const Frame& plane_;
  std::vector<double> heights_m_;
  std::multimap<Edge, Edge> next_;
};

}  // namespace

std::vector<Polyline> SectionOf(const TriangleMesh& mesh, const Frame& plane) {
  return Section(mesh, plane).Lines();
}

Result<std::vector<Polyline>> SectionOf(const Surface& surface, const Frame& plane,
                                        const Tolerance& tolerance) {
  const Result<Mesh> mesh = Tessellate(surface, tolerance);
  if (!mesh) return tl::unexpected(mesh.error());
  const TriangleMesh facets = {mesh->positions, mesh->triangles,
                               std::vector<std::uint32_t>(mesh->triangles.size())};
  return SectionOf(Welded(facets), plane);
}

}  // namespace tranos::geom
