// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/facet_crossing.h"

#include <limits>

namespace tranos::geom {

namespace {

constexpr double kHuge = 1e300;

// Whether two triangles of one plane have a point in common; with `inside`, an inner one.
bool MeetInPlane(const Triangle& s, const Triangle& t, bool inside) {
  const Projection projection = ProjectionOf(s);
  const auto is_apart = [&](const Triangle& from, const Triangle& other) {
    const int turn = projection.Turn(from.a, from.b, from.c);
    for (int i = 0; i < 3; ++i) {
      const Vec3 p = from[i], q = from[(i + 1) % 3];
      bool all_out = true;
      for (int k = 0; k < 3 && all_out; ++k) {
        const int side = turn * projection.Turn(p, q, other[k]);
        all_out = inside ? side <= 0 : side < 0;
      }
      if (all_out) return true;
    }
    return false;
  };
  return !is_apart(s, t) && !is_apart(t, s);
}

bool AreApart(const std::array<int, 3>& s) {
  return (s[0] > 0 && s[1] > 0 && s[2] > 0) || (s[0] < 0 && s[1] < 0 && s[2] < 0);
}
std::array<int, 3> Sides(const Corners& ids, const Triangle& t, const Corners& plane_ids,
                         const Triangle& plane) {
  std::array<int, 3> sides;
  for (int i = 0; i < 3; ++i) {
    const bool on = std::find(plane_ids.begin(), plane_ids.end(), ids[i]) != plane_ids.end();
    sides[i] = on ? 0 : SideOf(plane.a, plane.b, plane.c, t[i]);
  }
  return sides;
}
int SharedCorners(const Corners& a, const Corners& b) {
  int count = 0;
  for (const std::uint32_t i : a) count += static_cast<int>(std::count(b.begin(), b.end(), i));
  return count;
}

// A stretch of the line in which two planes cross, along one of the axes, and how far its ends
// may be off.
struct Stretch {
  double low = std::numeric_limits<double>::infinity(), high = -low, error = 0;
  void Add(double x, double x_error) {
    low = std::min(low, x), high = std::max(high, x), error = std::max(error, x_error);
  }
};
struct Sided {
  const Triangle& triangle;
  const Corners& ids;
  const std::array<int, 3>& sides;
};
Stretch StretchOf(const Sided& of, const Vec3& plane_point, const Vec3& normal, int axis) {
  constexpr double kRounding = 1e-14;
  std::array<double, 3> height;
  double size = plane_point.cwiseAbs().maxCoeff();
  for (int i = 0; i < 3; ++i) {
    height[i] = normal.dot(of.triangle[i] - plane_point);
    size = std::max(size, of.triangle[i].cwiseAbs().maxCoeff());
  }
  Stretch stretch;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const double from = of.triangle[i][axis], along = of.triangle[j][axis] - from;
    if (of.sides[i] == 0) stretch.Add(from, 0);
    if (of.sides[i] * of.sides[j] >= 0) continue;
    const double fall = height[i] - height[j];
    const double error = kRounding * size * (1 + 4 * std::abs(along / fall));
    stretch.Add(from + along * std::clamp(height[i] / fall, 0.0, 1.0),
                error < kHuge ? error : kHuge);
  }
  return stretch;
}
Vec3 SharedCorner(const Sided& s, const Sided& t) {
  for (int i = 0; i < 3; ++i) {
    if (std::find(t.ids.begin(), t.ids.end(), s.ids[i]) != t.ids.end()) return s.triangle[i];
  }
  return s.triangle.a;
}

// Most facets whose planes cross both are still apart, and doubles tell, with bounds for their
// errors; or they have one corner in common and lie on different sides of it.
bool AreSurelyApart(const Sided& s, const Sided& t, int shared) {
  const Vec3 sn = AreaVector(s.triangle).normalized(), tn = AreaVector(t.triangle).normalized();
  int axis = 0;
  sn.cross(tn).cwiseAbs().maxCoeff(&axis);
  const Stretch p = StretchOf(s, t.triangle.a, tn, axis), q = StretchOf(t, s.triangle.a, sn, axis);
  const double error = p.error + q.error;
  if (shared == 0) return p.low > q.high + error || q.low > p.high + error;
  const double at = SharedCorner(s, t)[axis];
  const auto above = [&](const Stretch& x) { return x.high - at > error; };
  const auto below = [&](const Stretch& x) { return at - x.low > error; };
  if (above(p) == below(p) || above(q) == below(q)) return false;
  return above(p) != above(q);
}

// Whether p lies so near to the triangle's inside, but not in its plane.
bool MissesNarrowly(const Vec3& p, const Triangle& t) {
  const Vec3 normal = AreaVector(t);
  const double height = normal.dot(p - t.a);
  if (!(height * height <= kCoincident_m * kCoincident_m * normal.squaredNorm())) return false;
  for (int i = 0; i < 3; ++i) {
    if (normal.dot((t[(i + 1) % 3] - t[i]).cross(p - t[i])) < 0) return false;
  }
  return SideOf(t.a, t.b, t.c, p) != 0;
}

// Whether p, which lies in the triangle's plane, lies in the triangle.
bool IsIn(const Triangle& t, const Vec3& p) {
  const Projection projection = ProjectionOf(t);
  const int turn = projection.Turn(t.a, t.b, t.c);
  for (int i = 0; i < 3; ++i) {
    if (turn * projection.Turn(t[i], t[(i + 1) % 3], p) < 0) return false;
  }
  return true;
}
// Whether the segment, whose ends lie on different sides of the triangle's plane, goes through it.
bool Pierces(const Vec3& from, const Vec3& to, const Triangle& t) {
  const std::array<int, 3> turns = {SideOf(from, to, t.a, t.b), SideOf(from, to, t.b, t.c),
                                    SideOf(from, to, t.c, t.a)};
  const auto [least, most] = std::minmax_element(turns.begin(), turns.end());
  return *least >= 0 || *most <= 0;
}
// Whether an edge or a corner of the one lies in or goes through the other; not a common corner. Of
// triangles in two planes one of them does so to the other, if they meet at all.
bool EdgesMeet(const Sided& of, const Sided& other) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (of.sides[i] * of.sides[j] < 0) {
      if (Pierces(of.triangle[i], of.triangle[j], other.triangle)) return true;
    } else if (of.sides[i] == 0) {
      const bool is_common =
          std::find(other.ids.begin(), other.ids.end(), of.ids[i]) != other.ids.end();
      if (!is_common && IsIn(other.triangle, of.triangle[i])) return true;
    }
  }
  return false;
}

