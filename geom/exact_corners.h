// SPDX-License-Identifier: GPL-3.0-or-later
// Corners of triangles, exactly: those that are given as doubles, and those that are made where
// facets cross. Internal to the files that are exact; the one header that lets CGAL in.
#pragma once

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <array>
#include <cmath>
#include <unordered_map>
#include <vector>

#include "geom/arrangement.h"

namespace tranos::geom {

using Kernel = CGAL::Epeck;
using Point = Kernel::Point_3;
using Point2 = Kernel::Point_2;
using Predicates = CGAL::Epick;  // exact on doubles

inline constexpr std::uint32_t kNoCorner = 0xffffffff;
using Corners = std::array<std::uint32_t, 3>;

inline Predicates::Point_3 Plain(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

// 1 if d is on the side from which a, b, c run anticlockwise.
inline int SideOf(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return CGAL::orientation(Plain(a), Plain(b), Plain(c), Plain(d));
}

// The two coordinates that are left when a plane is looked at along an axis.
struct Projection {
  int u = 0, v = 1;
  static Projection Along(int axis) { return {(axis + 1) % 3, (axis + 2) % 3}; }
  int Turn(const Vec3& a, const Vec3& b, const Vec3& c) const {
    return CGAL::orientation(Predicates::Point_2(a[u], a[v]), Predicates::Point_2(b[u], b[v]),
                             Predicates::Point_2(c[u], c[v]));
  }
};

struct Triangle {
  Vec3 a, b, c;
  Vec3 operator[](int i) const { return i == 0 ? a : i == 1 ? b : c; }
};
inline Triangle TriangleOf(const Soup& soup, std::uint32_t facet) {
  const Corners& t = soup.facets[facet].corners;
  return {soup.positions[t[0]], soup.positions[t[1]], soup.positions[t[2]]};
}
inline Vec3 AreaVector(const Triangle& t) { return (t.b - t.a).cross(t.c - t.a); }

// A projection in which the triangle is not seen edge-on.
inline Projection ProjectionOf(const Triangle& t) {
  int axis = 0;
  AreaVector(t).cwiseAbs().maxCoeff(&axis);
  for (int i = 0; i < 3; ++i) {
    const Projection projection = Projection::Along((axis + i) % 3);
    if (projection.Turn(t.a, t.b, t.c) != 0) return projection;
  }
  return Projection::Along(axis);
}

// Corners that were made, beside those that were given; equal ones are one.
class CornerTable {
 public:
  explicit CornerTable(const std::vector<Vec3>& given) : given_(given) {
    cells_.reserve(given.size());
    for (std::uint32_t i = 0; i < given.size(); ++i) Enter(given[i], i);
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(given_.size() + made_.size()); }
  Point At(std::uint32_t corner) const {
    if (corner >= given_.size()) return made_[corner - given_.size()];
    const Vec3& p = given_[corner];
    return {p.x(), p.y(), p.z()};
  }
  Vec3 Rounded(std::uint32_t corner) const {
    if (corner < given_.size()) return given_[corner];
    const auto& p = made_[corner - given_.size()].exact();
    return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
  }

  bool IsRounded(std::uint32_t corner) const {
    if (corner < given_.size()) return false;
    const Vec3 r = Rounded(corner);
    const auto& p = made_[corner - given_.size()].exact();
    return p.x() != r.x() || p.y() != r.y() || p.z() != r.z();
  }
  // Near enough to compare sizes.
  Vec3 Near(std::uint32_t corner) const {
    if (corner < given_.size()) return given_[corner];
    return Middle(made_[corner - given_.size()]);
  }

  // The corner at `p`, a new one if there is none.
  std::uint32_t Of(const Point& p) {
    const Vec3 middle = Middle(p);
    for (const Cell& cell : CellsAround(middle)) {
      const auto [begin, end] = cells_.equal_range(KeyOf(cell));
      for (auto at = begin; at != end; ++at) {
        if (At(at->second) == p) return at->second;
      }
    }
    made_.push_back(p);
    Enter(middle, size() - 1);
    return size() - 1;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  static constexpr double kCell_m = 1e-4;
  // An approximation is nearer than this to what it approximates, or is made so.
  static constexpr double kNear_m = 1e-6;

  static Vec3 Middle(const Point& p) {
    auto a = p.approx();
    const auto is_wide = [](const auto& i) { return !(i.sup() - i.inf() < kNear_m); };
    if (is_wide(a.x()) || is_wide(a.y()) || is_wide(a.z())) {
      p.exact();
      a = p.approx();
    }
    const auto middle = [](const auto& i) { return 0.5 * (i.inf() + i.sup()); };
    return {middle(a.x()), middle(a.y()), middle(a.z())};
  }
  static std::int64_t Floor(double x) { return static_cast<std::int64_t>(std::floor(x / kCell_m)); }
  // The cell of p, and those that points nearer than twice kNear_m may lie in.
  static std::vector<Cell> CellsAround(const Vec3& p) {
    std::vector<Cell> cells{{}};
    for (int k = 0; k < 3; ++k) {
      const std::int64_t low = Floor(p[k] - 2 * kNear_m), high = Floor(p[k] + 2 * kNear_m);
      const std::size_t count = cells.size();
      for (std::size_t i = 0; i < count; ++i) {
        cells[i][k] = low;
        if (high == low) continue;
        cells.push_back(cells[i]);
        cells.back()[k] = high;
      }
    }
    return cells;
  }
  static std::uint64_t KeyOf(const Cell& c) {
    std::uint64_t key = 0;
    for (const std::int64_t i : c) {
      key = (key ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15u;
      key ^= key >> 29;
    }
    return key;
  }
  void Enter(const Vec3& p, std::uint32_t corner) {
    cells_.emplace(KeyOf({Floor(p.x()), Floor(p.y()), Floor(p.z())}), corner);
  }

  const std::vector<Vec3>& given_;
  std::vector<Point> made_;
  std::unordered_multimap<std::uint64_t, std::uint32_t> cells_;
};

}  // namespace tranos::geom
