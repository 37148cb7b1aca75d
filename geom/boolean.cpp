// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/boolean.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geom/arrangement.h"
#include "geom/box_tree.h"
#include "geom/conform.h"
#include "geom/mesh_row.h"
#include "geom/plane_regions.h"
#include "geom/solid_expression.h"
#include "geom/solid_rounding.h"
#include "geom/union_find.h"

namespace tranos::geom {

namespace {

using Leaf = std::shared_ptr<const TriangleMesh>;

// Leaves whose boxes all but meet, directly or through others, in the order of their first ones.
// What belongs to different lots never meets.
std::vector<std::vector<std::uint32_t>> LotsOf(const SolidExpression& expression) {
  const std::vector<Leaf>& leaves = expression.leaves();
  std::vector<Box> boxes;
  for (std::uint32_t i = 0; i < leaves.size(); ++i) {
    const Box box = BoundingBox(*leaves[i]), &relevant = expression.RelevantPartOf(i);
    boxes.push_back({box.min.cwiseMax(relevant.min).array() - kCoincident_m / 2,
                     box.max.cwiseMin(relevant.max).array() + kCoincident_m / 2});
  }
  const BoxTree tree(boxes);
  UnionFind lots(leaves.size());
  for (std::uint32_t i = 0; i < leaves.size(); ++i) {
    if (boxes[i].empty()) continue;
    tree.ForEachMeeting(boxes[i], [&](std::uint32_t other) { lots.Unite(i, other); });
  }
  std::vector<std::vector<std::uint32_t>> members(leaves.size());
  for (std::uint32_t i = 0; i < leaves.size(); ++i) members[lots.Root(i)].push_back(i);
  std::erase_if(members, [](const auto& lot) { return lot.empty(); });
  return members;
}

// The leaves of one lot, cut along one another, and what of them is the solid's surface.
class LotEvaluation {
 public:
  LotEvaluation(const std::vector<Leaf>& leaves, const std::vector<std::uint32_t>& lot,
                SolidExpression* expression, bool conforms)
      : lot_(lot), expression_(*expression), arrangement_(SoupOf(leaves, conforms), false) {
    for (const std::uint32_t leaf : lot) {
      const Box box = BoundingBox(*leaves[leaf]);
      boxes_.push_back({box.min.array() - kConformed_m, box.max.array() + kConformed_m});
    }
  }

  // Not closed where the leaves cross themselves as merged with one another.
  Result<std::vector<SurfacePiece>> Pieces() {
    const std::vector<std::uint32_t> patches = PatchesOf(arrangement_);
    std::vector<Side> sides(patches.size());
    const std::vector<std::uint32_t> largest = LargestPieces(patches);
    const BoxTree tree(boxes_);
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
      if (patches[i] != i) continue;
      auto side = SideOf(arrangement_.pieces()[largest[i]], tree);
      if (!side) return tl::unexpected(side.error());
      sides[i] = *side;
    }
    std::vector<SurfacePiece> kept;
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
      const Side side = sides[patches[i]];
      if (side == Side::kNeither) continue;
      const Piece& piece = arrangement_.pieces()[i];
      const std::uint32_t facet = arrangement_.LabelsOf(piece)[0].facet;
      const bool turned = side == Side::kFront;
      SurfacePiece surface{piece.corners, facet, SurfaceOf(facet), turned,
                           turned != LooksAgainstPlane(facet)};
      if (surface.turned) std::swap(surface.corners[1], surface.corners[2]);
      kept.push_back(surface);
    }
    return kept;
  }
  Result<TriangleMesh> Surface(std::vector<SurfacePiece> pieces) const {
    return Rounded(arrangement_, MergePlanes(arrangement_, std::move(pieces)));
  }

 private:
  // Where the solid is, seen from a piece.
  enum class Side : std::uint8_t { kNeither, kBack, kFront };

