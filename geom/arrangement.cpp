// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/arrangement.h"

// The corners of cuts that cross are few.
#define CGAL_NO_CDT_2_WARNING
#include <CGAL/Constrained_triangulation_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "geom/facet_crossing.h"
#include "geom/mesh_edges.h"

namespace tranos::geom {

namespace {

// As the kernel, but the predicates are quick about points that are plain doubles: those in a line,
// which are as frequent in buildings as they are rare elsewhere, would else be told by fractions.
struct FlatKernel : Kernel {
  static bool IsPlain(const Point2& p) {
    return p.approx().x().is_point() && p.approx().y().is_point();
  }
  static Predicates::Point_2 Plain(const Point2& p) {
    return {p.approx().x().inf(), p.approx().y().inf()};
  }
  struct Orientation_2 {
    using result_type = CGAL::Orientation;
    CGAL::Orientation operator()(const Point2& a, const Point2& b, const Point2& c) const {
      if (!IsPlain(a) || !IsPlain(b) || !IsPlain(c)) return Kernel::Orientation_2()(a, b, c);
      return CGAL::orientation(FlatKernel::Plain(a), FlatKernel::Plain(b), FlatKernel::Plain(c));
    }
  };
  Orientation_2 orientation_2_object() const { return {}; }
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
  using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, FlatKernel>;
  using FaceBase = CGAL::Constrained_triangulation_face_base_2<FlatKernel>;
  using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
  using Triangulation =
      CGAL::Constrained_triangulation_2<FlatKernel, Structure, CGAL::Exact_intersections_tag>;

 public:
  using Vertex = Triangulation::Vertex_handle;
  using Face = Triangulation::Face_handle;

  Point2 Flat(std::uint32_t corner) const {
    const auto plain = corners_.Plain(corner);
    if (plain) return {(*plain)[projection_.u], (*plain)[projection_.v]};
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
    // By faces: as an edge the engine names the one of its two sides whose face has the lower
    // address.
    std::vector<typename Triangulation::Edge> open;
    for (const Face face : cuts_.finite_face_handles()) {
      for (int i = 0; i < 3; ++i) open.emplace_back(face, i);
    }
    std::size_t turns_left = 10 * open.size() + 100;
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
  void CutPlane(const std::vector<std::uint32_t>& facets, std::span<const FacetCrossing> crossings);
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
  std::vector<Corners> triangles;
  triangles.reserve(soup.facets.size());
  for (const SoupFacet& facet : soup.facets) triangles.push_back(facet.corners);
  // Facets of one mesh follow one another, so that those on one edge do, too.
  const std::vector<HalfEdge> edges = SortedHalfEdges(triangles);
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const HalfEdge &a = edges[i - 1], &b = edges[i];
    if (!a.SameEdge(b) || soup.facets[a.triangle].mesh != soup.facets[b.triangle].mesh) continue;
    const Triangle t = TriangleOf(soup, a.triangle);
    for (const std::uint32_t corner : soup.facets[b.triangle].corners) {
      if (corner == b.low || corner == b.high) continue;
      if (SideOf(t.a, t.b, t.c, soup.positions[corner]) == 0) planes.Unite(a.triangle, b.triangle);
    }
  }
}

void Arrangement::Exact::Cut(bool within_meshes) {
  CrossingFinder finder(soup, planes, &corners);
  UnionFind clusters(soup.facets.size());
  std::vector<bool> is_cut(soup.facets.size());
  std::vector<FacetCrossing> crossings;
  ForEachNearPair(soup, within_meshes, [&](std::uint32_t s, std::uint32_t t) {
    std::uint32_t from = kNoCorner, to = kNoCorner;
    const auto meeting = finder.Meet(s, t, &from, &to);
    if (meeting == CrossingFinder::Meeting::kApart) return;
    is_cut[s] = is_cut[t] = true;
    if (meeting == CrossingFinder::Meeting::kInPlane) {
      clusters.Unite(s, t);
      planes.Unite(s, t);
    } else {
      crossings.push_back({s, from, to});
      crossings.push_back({t, from, to});
    }
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
  std::stable_sort(crossings.begin(), crossings.end(),
                   [&](const FacetCrossing& a, const FacetCrossing& b) {
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
                                  std::span<const FacetCrossing> crossings) {
  const Triangle first = TriangleOf(soup, facets[0]);
  const Projection projection = ProjectionOf(first);
  PlaneCuts cuts(corners, projection);
  for (const std::uint32_t f : facets) {
    const Corners& c = soup.facets[f].corners;
    for (int i = 0; i < 3; ++i) cuts.Add(c[i], c[(i + 1) % 3]);
  }
  for (const FacetCrossing& crossing : crossings) {
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
std::span<const PieceLabel> Arrangement::LabelsOf(const Piece& piece) const {
  return std::span(exact_->labels).subspan(piece.first_label, piece.label_count);
}
std::uint32_t Arrangement::corner_count() const { return exact_->corners.size(); }
Vec3 Arrangement::Rounded(std::uint32_t corner) const { return exact_->corners.Rounded(corner); }
bool Arrangement::IsRounded(std::uint32_t corner) const {
  return exact_->corners.IsRounded(corner);
}
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

}  // namespace tranos::geom
