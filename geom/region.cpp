// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/region.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geom/crossing.h"
#include "geom/curve_pieces.h"
#include "geom/triangulate.h"
#include "geom/winding.h"

namespace tranos::geom {
namespace {

constexpr double kPlanar = 1e-9;  // of the size, or of a metre
// Chords that cross where their curves do not are made shorter by √10 each time.
constexpr int kMostRefinements = 6;

tl::unexpected<Error> Refuse(ErrorCode code, const char* detail, std::size_t part) {
  return tl::unexpected(Error{code, detail, static_cast<int>(part)});
}

bool LiesIn(const Curve& curve, const Frame& plane) {
  double size = 1;
  for (const Vec3& p : SpanningPoints(curve)) size = std::max(size, (p - plane.origin).norm());
  const double tolerance_m = kPlanar * size;
  for (const Vec3& p : SpanningPoints(curve)) {
    if (std::abs(plane.ToLocal(p).z()) > tolerance_m) return false;
  }
  return true;
}

// Whether an end of one's pieces lies on the other: stretches in common begin and end there.
bool EndsOn(const Curve& a, const Curve& b) {
  bool found = false;
  ForEachPiece(a, [&](const auto& piece, double, double) {
    found = found || NearestPoint(b, JetOf(piece, 0).point).distance_m <= kMeeting_m;
  });
  return found;
}

bool Touch(const Curve& a, const Curve& b) {
  return !Crossings(a, b).empty() || EndsOn(a, b) || EndsOn(b, a);
}

bool Meet(const Box& a, const Box& b) {
  return ((a.min - b.max).array() <= kMeeting_m).all() &&
         ((b.min - a.max).array() <= kMeeting_m).all();
}

// The outlines whose boxes meet, as pairs of indices, the lower one first.
std::vector<std::pair<std::size_t, std::size_t>> MeetingPairs(const std::vector<Box>& boxes) {
  Box all;
  for (const Box& box : boxes) all.Add(box);
  int axis = 0;
  (all.max - all.min).maxCoeff(&axis);
  std::vector<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return boxes[i].min[axis] < boxes[j].min[axis];
  });
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const Box& box = boxes[order[k]];
    for (std::size_t next = k + 1; next < order.size(); ++next) {
      const Box& other = boxes[order[next]];
      if (other.min[axis] > box.max[axis] + kMeeting_m) break;
      if (Meet(box, other)) pairs.push_back(std::minmax(order[k], order[next]));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

// Whether the outline is free of self-crossings is seen from its facets.
tl::expected<void, Error> CheckSimple(const Curve& outline, const Frame& plane, std::size_t part) {
  const Box box = BoundingBox(outline);
  const Tolerance tolerance = {1e-4 * (box.max - box.min).norm()};
  const auto facets = Triangulate(Region{plane, {{outline, {}}}}, tolerance);
  if (facets) return {};
  return tl::unexpected(Error{ErrorCode::kDegenerate, "an outline crosses or touches itself",
                              static_cast<int>(part)});
}

// The frame of the first outline's plane.
Result<Frame> CheckOutlines(const std::vector<Curve>& outlines) {
  Frame plane;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const Result<double> area = EnclosedArea(outlines[i]);
    if (!area) return tl::unexpected(Error{area.error().code, area.error().detail, int(i)});
    const Box box = BoundingBox(outlines[i]);
    const double size = (box.max - box.min).norm();
    const std::optional<Frame> own = PlaneOf(outlines[i]);  // none for what is all but a point
    if (!own || !(*area > 1e-12 * size * size)) {
      return Refuse(ErrorCode::kDegenerate, "an outline encloses nothing", i);
    }
    if (i == 0) {
      plane = *own;
    } else if (!LiesIn(outlines[i], plane)) {
      return Refuse(ErrorCode::kNotPlanar, "the outlines do not lie in one plane", i);
    }
    if (auto simple = CheckSimple(outlines[i], plane, i); !simple) {
      return tl::unexpected(simple.error());
    }
  }
  return plane;
}

// For each outline those that surround it; an error if two touch. As they do not, one lies in
// another if one of its points does.
Result<std::vector<std::vector<std::size_t>>> NestingOf(const std::vector<Curve>& outlines,
                                                        const Frame& plane) {
  std::vector<Box> boxes;
  for (const Curve& outline : outlines) boxes.push_back(BoundingBox(outline));
  std::vector<std::vector<std::size_t>> around(outlines.size());
  for (const auto& [i, j] : MeetingPairs(boxes)) {
    if (Touch(outlines[i], outlines[j])) {
      return Refuse(ErrorCode::kDegenerate, "two outlines cross or touch one another", j);
    }
    if (WindingNumber(outlines[j], plane, PointAt(outlines[i], 0)) != 0) around[i].push_back(j);
    if (WindingNumber(outlines[i], plane, PointAt(outlines[j], 0)) != 0) around[j].push_back(i);
  }
  return around;
}

Curve Directed(const Curve& outline, const Frame& plane, bool counter_clockwise) {
  const bool is = PlaneOf(outline)->z().dot(plane.z()) > 0;
  return is == counter_clockwise ? outline : Reversed(outline);
}

// Facets once for a tolerance; kDegenerate where chords cross.
Result<RegionFacets> TriangulateOnce(const Region& region, const Tolerance& tolerance) {
  RegionFacets facets;
  std::vector<std::vector<Vec2>> loops;
  std::optional<Error> error;
  ForEachOutline(region, [&](const Curve& outline, bool is_hole) {
    if (error) return;
    const auto points = Tessellate(outline, tolerance);
    if (!points) {
      error = points.error();
      return;
    }
    const auto begin = static_cast<std::uint32_t>(facets.positions.size());
    facets.positions.insert(facets.positions.end(), points->begin(), points->end());
    facets.loops.push_back({begin, static_cast<std::uint32_t>(facets.positions.size()), is_hole});
    std::vector<Vec2>& loop = loops.emplace_back();
    for (const Vec3& p : *points) loop.push_back(region.plane.ToLocal(p).head<2>());
  });
  if (error) return tl::unexpected(*error);
  auto triangles = TriangulatePolygon(loops);
  if (!triangles) return tl::unexpected(triangles.error());
  facets.triangles = *std::move(triangles);
  return facets;
}

bool IsStraight(const Region& region) {
  bool straight = true;
  ForEachOutline(region, [&](const Curve& outline, bool) {
    ForEachPiece(outline, [&](const auto& piece, double, double) {
      straight = straight && std::is_same_v<std::decay_t<decltype(piece)>, Line>;
    });
  });
  return straight;
}

}  // namespace

