// SPDX-License-Identifier: GPL-3.0-or-later
// Facets between lines of constant parameter. All lines run right across, so cells meet corner to
// corner and there are no cracks. A line at a crease is two stations with one set of positions.
#include <algorithm>
#include <cmath>

#include "geom/curve_pieces.h"
#include "geom/facet_lines.h"

namespace tranos::geom {
namespace {

constexpr double kMaxTriangles = 1e7;
constexpr std::uint32_t kNone = 0xffffffffu;
constexpr int kMaxRefinements = 12;

// A line as seen from the cells on one side (or both) of it.
struct Station {
  int line, span;
  double local;
  double inward;  // +1 if the cells lie towards larger parameters
};

// Lines of one direction with their stations: a cell between lines a and a + 1 reaches from
// after[a] to before[a + 1].
struct Lattice {
  std::vector<FacetLine> lines;
  std::vector<Station> stations;
  std::vector<int> before, after;
  bool closed = false;
  int cells() const { return static_cast<int>(lines.size()) - 1; }
};

Lattice LatticeOf(const Direction& direction, const std::vector<double>& counts) {
  Lattice lattice;
  lattice.lines = LinesOf(direction, counts);
  lattice.closed = direction.closed;
  const int last = lattice.cells();
  lattice.before.assign(last + 1, 0);
  lattice.after.assign(last + 1, 0);
  auto add = [&](const Station& station) {
    lattice.stations.push_back(station);
    return static_cast<int>(lattice.stations.size()) - 1;
  };
  for (int a = 0; a < last; ++a) {
    const FacetLine& line = lattice.lines[a];
    const bool doubled = line.crease && a > 0;
    if (doubled) lattice.before[a] = add({a, line.span - 1, 1, -1});
    lattice.after[a] = add({a, line.span, line.local, 1});
    if (!doubled) lattice.before[a] = lattice.after[a];
  }
  const bool welded = lattice.closed && !lattice.lines[last].crease;
  lattice.before[last] = welded ? lattice.after[0] : add({last, lattice.lines[last].span, 1, -1});
  return lattice;
}

// The parameter halfway between two neighbouring lines, as a span and a place in it.
std::pair<int, double> Halfway(const std::vector<double>& breaks, const FacetLine& a,
                               const FacetLine& b) {
  auto natural = [&](const FacetLine& l) {
    return breaks[l.span] + l.local * (breaks[l.span + 1] - breaks[l.span]);
  };
  const double t = 0.5 * (natural(a) + natural(b));
  int span = a.span;
  while (span < b.span && t > breaks[span + 1]) ++span;
  return {span, std::clamp((t - breaks[span]) / (breaks[span + 1] - breaks[span]), 0.0, 1.0)};
}

double DistanceToTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a);
  const bool inside = n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 &&
                      n.dot((a - c).cross(p - c)) >= 0;
  if (inside && n.squaredNorm() > 0) return std::abs(n.dot(p - a)) / n.norm();
  return std::min({NearestOn(Line{a, b}, p).distance_m, NearestOn(Line{b, c}, p).distance_m,
                   NearestOn(Line{c, a}, p).distance_m});
}

// The sine of the triangle's smaller angle at its longest sides, 0 for a degenerate one.
double Fatness(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return longest > 0 ? (b - a).cross(c - a).norm() / longest : 0;
}

class SurfaceFacets {
 public:
  SurfaceFacets(const PatchGrid& grid, Lattice u, Lattice v)
      : grid_(grid), u_(std::move(u)), v_(std::move(v)) {
    Place();
    collapsed_u_ = Collapse(u_, v_, [&](int a, int b) -> Vec3& { return At(a, b); });
    collapsed_v_ = Collapse(v_, u_, [&](int b, int a) -> Vec3& { return At(a, b); });
  }

  // The largest distance of the surface from its facets, at the cells' centres and borders.
  double Deviation() const {
    double deviation_m = 0;
    for (int a = 0; a < u_.cells(); ++a) {
      const auto [i, s] = Halfway(grid_.breaks_u, u_.lines[a], u_.lines[a + 1]);
      for (int b = 0; b < v_.cells(); ++b) {
        const auto [j, t] = Halfway(grid_.breaks_v, v_.lines[b], v_.lines[b + 1]);
        deviation_m = std::max(deviation_m, DistanceToCell(PointOf(grid_.at(i, j), s, t), a, b));
        const FacetLine &lu = u_.lines[a], &lv = v_.lines[b];
        deviation_m =
            std::max({deviation_m, DistanceToCell(PointOf(grid_.at(lu.span, j), lu.local, t), a, b),
                      DistanceToCell(PointOf(grid_.at(i, lv.span), s, lv.local), a, b)});
      }
    }
    return deviation_m;
  }

