// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/plane_regions.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "geom/mesh_edges.h"
#include "geom/union_find.h"

namespace tranos::geom {

namespace {

constexpr std::uint32_t kNone = 0xffffffff;

// The sides of the pieces, those on one edge together.
template <class PieceType>
std::vector<HalfEdge> SidesOf(const std::vector<PieceType>& pieces) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(pieces.size());
  for (const PieceType& piece : pieces) triangles.push_back(piece.corners);
  return SortedHalfEdges(triangles);
}

bool OfSameMeshes(const Arrangement& arrangement, const Piece& a, const Piece& b) {
  if (a.label_count != b.label_count) return false;
  const auto as = arrangement.LabelsOf(a), bs = arrangement.LabelsOf(b);
  const auto& facets = arrangement.soup().facets;
  for (std::size_t i = 0; i < as.size(); ++i) {
    if (facets[as[i].facet].mesh != facets[bs[i].facet].mesh) return false;
    if (as[i].opposite != bs[i].opposite) return false;
  }
  return true;
}

}  // namespace

std::vector<std::uint32_t> PatchesOf(const Arrangement& arrangement) {
  const std::vector<Piece>& pieces = arrangement.pieces();
  UnionFind patches(pieces.size());
  ForEachEdge(SidesOf(pieces), [&](std::span<const HalfEdge> sides) {
    if (sides.size() != 2) return;
    const std::uint32_t a = sides[0].triangle, b = sides[1].triangle;
    if (OfSameMeshes(arrangement, pieces[a], pieces[b])) patches.Unite(a, b);
  });
  std::vector<std::uint32_t> first(pieces.size());
  for (std::uint32_t i = 0; i < first.size(); ++i) first[i] = patches.Root(i);
  return first;
}

namespace {

class PlaneMerge {
 public:
  PlaneMerge(const Arrangement& arrangement, std::vector<SurfacePiece> pieces)
      : arrangement_(arrangement),
        pieces_(std::move(pieces)),
        sides_(SidesOf(pieces_)),
        regions_(pieces_.size()),
        corners_(arrangement.corner_count()) {}

  std::vector<SurfacePiece> Merged() {
    FindRegions();
    FindBorders();
    std::vector<SurfacePiece> merged;
    std::vector<std::vector<std::uint32_t>> members(pieces_.size());
    for (std::uint32_t p = 0; p < pieces_.size(); ++p) members[regions_.Root(p)].push_back(p);
    const auto borders = BordersByRegion();
    for (std::uint32_t region = 0; region < pieces_.size(); ++region) {
      if (members[region].empty()) continue;
      if (members[region].size() == 1 || !LosesCorners(members[region])) {
        for (const std::uint32_t p : members[region]) merged.push_back(pieces_[p]);
        continue;
      }
      const SurfacePiece& first = pieces_[region];
      for (auto corners : arrangement_.Triangulated(first.facet, borders.at(region))) {
        if (first.turned) std::swap(corners[1], corners[2]);
        merged.push_back({corners, first.facet, first.surface, first.turned, first.up});
      }
    }
    return merged;
  }

 private:
  // What is known of a corner.
  struct Corner {
    std::uint32_t region = kNone;  // of the first piece at it
    bool is_alone = true;          // no more than two regions meet here
    std::uint32_t other = kNone;   // the second region
    std::uint32_t borders = 0;     // edges between regions that end here
    bool is_plain = true;          // those edges each have the same two regions beside them
    std::array<std::uint32_t, 2> ends = {kNone, kNone};  // the first two's other ends
  };