// Whether the facets, of one mesh, meet other than in common corners and edges.
bool Meet(const Soup& soup, std::uint32_t s, std::uint32_t t) {
  const Corners &sc = soup.facets[s].corners, &tc = soup.facets[t].corners;
  const Triangle st = TriangleOf(soup, s), tt = TriangleOf(soup, t);
  const std::array<int, 3> s_sides = Sides(sc, st, tc, tt);
  if (AreApart(s_sides)) return false;
  if (s_sides == std::array{0, 0, 0}) return MeetInPlane(st, tt, true);
  const std::array<int, 3> t_sides = Sides(tc, tt, sc, st);
  if (AreApart(t_sides)) return false;
  const int shared = SharedCorners(sc, tc);
  const Sided sided_s{st, sc, s_sides}, sided_t{tt, tc, t_sides};
  if (shared >= 2 || AreSurelyApart(sided_s, sided_t, shared)) return false;
  return EdgesMeet(sided_s, sided_t) || EdgesMeet(sided_t, sided_s);
}

CGAL::Comparison_result CompareAlong(const Point& p, const Point& q, int axis) {
  if (axis == 0) return CGAL::compare_x(p, q);
  return axis == 1 ? CGAL::compare_y(p, q) : CGAL::compare_z(p, q);
}

}  // namespace

CrossingFinder::Meeting CrossingFinder::Meet(std::uint32_t s, std::uint32_t t, std::uint32_t* from,
                                             std::uint32_t* to) {
  const Corners &sc = soup_.facets[s].corners, &tc = soup_.facets[t].corners;
  const Triangle st = TriangleOf(soup_, s), tt = TriangleOf(soup_, t);
  const std::array<int, 3> s_sides = Sides(sc, st, tc, tt), t_sides = Sides(tc, tt, sc, st);
  if (AreApart(s_sides) || AreApart(t_sides)) return Meeting::kApart;
  const int shared = SharedCorners(sc, tc);
  if (s_sides == std::array{0, 0, 0}) {
    const bool inside = shared >= 2 || soup_.facets[s].mesh == soup_.facets[t].mesh;
    return MeetInPlane(st, tt, inside) ? Meeting::kInPlane : Meeting::kApart;
  }
  if (shared >= 2 || AreSurelyApart({st, sc, s_sides}, {tt, tc, t_sides}, shared)) {
    return Meeting::kApart;
  }
  return Cross({s, s_sides}, {t, t_sides}, from, to) ? Meeting::kCross : Meeting::kApart;
}

