// SPDX-License-Identifier: GPL-3.0-or-later
// Everything exact about solids is in this file: it is the one that pays for CGAL's kernel.
#include "geom/arrangement.h"

#include <CGAL/Constrained_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "geom/box_tree.h"
#include "geom/union_find.h"

namespace tranos::geom {

namespace {

using Kernel = CGAL::Epeck;
using Point = Kernel::Point_3;
using Point2 = Kernel::Point_2;
using Predicates = CGAL::Epick;  // exact on doubles

constexpr std::uint32_t kNone = 0xffffffff;
using Corners = std::array<std::uint32_t, 3>;

Predicates::Point_3 Plain(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

// 1 if d is on the side from which a, b, c run anticlockwise.
int SideOf(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
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
Triangle TriangleOf(const Soup& soup, std::uint32_t facet) {
  const Corners& t = soup.facets[facet].corners;
  return {soup.positions[t[0]], soup.positions[t[1]], soup.positions[t[2]]};
}
Vec3 AreaVector(const Triangle& t) { return (t.b - t.a).cross(t.c - t.a); }

// A projection in which the triangle is not seen edge-on.
Projection ProjectionOf(const Triangle& t) {
  int axis = 0;
  AreaVector(t).cwiseAbs().maxCoeff(&axis);
  for (int i = 0; i < 3; ++i) {
    const Projection projection = Projection::Along((axis + i) % 3);
    if (projection.Turn(t.a, t.b, t.c) != 0) return projection;
  }
  return Projection::Along(axis);
}

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

// Pairs of facets whose boxes meet, of different meshes unless `within_meshes`.
template <class Visit>
void ForEachNearPair(const Soup& soup, bool within_meshes, Visit&& visit) {
  std::vector<Box> boxes(soup.facets.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    for (const std::uint32_t corner : soup.facets[i].corners) boxes[i].Add(soup.positions[corner]);
  }
  std::vector<Box> mesh_boxes;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    const std::uint32_t mesh = soup.facets[i].mesh;
    if (soup.facets[i].is_idle) continue;
    if (mesh >= mesh_boxes.size()) mesh_boxes.resize(mesh + 1);
    mesh_boxes[mesh].Add(boxes[i]);
  }
  // Only facets that reach into another mesh's box can meet it.
  const BoxTree meshes(mesh_boxes);
  std::vector<std::uint32_t> near;
  std::vector<Box> near_boxes;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    bool is_near = within_meshes;
    if (soup.facets[i].is_idle) continue;
    if (!is_near) {
      meshes.ForEachMeeting(boxes[i],
                            [&](std::uint32_t mesh) { is_near |= mesh != soup.facets[i].mesh; });
    }
    if (!is_near) continue;
    near.push_back(i);
    near_boxes.push_back(boxes[i]);
  }
  const BoxTree tree(near_boxes);
  for (std::uint32_t k = 0; k < near.size(); ++k) {
    std::vector<std::uint32_t> others;
    tree.ForEachMeeting(near_boxes[k], [&](std::uint32_t other) {
      if (other <= k) return;
      if (within_meshes || soup.facets[near[k]].mesh != soup.facets[near[other]].mesh) {
        others.push_back(near[other]);
      }
    });
    std::sort(others.begin(), others.end());
    for (const std::uint32_t other : others) {
      if (!visit(near[k], other)) return;
    }
  }
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

// What two facets have in common where they cross: a point, or a segment of a line.
struct Crossing {
  std::uint32_t facet, from, to;
};

// Finds where pairs of facets meet.
class CrossingFinder {
 public:
  // Facets with one number in `planes` lie in one plane.
  CrossingFinder(const Soup& soup, const UnionFind& planes, CornerTable* corners)
      : soup_(soup), planes_(planes), corners_(*corners) {}

  enum class Meeting { kApart, kInPlane, kCross };
  // Whether the facets meet other than in common corners and edges; of kCross, where.
  Meeting Meet(std::uint32_t s, std::uint32_t t, std::uint32_t* from, std::uint32_t* to) {
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

 private:
  struct Side {
    std::uint32_t facet;
    std::array<int, 3> sides;  // of its corners, against the other's plane
  };
  static bool AreApart(const std::array<int, 3>& s) {
    return (s[0] > 0 && s[1] > 0 && s[2] > 0) || (s[0] < 0 && s[1] < 0 && s[2] < 0);
  }
  static std::array<int, 3> Sides(const Corners& ids, const Triangle& t, const Corners& plane_ids,
                                  const Triangle& plane) {
    std::array<int, 3> sides;
    for (int i = 0; i < 3; ++i) {
      const bool on = std::find(plane_ids.begin(), plane_ids.end(), ids[i]) != plane_ids.end();
      sides[i] = on ? 0 : SideOf(plane.a, plane.b, plane.c, t[i]);
    }
    return sides;
  }
  static int SharedCorners(const Corners& a, const Corners& b) {
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
  // Most facets whose planes cross both are still apart, and doubles tell, with bounds for their
  // errors; or they have one corner in common and lie on different sides of it.
  static bool AreSurelyApart(const Sided& s, const Sided& t, int shared) {
    const Vec3 sn = AreaVector(s.triangle).normalized(), tn = AreaVector(t.triangle).normalized();
    int axis = 0;
    sn.cross(tn).cwiseAbs().maxCoeff(&axis);
    const Stretch p = StretchOf(s, t.triangle.a, tn, axis),
                  q = StretchOf(t, s.triangle.a, sn, axis);
    const double error = p.error + q.error;
    if (shared == 0) return p.low > q.high + error || q.low > p.high + error;
    const double at = SharedCorner(s, t)[axis];
    const auto above = [&](const Stretch& x) { return x.high - at > error; };
    const auto below = [&](const Stretch& x) { return at - x.low > error; };
    if (above(p) == below(p) || above(q) == below(q)) return false;
    return above(p) != above(q);
  }
  static Stretch StretchOf(const Sided& of, const Vec3& plane_point, const Vec3& normal, int axis) {
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
  static constexpr double kHuge = 1e300;
  static Vec3 SharedCorner(const Sided& s, const Sided& t) {
    for (int i = 0; i < 3; ++i) {
      if (std::find(t.ids.begin(), t.ids.end(), s.ids[i]) != t.ids.end()) return s.triangle[i];
    }
    return s.triangle.a;
  }

  // Where the border of the facet crosses the other's plane: one place or two.
  std::vector<std::uint32_t> Ends(const Side& of, std::uint32_t plane) {
    const Corners& c = soup_.facets[of.facet].corners;
    std::vector<std::uint32_t> ends;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      if (of.sides[i] == 0) ends.push_back(c[i]);
      if (of.sides[i] * of.sides[j] < 0) ends.push_back(EdgeAtPlane(c[i], c[j], plane));
    }
    return ends;
  }
  std::uint32_t EdgeAtPlane(std::uint32_t a, std::uint32_t b, std::uint32_t plane) {
    if (a > b) std::swap(a, b);
    const auto [at, is_new] = at_planes_.try_emplace(Key{a, b, planes_.Root(plane)}, kNone);
    if (!is_new) return at->second;
    const Corners& c = soup_.facets[plane].corners;
    const Point p = Kernel().construct_plane_line_intersection_point_3_object()(
        corners_.At(c[0]), corners_.At(c[1]), corners_.At(c[2]), corners_.At(a), corners_.At(b));
    return at->second = corners_.Of(p);
  }

  // Both facets meet the line in which their planes cross; along it, in which stretches?
  bool Cross(const Side& s, const Side& t, std::uint32_t* from, std::uint32_t* to) {
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
  bool Before(std::uint32_t a, std::uint32_t b, const Vec3& along) const {
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
  static CGAL::Comparison_result CompareAlong(const Point& p, const Point& q, int axis) {
    if (axis == 0) return CGAL::compare_x(p, q);
    return axis == 1 ? CGAL::compare_y(p, q) : CGAL::compare_z(p, q);
  }

  using Key = std::array<std::uint32_t, 3>;
  struct KeyHash {
    std::size_t operator()(const Key& k) const {
      std::uint64_t h = k[0];
      h = (h ^ (h >> 31) ^ (std::uint64_t{k[1]} << 32)) * 0x9e3779b97f4a7c15u;
      h = (h ^ (h >> 29) ^ k[2]) * 0xbf58476d1ce4e5b9u;
      return h ^ (h >> 32);
    }
  };
  const Soup& soup_;
  const UnionFind& planes_;
  CornerTable& corners_;
  std::unordered_map<Key, std::uint32_t, KeyHash> at_planes_;
};

// A plane cut by lines, as triangles.
class PlaneCuts {
 public:
  PlaneCuts(const CornerTable& corners, Projection projection)
      : corners_(corners), projection_(projection) {}

  void Add(std::uint32_t corner) { Handle(corner); }
  void Add(std::uint32_t from, std::uint32_t to) {
    const auto a = Handle(from), b = Handle(to);
    if (a != b) cuts_.insert_constraint(a, b);
  }

 private:
  using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
  using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
  using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
  using Triangulation =
      CGAL::Constrained_triangulation_2<Kernel, Structure, CGAL::Exact_intersections_tag>;

 public:
  using Vertex = Triangulation::Vertex_handle;
  using Face = Triangulation::Face_handle;

  Point2 Flat(std::uint32_t corner) const {
    const Point p = corners_.At(corner);
    return {p[projection_.u], p[projection_.v]};
  }
  // Gives every crossing of cuts a corner, made by `lift` from its place.
  template <class Lift>
  void NameCrossings(const Lift& lift) {
    for (const Vertex v : cuts_.finite_vertex_handles()) {
      if (!handles_.contains(v->info()) || handles_.at(v->info()) != v) {
        v->info() = lift(v->point());
        handles_.emplace(v->info(), v);
      }
    }
  }
  // Turns edges that nothing asked for, until no angle is much sharper than it need be (C. L.
  // Lawson, 1977): what is left of long thin triangles is due to the cuts.
  void Smooth() {
    std::vector<typename Triangulation::Edge> open;
    for (const auto& edge : cuts_.finite_edges()) open.push_back(edge);
    std::size_t turns_left = 20 * open.size() + 100;
    while (!open.empty() && turns_left > 0) {
      const auto [face, i] = open.back();
      open.pop_back();
      if (!ShouldTurn(face, i)) continue;
      const Face other = face->neighbor(i);
      cuts_.flip(face, i);
      --turns_left;
      for (const Face f : {face, other}) {
        for (int k = 0; k < 3; ++k) {
          const Face next = f->neighbor(k);
          const bool is_inner = next == face || next == other;
          f->set_constraint(k, !is_inner && next->is_constrained(next->index(f)));
          open.emplace_back(f, k);
        }
      }
    }
  }
  template <class Visit>
  void ForEachFace(Visit&& visit) const {
    for (const Face f : cuts_.finite_face_handles()) {
      visit(f, Corners{f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
    }
  }
  const auto& triangulation() const { return cuts_; }

 private:
  bool ShouldTurn(Face face, int i) const {
    constexpr double kMargin = 1e-6;
    if (face->is_constrained(i) || cuts_.is_infinite(face)) return false;
    const Face other = face->neighbor(i);
    if (cuts_.is_infinite(other)) return false;
    const Vertex apex = face->vertex(i), a = face->vertex(cuts_.ccw(i)),
                 b = face->vertex(cuts_.cw(i)), below = other->vertex(other->index(face));
    const Vec2 p = Near(apex), q = Near(a), r = Near(b), s = Near(below);
    // The angles opposite the edge together are more than half a turn.
    const Vec2 pq = q - p, pr = r - p, sq = q - s, sr = r - s;
    const double sine = (pq.x() * pr.y() - pq.y() * pr.x()) * sq.dot(sr) -
                        (sq.x() * sr.y() - sq.y() * sr.x()) * pq.dot(pr);
    if (!(sine < -kMargin * pq.norm() * pr.norm() * sq.norm() * sr.norm())) return false;
    return CGAL::left_turn(apex->point(), a->point(), below->point()) &&
           CGAL::left_turn(apex->point(), below->point(), b->point());
  }
  static Vec2 Near(Vertex v) {
    const auto& p = v->point().approx();
    return {0.5 * (p.x().inf() + p.x().sup()), 0.5 * (p.y().inf() + p.y().sup())};
  }
  Vertex Handle(std::uint32_t corner) {
    const auto known = handles_.find(corner);
    if (known != handles_.end()) return known->second;
    const Vertex v = cuts_.insert(Flat(corner), last_ == Vertex() ? Face() : last_->face());
    last_ = v;
    v->info() = corner;
    handles_.emplace(corner, v);
    return v;
  }

  const CornerTable& corners_;
  Projection projection_;
  Triangulation cuts_;
  Vertex last_;
  std::unordered_map<std::uint32_t, Vertex> handles_;
};

// Directions that no edge of a drawn building has.
constexpr std::array<std::array<double, 3>, 8> kRays = {{
    {0.5436, 0.6127, 0.5735},
    {-0.4271, 0.7139, 0.5549},
    {0.3397, -0.5523, 0.7613},
    {0.7717, 0.2911, -0.5654},
    {-0.6143, -0.3491, 0.7076},
    {-0.2713, 0.5179, -0.8113},
    {0.8513, -0.4337, -0.2951},
    {-0.5077, -0.7321, -0.4541},
}};

}  // namespace

struct Arrangement::Exact {
  Exact(Soup given, bool within_meshes)
      : soup(std::move(given)), corners(soup.positions), planes(soup.facets.size()) {
    FindPlanes();
    Cut(within_meshes);
  }

  // Facets that share an edge of their mesh and lie in one plane.
  void FindPlanes();
  void Cut(bool within_meshes);
  void CutPlane(const std::vector<std::uint32_t>& facets, std::span<const Crossing> crossings);
  void Keep(const Corners& piece, std::span<const PieceLabel> of) {
    pieces.push_back(
        {piece, static_cast<std::uint32_t>(labels.size()), static_cast<std::uint32_t>(of.size())});
    labels.insert(labels.end(), of.begin(), of.end());
  }
  void PrepareRays() const;
  // Nothing where the ray meets an edge.
  std::optional<int> WindingAlong(const Point& from, const Vec3& direction, std::uint32_t mesh,
                                  std::span<const PieceLabel> own) const;

  Soup soup;
  CornerTable corners;
  UnionFind planes;
  std::vector<Piece> pieces;
  std::vector<PieceLabel> labels;

  // For rays: of each mesh, its facets and a tree of them, made when first asked for.
  struct MeshFacets {
    std::vector<std::uint32_t> facets;
    std::unique_ptr<BoxTree> tree;
  };
  mutable std::vector<MeshFacets> meshes;
  mutable double reach_m = 0;
};

void Arrangement::Exact::FindPlanes() {
  struct HalfEdge {
    std::uint32_t mesh, low, high, facet;
    auto operator<=>(const HalfEdge&) const = default;
  };
  std::vector<HalfEdge> edges;
  edges.reserve(3 * soup.facets.size());
  for (std::uint32_t f = 0; f < soup.facets.size(); ++f) {
    const Corners& c = soup.facets[f].corners;
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(c[i], c[(i + 1) % 3]);
      edges.push_back({soup.facets[f].mesh, low, high, f});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const HalfEdge &a = edges[i - 1], &b = edges[i];
    if (a.mesh != b.mesh || a.low != b.low || a.high != b.high) continue;
    const Triangle t = TriangleOf(soup, a.facet);
    for (const std::uint32_t corner : soup.facets[b.facet].corners) {
      if (corner == b.low || corner == b.high) continue;
      if (SideOf(t.a, t.b, t.c, soup.positions[corner]) == 0) planes.Unite(a.facet, b.facet);
    }
  }
}

void Arrangement::Exact::Cut(bool within_meshes) {
  CrossingFinder finder(soup, planes, &corners);
  UnionFind clusters(soup.facets.size());
  std::vector<bool> is_cut(soup.facets.size());
  std::vector<Crossing> crossings;
  ForEachNearPair(soup, within_meshes, [&](std::uint32_t s, std::uint32_t t) {
    std::uint32_t from = kNone, to = kNone;
    const auto meeting = finder.Meet(s, t, &from, &to);
    if (meeting == CrossingFinder::Meeting::kApart) return true;
    is_cut[s] = is_cut[t] = true;
    if (meeting == CrossingFinder::Meeting::kInPlane) {
      clusters.Unite(s, t);
      planes.Unite(s, t);
    } else {
      crossings.push_back({s, from, to});
      crossings.push_back({t, from, to});
    }
    return true;
  });

  // By cluster, in the order of their first facets.
  std::vector<std::uint32_t> cut;
  for (std::uint32_t f = 0; f < soup.facets.size(); ++f) {
    if (is_cut[f]) {
      cut.push_back(f);
    } else if (!soup.facets[f].is_idle) {
      const PieceLabel label{f, false};
      Keep(soup.facets[f].corners, {&label, 1});
    }
  }
  const auto by_cluster = [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(clusters.Root(a), a) < std::pair(clusters.Root(b), b);
  };
  std::sort(cut.begin(), cut.end(), by_cluster);
  std::stable_sort(crossings.begin(), crossings.end(), [&](const Crossing& a, const Crossing& b) {
    return clusters.Root(a.facet) < clusters.Root(b.facet);
  });
  std::size_t crossing = 0;
  for (std::size_t i = 0; i < cut.size();) {
    const std::uint32_t root = clusters.Root(cut[i]);
    std::vector<std::uint32_t> facets;
    for (; i < cut.size() && clusters.Root(cut[i]) == root; ++i) facets.push_back(cut[i]);
    const std::size_t begin = crossing;
    while (crossing < crossings.size() && clusters.Root(crossings[crossing].facet) == root) {
      ++crossing;
    }
    CutPlane(facets, std::span(crossings).subspan(begin, crossing - begin));
  }
}

void Arrangement::Exact::CutPlane(const std::vector<std::uint32_t>& facets,
                                  std::span<const Crossing> crossings) {
  const Triangle first = TriangleOf(soup, facets[0]);
  const Projection projection = ProjectionOf(first);
  PlaneCuts cuts(corners, projection);
  for (const std::uint32_t f : facets) {
    const Corners& c = soup.facets[f].corners;
    for (int i = 0; i < 3; ++i) cuts.Add(c[i], c[(i + 1) % 3]);
  }
  for (const Crossing& crossing : crossings) {
    if (crossing.from == crossing.to) {
      cuts.Add(crossing.from);
    } else {
      cuts.Add(crossing.from, crossing.to);
    }
  }
  const Corners& c = soup.facets[facets[0]].corners;
  const Kernel::Plane_3 plane(corners.At(c[0]), corners.At(c[1]), corners.At(c[2]));
  cuts.NameCrossings([&](const Point2& p) {
    const std::array<Kernel::FT, 3> n = {plane.a(), plane.b(), plane.c()};
    const int u = projection.u, v = projection.v, axis = 3 - u - v;
    std::array<Kernel::FT, 3> xyz;
    xyz[u] = p.x();
    xyz[v] = p.y();
    xyz[axis] = -(n[u] * p.x() + n[v] * p.y() + plane.d()) / n[axis];
    return corners.Of(Point(xyz[0], xyz[1], xyz[2]));
  });

  struct Outline {
    std::array<Point2, 3> corners;
    Box box;  // of the plane's two coordinates
    int turn;
  };
  std::vector<Outline> outlines;
  for (const std::uint32_t f : facets) {
    const Triangle t = TriangleOf(soup, f);
    Outline outline{{}, {}, projection.Turn(t.a, t.b, t.c)};
    for (int i = 0; i < 3; ++i) {
      outline.corners[i] = Point2(t[i][projection.u], t[i][projection.v]);
      outline.box.Add({t[i][projection.u], t[i][projection.v], 0});
    }
    outlines.push_back(outline);
  }
  const auto holds = [](const Outline& outline, const Point2& p, const Vec3& near) {
    if ((near.array() < outline.box.min.array() - 1e-6).any() ||
        (near.array() > outline.box.max.array() + 1e-6).any()) {
      return false;
    }
    for (int i = 0; i < 3; ++i) {
      const int side = CGAL::orientation(outline.corners[i], outline.corners[(i + 1) % 3], p);
      if (side * outline.turn < 0) return false;
    }
    return true;
  };
  std::vector<PieceLabel> of;
  cuts.ForEachFace([&](const auto& face, const Corners& piece) {
    of.clear();
    if (facets.size() == 1) {
      of.push_back({facets[0], outlines[0].turn < 0});
    } else {
      const Point2 middle = CGAL::centroid(face->vertex(0)->point(), face->vertex(1)->point(),
                                           face->vertex(2)->point());
      const Vec3 near(CGAL::to_double(middle.x().approx()), CGAL::to_double(middle.y().approx()),
                      0);
      for (std::size_t i = 0; i < facets.size(); ++i) {
        if (holds(outlines[i], middle, near)) of.push_back({facets[i], outlines[i].turn < 0});
      }
    }
    if (of.empty()) return;
    // A piece looks as the first of its facets does.
    Corners turned = piece;
    if (of[0].opposite) {
      std::swap(turned[1], turned[2]);
      for (PieceLabel& label : of) label.opposite = !label.opposite;
    }
    Keep(turned, of);
  });
}

void Arrangement::Exact::PrepareRays() const {
  if (!meshes.empty()) return;
  Box all;
  for (std::uint32_t f = 0; f < soup.facets.size(); ++f) {
    const std::uint32_t mesh = soup.facets[f].mesh;
    if (mesh >= meshes.size()) meshes.resize(mesh + 1);
    meshes[mesh].facets.push_back(f);
  }
  for (const Vec3& p : soup.positions) all.Add(p);
  reach_m = 3 * (all.max - all.min).norm() + 1;
}

std::optional<int> Arrangement::Exact::WindingAlong(const Point& from, const Vec3& direction,
                                                    std::uint32_t mesh,
                                                    std::span<const PieceLabel> own) const {
  const auto near = [](const auto& i) { return 0.5 * (i.inf() + i.sup()); };
  const Vec3 origin(near(from.approx().x()), near(from.approx().y()), near(from.approx().z()));
  const Vec3 end = origin + reach_m * direction;
  const Point to(end.x(), end.y(), end.z());
  MeshFacets& of = meshes[mesh];
  if (!of.tree) {
    std::vector<Box> boxes(of.facets.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (const std::uint32_t c : soup.facets[of.facets[i]].corners)
        boxes[i].Add(soup.positions[c]);
    }
    of.tree = std::make_unique<BoxTree>(boxes);
  }
  int winding = 0;
  bool is_sure = true;
  of.tree->ForEachOnRay(origin, direction, [&](std::uint32_t i) {
    const std::uint32_t facet = of.facets[i];
    for (const PieceLabel& label : own) {
      if (label.facet == facet) return;
    }
    const Corners& c = soup.facets[facet].corners;
    const Point a = corners.At(c[0]), b = corners.At(c[1]), d = corners.At(c[2]);
    const int start = CGAL::orientation(a, b, d, from), stop = CGAL::orientation(a, b, d, to);
    if (start == 0 || start == stop) return;
    const std::array<int, 3> turns = {CGAL::orientation(from, to, a, b),
                                      CGAL::orientation(from, to, b, d),
                                      CGAL::orientation(from, to, d, a)};
    const auto [least, most] = std::minmax_element(turns.begin(), turns.end());
    if (*least < 0 && *most > 0) return;
    if (*least * *most == 0 || stop == 0) {
      is_sure = false;
      return;
    }
    winding += start < 0 ? 1 : -1;
  });
  if (!is_sure) return std::nullopt;
  return winding;
}

Arrangement::Arrangement(Soup soup, bool within_meshes)
    : exact_(std::make_unique<Exact>(std::move(soup), within_meshes)) {}
Arrangement::~Arrangement() = default;

const Soup& Arrangement::soup() const { return exact_->soup; }
const std::vector<Piece>& Arrangement::pieces() const { return exact_->pieces; }
const std::vector<PieceLabel>& Arrangement::labels() const { return exact_->labels; }
std::span<const PieceLabel> Arrangement::LabelsOf(const Piece& piece) const {
  return std::span(exact_->labels).subspan(piece.first_label, piece.label_count);
}
std::uint32_t Arrangement::corner_count() const { return exact_->corners.size(); }
Vec3 Arrangement::Rounded(std::uint32_t corner) const { return exact_->corners.Rounded(corner); }
bool Arrangement::IsRounded(std::uint32_t corner) const {
  return exact_->corners.IsRounded(corner);
}
Vec3 Arrangement::Near(std::uint32_t corner) const { return exact_->corners.Near(corner); }
std::uint32_t Arrangement::PlaneOf(std::uint32_t facet) const { return exact_->planes.Root(facet); }

Result<int> Arrangement::Winding(const Piece& piece, std::uint32_t mesh) const {
  exact_->PrepareRays();
  const auto& corners = exact_->corners;
  const Point middle = CGAL::centroid(corners.At(piece.corners[0]), corners.At(piece.corners[1]),
                                      corners.At(piece.corners[2]));
  std::span<const PieceLabel> own = LabelsOf(piece);
  const bool is_own = std::any_of(own.begin(), own.end(), [&](const PieceLabel& label) {
    return exact_->soup.facets[label.facet].mesh == mesh;
  });
  if (!is_own) own = {};
  const Triangle first = TriangleOf(exact_->soup, LabelsOf(piece)[0].facet);
  const Vec3 front = AreaVector(first);
  for (const auto& ray : kRays) {
    Vec3 direction(ray[0], ray[1], ray[2]);
    // The place just in front of the piece, which looks as its first facet does.
    if (direction.dot(front) < 0) direction = -direction;
    const auto winding = exact_->WindingAlong(middle, direction, mesh, own);
    if (winding) return *winding;
  }
  return tl::unexpected(Error{ErrorCode::kDegenerate, "no ray tells inside from outside"});
}

std::vector<Corners> Arrangement::Triangulated(std::uint32_t facet,
                                               const std::vector<RegionEdge>& edges) const {
  const Triangle t = TriangleOf(exact_->soup, facet);
  const Projection projection = ProjectionOf(t);
  PlaneCuts cuts(exact_->corners, projection);
  std::unordered_map<std::uint64_t, bool> within;
  const auto key = [](std::uint32_t a, std::uint32_t b) {
    const auto [low, high] = std::minmax(a, b);
    return std::uint64_t{low} << 32 | high;
  };
  for (const RegionEdge& edge : edges) {
    if (edge.from == edge.to) {
      cuts.Add(edge.from);
      continue;
    }
    cuts.Add(edge.from, edge.to);
    within[key(edge.from, edge.to)] = edge.within;
  }
  cuts.Smooth();
  // Across each border from outside in and out again, beginning beyond everything.
  const auto& faces = cuts.triangulation();
  std::unordered_map<PlaneCuts::Face, bool> is_inside;
  std::vector<PlaneCuts::Face> open{faces.infinite_face()};
  is_inside[open[0]] = false;
  while (!open.empty()) {
    const PlaneCuts::Face at = open.back();
    open.pop_back();
    for (int i = 0; i < 3; ++i) {
      const PlaneCuts::Face next = at->neighbor(i);
      if (is_inside.contains(next)) continue;
      const bool is_border =
          at->is_constrained(i) &&
          !within[key(at->vertex(faces.cw(i))->info(), at->vertex(faces.ccw(i))->info())];
      is_inside[next] = is_inside[at] != is_border;
      open.push_back(next);
    }
  }
  const bool turns = projection.Turn(t.a, t.b, t.c) < 0;
  std::vector<Corners> triangles;
  cuts.ForEachFace([&](const auto& face, Corners piece) {
    if (!is_inside[face]) return;
    if (turns) std::swap(piece[1], piece[2]);
    triangles.push_back(piece);
  });
  return triangles;
}

bool HasCrossing(const Soup& soup, const std::vector<bool>& is_suspect) {
  CornerTable corners(soup.positions);
  const UnionFind planes(soup.facets.size());
  CrossingFinder finder(soup, planes, &corners);
  bool found = false;
  ForEachNearPair(soup, true, [&](std::uint32_t s, std::uint32_t t) {
    if (!is_suspect.empty() && !is_suspect[s] && !is_suspect[t]) return true;
    std::uint32_t from = kNone, to = kNone;
    found = finder.Meet(s, t, &from, &to) != CrossingFinder::Meeting::kApart;
    return !found;
  });
  return found;
}

}  // namespace tranos::geom