  // Below this, distances between coordinates of this size say nothing.
  double rounding_m() const {
    double largest = 0;
    for (const Vec3& p : positions_) largest = std::max(largest, p.cwiseAbs().maxCoeff());
    return 1e-14 * largest;
  }

  Mesh Build() {
    ids_.assign(u_.stations.size() * v_.stations.size(), kNone);
    smooth_u_ = SmoothCollapses(u_, v_, collapsed_u_, true);
    smooth_v_ = SmoothCollapses(v_, u_, collapsed_v_, false);
    for (int a = 0; a < u_.cells(); ++a) {
      for (int b = 0; b < v_.cells(); ++b) AddCell(a, b);
    }
    FillMissingNormals();
    return std::move(mesh_);
  }

 private:
  Vec3& At(int a, int b) { return positions_[static_cast<std::size_t>(a) * v_.lines.size() + b]; }
  const Vec3& At(int a, int b) const {
    return positions_[static_cast<std::size_t>(a) * v_.lines.size() + b];
  }

  void Place() {
    positions_.resize(u_.lines.size() * v_.lines.size());
    for (int a = 0; a <= u_.cells(); ++a) {
      for (int b = 0; b <= v_.cells(); ++b) {
        const FacetLine &lu = u_.lines[a], &lv = v_.lines[b];
        At(a, b) = PointOf(grid_.at(lu.span, lv.span), lu.local, lv.local);
      }
    }
    for (int b = 0; u_.closed && b <= v_.cells(); ++b) At(u_.cells(), b) = At(0, b);
    for (int a = 0; v_.closed && a <= u_.cells(); ++a) At(a, v_.cells()) = At(a, 0);
  }

  // Lines all of whose points are one, such as a pole of a sphere; made one to the bit.
  template <class Access>
  std::vector<bool> Collapse(const Lattice& along, const Lattice& across, const Access& at) {
    std::vector<bool> collapsed(along.lines.size(), false);
    for (int a = 0; a <= along.cells(); ++a) {
      const Vec3 first = at(a, 0);
      const double rounding_m = 1e-14 * (1 + first.cwiseAbs().maxCoeff());
      double spread_m = 0;
      for (int b = 1; b <= across.cells(); ++b) {
        spread_m = std::max(spread_m, (at(a, b) - first).norm());
      }
      if (spread_m > 100 * rounding_m) continue;
      collapsed[a] = true;
      for (int b = 1; b <= across.cells(); ++b) at(a, b) = first;
    }
    return collapsed;
  }

  Vec3 NormalAtStations(const Station& su, const Station& sv) const {
    return LimitNormal(grid_.at(su.span, sv.span), su.local, sv.local, {su.inward, sv.inward});
  }

  // Of each station on a collapsed line: whether the surface is smooth there, as at a sphere's
  // pole but not at a cone's apex.
  std::vector<bool> SmoothCollapses(const Lattice& along, const Lattice& across,
                                    const std::vector<bool>& collapsed, bool along_u) const {
    std::vector<bool> smooth(along.stations.size(), false);
    for (std::size_t k = 0; k < along.stations.size(); ++k) {
      const Station& station = along.stations[k];
      if (!collapsed[station.line]) continue;
      Vec3 first = Vec3::Zero();
      bool same = true;
      for (const Station& other : across.stations) {
        const Vec3 normal =
            along_u ? NormalAtStations(station, other) : NormalAtStations(other, station);
        if (first.isZero()) first = normal;
        same = same && AngleBetween(first, normal) <= kCrease_rad;
      }
      smooth[k] = same;
    }
    return smooth;
  }

  std::uint32_t Push(const Vec3& position, const Vec3& normal) {
    mesh_.positions.push_back(position);
    mesh_.normals.push_back(normal);
    return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
  }