  Soup SoupOf(const std::vector<Leaf>& leaves, bool conforms) {
    Soup soup = MergedLeaves(leaves);
    if (!conforms) return soup;
    TriangleMesh mesh{std::move(soup.positions), {}, {}};
    for (std::uint32_t f = 0; f < soup.facets.size(); ++f) {
      mesh.triangles.push_back(soup.facets[f].corners);
      mesh.surfaces.push_back(f);
    }
    mesh = Conformed(std::move(mesh));
    Soup conformed{std::move(mesh.positions), {}};
    std::vector<std::uint32_t> surfaces;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const std::uint32_t f = mesh.surfaces[i];
      conformed.facets.push_back({mesh.triangles[i], soup.facets[f].mesh, soup.facets[f].is_idle});
      surfaces.push_back(surfaces_[f]);
    }
    surfaces_ = std::move(surfaces);
    return conformed;
  }

  Soup MergedLeaves(const std::vector<Leaf>& leaves) {
    Soup soup;
    PositionIndex index;
    for (std::uint32_t i = 0; i < lot_.size(); ++i) {
      const TriangleMesh& mesh = *leaves[lot_[i]];
      std::vector<std::uint32_t> corner_of(mesh.positions.size());
      for (std::size_t k = 0; k < corner_of.size(); ++k) {
        corner_of[k] = index.Of(mesh.positions[k], &soup.positions);
      }
      for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
        const auto& t = mesh.triangles[k];
        const std::array<std::uint32_t, 3> corners = {corner_of[t[0]], corner_of[t[1]],
                                                      corner_of[t[2]]};
        if (HasTwice(corners)) continue;
        Box box;
        for (const std::uint32_t corner : corners) box.Add(soup.positions[corner]);
        const bool is_idle = !BoxTree::Meet(box, expression_.RelevantPartOf(lot_[i]));
        soup.facets.push_back({corners, i, is_idle});
        surfaces_.push_back(mesh.surfaces[k]);
      }
    }
    return soup;
  }

  std::vector<std::uint32_t> LargestPieces(const std::vector<std::uint32_t>& patches) const {
    std::vector<std::uint32_t> largest(patches.size());
    std::vector<double> area(patches.size(), -1);
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
      const auto& c = arrangement_.pieces()[i].corners;
      const Vec3 a = arrangement_.Rounded(c[0]);
      const double size =
          (arrangement_.Rounded(c[1]) - a).cross(arrangement_.Rounded(c[2]) - a).norm();
      if (size <= area[patches[i]]) continue;
      area[patches[i]] = size;
      largest[patches[i]] = i;
    }
    return largest;
  }

  // All pieces of a patch are inside the same of the other meshes.
  Result<Side> SideOf(const Piece& piece, const BoxTree& tree) {
    std::vector<std::uint32_t> front, back;
    std::vector<bool> is_own(lot_.size());
    for (const PieceLabel& label : arrangement_.LabelsOf(piece)) {
      const std::uint32_t mesh = arrangement_.soup().facets[label.facet].mesh;
      is_own[mesh] = true;
      (label.opposite ? front : back).push_back(lot_[mesh]);
    }
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t corner : piece.corners) middle += arrangement_.Rounded(corner) / 3;
    std::vector<std::uint32_t> around;
    tree.ForEachMeeting({middle, middle}, [&](std::uint32_t mesh) {
      if (!is_own[mesh]) around.push_back(mesh);
    });
    std::sort(around.begin(), around.end());
    for (const std::uint32_t mesh : around) {
      const auto winding = arrangement_.Winding(piece, mesh);
      if (!winding) return tl::unexpected(winding.error());
      if (*winding <= 0) continue;
      front.push_back(lot_[mesh]);
      back.push_back(lot_[mesh]);
    }
    const bool in_front = expression_.Contains(front), behind = expression_.Contains(back);
    if (in_front == behind) return Side::kNeither;
    return behind ? Side::kBack : Side::kFront;
  }

  bool LooksAgainstPlane(std::uint32_t facet) const {
    const auto normal = [&](std::uint32_t f) {
      const auto& c = arrangement_.soup().facets[f].corners;
      const auto& p = arrangement_.soup().positions;
      return Vec3((p[c[1]] - p[c[0]]).cross(p[c[2]] - p[c[0]]));
    };
    return normal(facet).dot(normal(arrangement_.PlaneOf(facet))) < 0;
  }

  // Numbers for the smooth surfaces of the result: a plane has one, whosever facets lie in it.
  std::uint32_t SurfaceOf(std::uint32_t facet) {
    if (surface_numbers_.empty()) FindFlatSurfaces();
    const std::uint32_t mesh = arrangement_.soup().facets[facet].mesh;
    const std::uint32_t plane = arrangement_.PlaneOf(facet);
    const auto key = std::pair(mesh, surfaces_[facet]);
    const bool is_flat = flat_.at(key) != kCurved;
    const auto number = static_cast<std::uint32_t>(surface_numbers_.size());
    return surface_numbers_
        .try_emplace(is_flat ? SurfaceKey{true, plane, 0} : SurfaceKey{false, mesh, key.second},
                     number)
        .first->second;
  }
  void FindFlatSurfaces() {
    for (std::uint32_t f = 0; f < surfaces_.size(); ++f) {
      const std::uint32_t plane = arrangement_.PlaneOf(f);
      const auto [at, is_new] =
          flat_.try_emplace({arrangement_.soup().facets[f].mesh, surfaces_[f]}, plane);
      if (!is_new && at->second != plane) at->second = kCurved;
    }
  }

  static constexpr std::uint32_t kCurved = 0xffffffff;
  struct SurfaceKey {
    bool is_flat;
    std::uint32_t mesh_or_plane, surface;
    auto operator<=>(const SurfaceKey&) const = default;
  };
  const std::vector<std::uint32_t>& lot_;
  SolidExpression& expression_;
  std::vector<std::uint32_t> surfaces_;  // of each facet, in its mesh
  Arrangement arrangement_;
  std::vector<Box> boxes_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> flat_;  // its plane
  std::map<SurfaceKey, std::uint32_t> surface_numbers_;
};