Result<Region> RegionOf(const std::vector<Curve>& outlines) {
  if (outlines.empty()) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "there are no outlines"});
  }
  const Result<Frame> plane = CheckOutlines(outlines);
  if (!plane) return tl::unexpected(plane.error());
  const auto nesting = NestingOf(outlines, *plane);
  if (!nesting) return tl::unexpected(nesting.error());
  const std::vector<std::vector<std::size_t>>& around = *nesting;
  const std::size_t count = outlines.size();
  Region region{*plane, {}};
  std::vector<std::size_t> part_of(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (around[i].size() % 2 != 0) continue;
    part_of[i] = region.parts.size();
    region.parts.push_back({Directed(outlines[i], *plane, true), {}});
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (around[i].size() % 2 == 0) continue;
    // The innermost outline around the hole is the one with all others around it.
    const std::size_t outer = *std::max_element(
        around[i].begin(), around[i].end(),
        [&](std::size_t a, std::size_t b) { return around[a].size() < around[b].size(); });
    region.parts[part_of[outer]].holes.push_back(Directed(outlines[i], *plane, false));
  }
  return region;
}

double Area(const Region& region) {
  double sum = 0;
  ForEachOutline(region, [&](const Curve& outline, bool is_hole) {
    sum += (is_hole ? -1 : 1) * EnclosedArea(outline).value_or(0);
  });
  return sum;
}

double Perimeter(const Region& region) {
  double sum = 0;
  ForEachOutline(region, [&](const Curve& outline, bool) { sum += Length(outline); });
  return sum;
}

Vec3 Centroid(const Region& region) {
  Vec3 moment = Vec3::Zero();
  double sum = 0;
  ForEachOutline(region, [&](const Curve& outline, bool is_hole) {
    const double area = (is_hole ? -1 : 1) * EnclosedArea(outline).value_or(0);
    moment += area * (Centroid(outline).value_or(region.plane.origin) - region.plane.origin);
    sum += area;
  });
  return sum > 0 ? Vec3(region.plane.origin + moment / sum) : region.plane.origin;
}

Box BoundingBox(const Region& region) {
  Box box;
  for (const Region::Part& part : region.parts) box.Add(BoundingBox(part.outer));
  return box;
}

bool Contains(const Region& region, const Vec3& p) {
  int turns = 0;  // an outer outline turns once about what it holds, a hole back again
  ForEachOutline(region, [&](const Curve& outline, bool) {
    turns += WindingNumber(outline, region.plane, p);
  });
  return turns != 0;
}

Nearest NearestPoint(const Region& region, const Vec3& p) {
  const double height_m = region.plane.ToLocal(p).z();
  if (Contains(region, p)) return {p - height_m * region.plane.z(), std::abs(height_m), 0};
  Nearest best;
  best.distance_m = std::numeric_limits<double>::infinity();
  ForEachOutline(region, [&](const Curve& outline, bool) {
    const Nearest nearest = NearestPoint(outline, p);
    if (nearest.distance_m < best.distance_m) best = nearest;
  });
  return best;
}

Region Transformed(const Region& region, const Affine& m) {
  Region image;
  // Seen from the cross product of the axes' images, outlines run as before, mirrored or not.
  const Vec3 x = (m.linear() * region.plane.x).normalized(), y = m.linear() * region.plane.y;
  image.plane = {m * region.plane.origin, x, (y - y.dot(x) * x).normalized()};
  for (const Region::Part& part : region.parts) {
    Region::Part& target = image.parts.emplace_back(Region::Part{Transformed(part.outer, m), {}});
    for (const Curve& hole : part.holes) target.holes.push_back(Transformed(hole, m));
  }
  return image;
}

Result<RegionFacets> Triangulate(const Region& region, const Tolerance& tolerance) {
  Tolerance finer = tolerance;
  Result<RegionFacets> facets = TriangulateOnce(region, finer);
  const bool straight = IsStraight(region);
  for (int i = 0; i < kMostRefinements && !straight; ++i) {
    if (facets || facets.error().code != ErrorCode::kDegenerate) break;
    finer.chord_m *= 0.1;
    finer.facets_per_turn *= 3;
    facets = TriangulateOnce(region, finer);
  }
  return facets;
}

}  // namespace tranos::geom