  // The vertex at two stations as the cell (a, b) sees it. Where a line is collapsed and not
  // smooth, each cell has a vertex of its own, with the normal of its middle.
  std::uint32_t Vertex(int ku, int kv, int a, int b) {
    const Station &su = u_.stations[ku], &sv = v_.stations[kv];
    const Vec3& position = At(su.line, sv.line);
    if (collapsed_v_[sv.line] && !smooth_v_[kv]) {
      const auto [i, s] = Halfway(grid_.breaks_u, u_.lines[a], u_.lines[a + 1]);
      return Push(position, LimitNormal(grid_.at(i, sv.span), s, sv.local, {0, sv.inward}));
    }
    if (collapsed_u_[su.line] && !smooth_u_[ku]) {
      const auto [j, t] = Halfway(grid_.breaks_v, v_.lines[b], v_.lines[b + 1]);
      return Push(position, LimitNormal(grid_.at(su.span, j), su.local, t, {su.inward, 0}));
    }
    const std::size_t row = collapsed_v_[sv.line] ? 0 : static_cast<std::size_t>(ku);
    const std::size_t column = collapsed_u_[su.line] ? 0 : static_cast<std::size_t>(kv);
    std::uint32_t& id = ids_[row * v_.stations.size() + column];
    if (id == kNone) id = Push(position, NormalAtStations(su, sv));
    return id;
  }

  // The diagonal whose thinner triangle is the fatter one; the first if they are alike.
  bool SecondDiagonal(int a, int b) const {
    const Vec3 &p = At(a, b), &q = At(a + 1, b), &r = At(a + 1, b + 1), &s = At(a, b + 1);
    const double first = std::min(Fatness(p, q, r), Fatness(p, r, s));
    const double second = std::min(Fatness(p, q, s), Fatness(q, r, s));
    return second > first * (1 + 1e-6) && second > 1e-9;
  }

  double DistanceToCell(const Vec3& x, int a, int b) const {
    const Vec3 &p = At(a, b), &q = At(a + 1, b), &r = At(a + 1, b + 1), &s = At(a, b + 1);
    return SecondDiagonal(a, b)
               ? std::min(DistanceToTriangle(x, p, q, s), DistanceToTriangle(x, q, r, s))
               : std::min(DistanceToTriangle(x, p, q, r), DistanceToTriangle(x, p, r, s));
  }

  void AddTriangle(std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const auto& at = mesh_.positions;
    if (Fatness(at[i], at[j], at[k]) > 1e-12) mesh_.triangles.push_back({i, j, k});
  }

  void AddCell(int a, int b) {
    const int u0 = u_.after[a], u1 = u_.before[a + 1], v0 = v_.after[b], v1 = v_.before[b + 1];
    // Corners on a collapsed line are one vertex.
    const std::uint32_t p = Vertex(u0, v0, a, b);
    const std::uint32_t q = collapsed_v_[b] ? p : Vertex(u1, v0, a, b);
    const std::uint32_t s = collapsed_u_[a] ? p : Vertex(u0, v1, a, b);
    const std::uint32_t r = collapsed_v_[b + 1]   ? s
                            : collapsed_u_[a + 1] ? q
                                                  : Vertex(u1, v1, a, b);
    if (SecondDiagonal(a, b)) {
      AddTriangle(p, q, s);
      AddTriangle(q, r, s);
    } else {
      AddTriangle(p, q, r);
      AddTriangle(p, r, s);
    }
    const bool first_u = a == 0 && !u_.closed, last_u = a + 1 == u_.cells() && !u_.closed;
    const bool first_v = b == 0 && !v_.closed, last_v = b + 1 == v_.cells() && !v_.closed;
    if (first_u || (u_.lines[a].crease && BrokenAcrossU(a, b))) AddEdge(p, s);
    if (last_u) AddEdge(q, r);
    if (first_v || (v_.lines[b].crease && BrokenAcrossV(a, b))) AddEdge(p, q);
    if (last_v) AddEdge(s, r);
  }

  void AddEdge(std::uint32_t i, std::uint32_t j) {
    if (mesh_.positions[i] != mesh_.positions[j]) mesh_.edges.push_back({i, j});
  }

  // Whether the tangent plane breaks on the piece of line a (of line b) beside the cell.
  bool BrokenAcrossU(int a, int b) const {
    const auto [j, t] = Halfway(grid_.breaks_v, v_.lines[b], v_.lines[b + 1]);
    const int after = u_.lines[a].span, before = a == 0 ? grid_.count_u() - 1 : after - 1;
    return AngleBetween(LimitNormal(grid_.at(before, j), 1, t, {-1, 0}),
                        LimitNormal(grid_.at(after, j), 0, t, {1, 0})) > kCrease_rad;
  }
  bool BrokenAcrossV(int a, int b) const {
    const auto [i, s] = Halfway(grid_.breaks_u, u_.lines[a], u_.lines[a + 1]);
    const int after = v_.lines[b].span, before = b == 0 ? grid_.count_v() - 1 : after - 1;
    return AngleBetween(LimitNormal(grid_.at(i, before), s, 1, {0, -1}),
                        LimitNormal(grid_.at(i, after), s, 0, {0, 1})) > kCrease_rad;
  }