bool AreClosed(const std::vector<SurfacePiece>& pieces) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(pieces.size());
  for (const SurfacePiece& piece : pieces) triangles.push_back(piece.corners);
  return IsClosed(triangles);
}

// Leaves that cross themselves are made ones that do not.
Result<std::vector<Leaf>> UncrossedLeaves(const std::vector<Leaf>& leaves,
                                          const std::vector<std::uint32_t>& lot) {
  std::vector<Leaf> uncrossed = leaves;
  for (const std::uint32_t leaf : lot) {
    if (!leaves[leaf]->may_cross || !HasSelfIntersection(*leaves[leaf])) continue;
    auto mesh = Uncrossed(*leaves[leaf]);
    if (!mesh) return tl::unexpected(mesh.error());
    uncrossed[leaf] = std::make_shared<const TriangleMesh>(std::move(*mesh));
  }
  return uncrossed;
}

Result<TriangleMesh> SurfaceOf(const std::vector<Leaf>& leaves,
                               const std::vector<std::uint32_t>& lot, SolidExpression* expression) {
  const auto uncrossed = UncrossedLeaves(leaves, lot);
  if (!uncrossed) return tl::unexpected(uncrossed.error());
  for (const bool conforms : {false, true}) {
    LotEvaluation evaluation(*uncrossed, lot, expression, conforms);
    auto pieces = evaluation.Pieces();
    if (!pieces) return tl::unexpected(pieces.error());
    if (!AreClosed(*pieces)) continue;
    auto surface = evaluation.Surface(std::move(*pieces));
    if (surface || conforms) return surface;
  }
  return tl::unexpected(Error{ErrorCode::kDegenerate, "its surface does not close"});
}

}  // namespace

Result<TriangleMesh> Evaluate(const Solid& solid) {
  auto expression = SolidExpression::Of(solid);
  if (!expression) return tl::unexpected(expression.error());
  MeshRow result;
  for (const auto& lot : LotsOf(*expression)) {
    if (lot.size() == 1) {
      if (expression->Contains(lot)) result.Append(*expression->leaves()[lot[0]]);
      continue;
    }
    const auto part = SurfaceOf(expression->leaves(), lot, &*expression);
    if (!part) return part;
    result.Append(*part);
  }
  return result.Take();
}

}  // namespace tranos::geom
