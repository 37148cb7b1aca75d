// SPDX-License-Identifier: GPL-3.0-or-later
// Corners of triangles, exactly: those that are given as doubles, and those that are made where
// facets cross. Internal to the files that are exact; the one header that lets CGAL in.
#pragma once

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <array>
#include <bit>
#include <optional>
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
    numbers_.reserve(given.size());
    for (std::uint32_t i = 0; i < given.size(); ++i) Enter(given[i], i);
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(given_.size() + made_.size()); }
  Point At(std::uint32_t corner) const {
    if (const auto p = Plain(corner)) return {p->x(), p->y(), p->z()};
    return made_[corner - given_.size()].exact;
  }
  // The place, where it can be said in doubles; nothing for the others.
  std::optional<Vec3> Plain(std::uint32_t corner) const {
    if (corner < given_.size()) return given_[corner];
    const Made& made = made_[corner - given_.size()];
    if (!made.is_plain) return std::nullopt;
    return made.rounded;
  }
  Vec3 Rounded(std::uint32_t corner) const {
    return corner < given_.size() ? given_[corner] : made_[corner - given_.size()].rounded;
  }
  bool IsRounded(std::uint32_t corner) const { return !Plain(corner); }

  // The corner at `p`, a new one if there is none.
  std::uint32_t Of(const Point& p) {
    const auto& exact = p.exact();
    const Vec3 rounded(CGAL::to_double(exact.x()), CGAL::to_double(exact.y()),
                       CGAL::to_double(exact.z()));
    const bool is_plain =
        exact.x() == rounded.x() && exact.y() == rounded.y() && exact.z() == rounded.z();
    const auto [begin, end] = numbers_.equal_range(rounded);
    for (auto at = begin; at != end; ++at) {
      if (IsRounded(at->second) == is_plain) continue;
      if (is_plain || At(at->second) == p) return at->second;
    }
    made_.push_back({p, rounded, is_plain});
    Enter(rounded, size() - 1);
    return size() - 1;
  }

 private:
  struct Made {
    Point exact;
    Vec3 rounded;
    bool is_plain;
  };
  struct Hash {
    std::size_t operator()(const Vec3& p) const {
      std::uint64_t key = 0;
      for (const double x : p) {
        key = (key ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15u;  // −0 is 0
        key ^= key >> 29;
      }
      return key;
    }
  };
  void Enter(const Vec3& p, std::uint32_t corner) { numbers_.emplace(p, corner); }

  const std::vector<Vec3>& given_;
  std::vector<Made> made_;
  // By what they are when rounded, which is the same for equal ones.
  std::unordered_multimap<Vec3, std::uint32_t, Hash> numbers_;
};

}  // namespace tranos::geom