  // Where the surface has no limit normal, that of the facets around.
  void FillMissingNormals() {
    std::vector<Vec3> sums;
    for (const auto& triangle : mesh_.triangles) {
      for (const std::uint32_t k : triangle) {
        if (!mesh_.normals[k].isZero()) continue;
        if (sums.empty()) sums.assign(mesh_.normals.size(), Vec3::Zero());
        const Vec3 &a = mesh_.positions[triangle[0]], &b = mesh_.positions[triangle[1]];
        sums[k] += (b - a).cross(mesh_.positions[triangle[2]] - a);
      }
    }
    for (std::size_t k = 0; k < mesh_.normals.size(); ++k) {
      if (!mesh_.normals[k].isZero()) continue;
      const bool known = !sums.empty() && sums[k].norm() > 0;
      mesh_.normals[k] = known ? Vec3(sums[k].normalized()) : Vec3::UnitZ();
    }
  }

  const PatchGrid& grid_;
  Lattice u_, v_;
  std::vector<Vec3> positions_;
  std::vector<bool> collapsed_u_, collapsed_v_, smooth_u_, smooth_v_;
  std::vector<std::uint32_t> ids_;
  Mesh mesh_;
};

double Total(const std::vector<double>& counts) {
  double total = 0;
  for (const double count : counts) total += count;
  return total;
}

bool IsCurved(const Direction& direction) {
  return std::any_of(direction.groups.begin(), direction.groups.end(),
                     [](const SpanGroup& g) { return g.kind != SpanGroup::Kind::kStraight; });
}

// How far a straight span's direction turns from one side of its patch to the other: what a
// saddle needs when facets are counted per turn.
double LargestTwist(const PatchGrid& grid) {
  double twist_rad = 0;
  for (const BezierPatch& patch : grid.patches) {
    const auto last = patch.rows[0].cols() - 1;
    auto leg = [&](Eigen::Index j) -> Vec3 {
      return Projected(patch.rows.back().col(j)) - Projected(patch.rows.front().col(j));
    };
    const Vec3 low = leg(0), high = leg(last);
    if (low.norm() > 0 && high.norm() > 0) twist_rad = std::max(twist_rad, AngleBetween(low, high));
  }
  return twist_rad;
}

}  // namespace

Result<Mesh> Tessellate(const Surface& surface, const Tolerance& tolerance) {
  if (auto checked = Check(tolerance); !checked) return tl::unexpected(checked.error());
  if (auto checked = Check(surface); !checked) return tl::unexpected(checked.error());
  const PatchGrid grid = PatchesOf(surface);
  const Direction u = DirectionAlongU(grid), v = DirectionAlongU(Exchanged(grid));
  const bool by_turn = tolerance.facets_per_turn > 0;
  Tolerance share = tolerance;
  // Deviations along u and v add up, so each has half where both directions are curved.
  if (IsCurved(u) && IsCurved(v)) share.chord_m *= 0.5;
  double factor = 1;
  if (by_turn && !IsCurved(u) && !IsCurved(v))
    factor = TurningFacets(LargestTwist(grid), tolerance);
  for (int attempt = 0;; ++attempt) {
    const std::vector<double> counts_u = FacetCounts(u, share, factor);
    const std::vector<double> counts_v = FacetCounts(v, share, factor);
    if (!(2 * Total(counts_u) * Total(counts_v) <= kMaxTriangles)) {
      return tl::unexpected(
          Error{ErrorCode::kTooLarge, "the tolerance asks for more than ten million facets"});
    }
    SurfaceFacets facets(grid, LatticeOf(u, counts_u), LatticeOf(v, counts_v));
    const double deviation_m = by_turn ? 0 : facets.Deviation();
    if (deviation_m <= std::max(tolerance.chord_m, facets.rounding_m())) return facets.Build();
    if (attempt == kMaxRefinements) {
      return tl::unexpected(
          Error{ErrorCode::kTooLarge, "no number of facets comes within the tolerance"});
    }
    // The deviation falls with the square of the count.
    factor *= std::clamp(1.05 * std::sqrt(deviation_m / tolerance.chord_m), 1.2, 1e9);
  }
}

}  // namespace tranos::geom