// Where the border of the facet crosses the other's plane: one place or two.
std::vector<std::uint32_t> CrossingFinder::Ends(const Side& of, std::uint32_t plane) {
  const Corners& c = soup_.facets[of.facet].corners;
  std::vector<std::uint32_t> ends;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (of.sides[i] == 0) ends.push_back(c[i]);
    if (of.sides[i] * of.sides[j] < 0) ends.push_back(EdgeAtPlane(c[i], c[j], plane));
  }
  return ends;
}
std::uint32_t CrossingFinder::EdgeAtPlane(std::uint32_t a, std::uint32_t b, std::uint32_t plane) {
  if (a > b) std::swap(a, b);
  const auto [at, is_new] = at_planes_.try_emplace(Key{a, b, planes_.Root(plane)}, kNoCorner);
  if (!is_new) return at->second;
  const Corners& c = soup_.facets[plane].corners;
  const Point p = Kernel().construct_plane_line_intersection_point_3_object()(
      corners_.At(c[0]), corners_.At(c[1]), corners_.At(c[2]), corners_.At(a), corners_.At(b));
  return at->second = corners_.Of(p);
}

// Both facets meet the line in which their planes cross; along it, in which stretches?
bool CrossingFinder::Cross(const Side& s, const Side& t, std::uint32_t* from, std::uint32_t* to) {
  std::vector<std::uint32_t> p = Ends(s, t.facet), q = Ends(t, s.facet);
  const Vec3 along = AreaVector(TriangleOf(soup_, s.facet))
                         .normalized()
                         .cross(AreaVector(TriangleOf(soup_, t.facet)).normalized());
  const auto is_before = [&](std::uint32_t a, std::uint32_t b) { return Before(a, b, along); };
  if (is_before(p.back(), p.front())) std::reverse(p.begin(), p.end());
  if (is_before(q.back(), q.front())) std::reverse(q.begin(), q.end());
  *from = is_before(p.front(), q.front()) ? q.front() : p.front();
  *to = is_before(p.back(), q.back()) ? p.back() : q.back();
  if (is_before(*to, *from)) return false;
  if (*from != *to) return true;
  // A corner of both is no crossing.
  const Corners &sc = soup_.facets[s.facet].corners, &tc = soup_.facets[t.facet].corners;
  return std::find(sc.begin(), sc.end(), *from) == sc.end() ||
         std::find(tc.begin(), tc.end(), *from) == tc.end();
}

// Along a line with about this direction; equal points are one corner.
bool CrossingFinder::Before(std::uint32_t a, std::uint32_t b, const Vec3& along) const {
  if (a == b) return false;
  int axis = 0;
  along.cwiseAbs().maxCoeff(&axis);
  const Point p = corners_.At(a), q = corners_.At(b);
  // Of nearly parallel planes the direction says nothing: any axis that tells them apart.
  const bool is_sure = std::abs(along[axis]) > 1e-9;
  const CGAL::Comparison_result order =
      is_sure ? CompareAlong(p, q, axis) : CGAL::compare_xyz(p, q);
  return order == CGAL::SMALLER;
}

bool HasCrossing(const Soup& soup, const std::vector<bool>& is_suspect) {
  const auto suspect = [&](std::uint32_t facet) { return is_suspect.empty() || is_suspect[facet]; };
  if (!is_suspect.empty() &&
      std::find(is_suspect.begin(), is_suspect.end(), true) == is_suspect.end())
    return false;
  const std::vector<Box> boxes = BoxesOf(soup);
  const BoxTree tree(boxes);
  bool found = false;
  for (std::uint32_t s = 0; s < boxes.size() && !found; ++s) {
    if (!suspect(s)) continue;
    tree.ForEachMeeting(boxes[s], [&](std::uint32_t t) {
      if (!found && t != s && (t > s || !suspect(t))) found = Meet(soup, s, t);
    });
  }
  return found;
}

bool HasNearMiss(const Soup& soup) {
  const BoxTree tree(BoxesOf(soup));
  const Vec3 reach = Vec3::Constant(kCoincident_m);
  std::vector<bool> is_used(soup.positions.size());
  for (const SoupFacet& facet : soup.facets) {
    for (const std::uint32_t corner : facet.corners) is_used[corner] = true;
  }
  bool found = false;
  for (std::uint32_t i = 0; i < soup.positions.size() && !found; ++i) {
    if (!is_used[i]) continue;
    const Vec3& p = soup.positions[i];
    tree.ForEachMeeting({p - reach, p + reach}, [&](std::uint32_t f) {
      const Corners& c = soup.facets[f].corners;
      if (found || std::find(c.begin(), c.end(), i) != c.end()) return;
      found = MissesNarrowly(p, TriangleOf(soup, f));
    });
  }
  return found;
}

}  // namespace tranos::geom