  bool BelongTogether(const SurfacePiece& a, const SurfacePiece& b) const {
    return a.surface == b.surface && a.up == b.up &&
           arrangement_.PlaneOf(a.facet) == arrangement_.PlaneOf(b.facet);
  }
  void FindRegions() {
    ForEachEdge(sides_, [&](std::span<const HalfEdge> sides) {
      if (sides.size() != 2) return;
      const std::uint32_t a = sides[0].triangle, b = sides[1].triangle;
      if (BelongTogether(pieces_[a], pieces_[b])) regions_.Unite(a, b);
    });
    for (std::uint32_t p = 0; p < pieces_.size(); ++p) {
      const std::uint32_t region = regions_.Root(p);
      for (const std::uint32_t c : pieces_[p].corners) {
        Corner& corner = corners_[c];
        if (corner.region == kNone) corner.region = region;
        if (corner.region == region) continue;
        if (corner.other == kNone) corner.other = region;
        if (corner.other != region) corner.is_alone = false;
      }
    }
  }
  bool IsBorder(std::span<const HalfEdge> sides) const {
    return sides.size() != 2 ||
           regions_.Root(sides[0].triangle) != regions_.Root(sides[1].triangle);
  }
  void FindBorders() {
    ForEachEdge(sides_, [&](std::span<const HalfEdge> sides) {
      if (!IsBorder(sides)) return;
      const HalfEdge& edge = sides[0];
      for (const HalfEdge& side : sides) {
        const std::uint32_t region = regions_.Root(side.triangle);
        on_border_.insert(KeyOf(region, edge.low));
        on_border_.insert(KeyOf(region, edge.high));
      }
      for (const auto& [at, end] : {std::pair(edge.low, edge.high), {edge.high, edge.low}}) {
        Corner& corner = corners_[at];
        if (corner.borders < 2) corner.ends[corner.borders] = end;
        ++corner.borders;
        if (sides.size() != 2) corner.is_plain = false;
      }
    });
  }
  // In the middle of a straight edge between two regions: their planes cross in one line.
  bool IsSuperfluous(std::uint32_t c) const {
    const Corner& corner = corners_[c];
    return corner.borders == 2 && corner.is_plain && corner.is_alone && corner.other != kNone &&
           arrangement_.PlaneOf(pieces_[corner.region].facet) !=
               arrangement_.PlaneOf(pieces_[corner.other].facet);
  }
  static std::uint64_t KeyOf(std::uint32_t region, std::uint32_t corner) {
    return std::uint64_t{region} << 32 | corner;
  }
  bool IsWithin(std::uint32_t region, std::uint32_t c) const {
    return !on_border_.contains(KeyOf(region, c));
  }
  bool LosesCorners(const std::vector<std::uint32_t>& pieces) const {
    for (const std::uint32_t p : pieces) {
      for (const std::uint32_t c : pieces_[p].corners) {
        const bool is_within = IsWithin(regions_.Root(p), c);
        if (IsSuperfluous(c) || (is_within && corners_[c].other == kNone)) return true;
      }
    }
    return false;
  }

  // From a corner that stays along the border to the next one that stays.
  std::uint32_t EndOf(std::uint32_t from, std::uint32_t next) const {
    while (IsSuperfluous(next)) {
      const auto& ends = corners_[next].ends;
      const std::uint32_t after = ends[0] == from ? ends[1] : ends[0];
      from = next;
      next = after;
    }
    return next;
  }
  std::unordered_map<std::uint32_t, std::vector<Arrangement::RegionEdge>> BordersByRegion() const {
    std::unordered_map<std::uint32_t, std::vector<Arrangement::RegionEdge>> borders;
    ForEachEdge(sides_, [&](std::span<const HalfEdge> sides) {
      if (!IsBorder(sides)) return;
      const std::uint32_t low = sides[0].low, high = sides[0].high;
      // An edge that loses an end is told from its end that stays; one that loses both, not at all.
      std::uint32_t from = low, to = high;
      if (IsSuperfluous(low)) std::swap(from, to);
      if (IsSuperfluous(from)) return;
      const std::uint32_t end = EndOf(from, to);
      // Both ends of a merged edge tell it; the lower one is heard.
      if (end != to && from > end) return;
      std::vector<std::uint32_t> regions;
      for (const HalfEdge& side : sides) regions.push_back(regions_.Root(side.triangle));
      std::sort(regions.begin(), regions.end());
      for (std::size_t i = 0; i < regions.size(); ++i) {
        if (i > 0 && regions[i] == regions[i - 1]) continue;
        const auto times = std::count(regions.begin(), regions.end(), regions[i]);
        borders[regions[i]].push_back({from, end, times % 2 == 0});
      }
    });
    // Corners inside a region at which another one touches it stay.
    for (const SurfacePiece& piece : pieces_) {
      const std::uint32_t region = regions_.Root(static_cast<std::uint32_t>(&piece - &pieces_[0]));
      for (const std::uint32_t c : piece.corners) {
        if (IsWithin(region, c) && corners_[c].other != kNone)
          borders[region].push_back({c, c, true});
      }
    }
    return borders;
  }

  const Arrangement& arrangement_;
  std::vector<SurfacePiece> pieces_;
  std::vector<HalfEdge> sides_;
  UnionFind regions_;
  std::vector<Corner> corners_;
  std::unordered_set<std::uint64_t> on_border_;  // regions with their borders' corners
};

}  // namespace

std::vector<SurfacePiece> MergePlanes(const Arrangement& arrangement,
                                      std::vector<SurfacePiece> pieces) {
  return PlaneMerge(arrangement, std::move(pieces)).Merged();
}

}  // namespace tranos::geom
