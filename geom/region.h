// SPDX-License-Identifier: GPL-3.0-or-later
// Plane faces bounded by exact curves, with holes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/curve.h"
#include "geom/polygon_operation.h"

namespace tranos::geom {

// What lies inside the outer outlines and outside their holes. Seen from plane.z outer outlines
// run counter-clockwise and holes clockwise; parts share corners at most.
struct Region {
  struct Part {
    Curve outer;
    std::vector<Curve> holes;
  };
  Frame plane;
  std::vector<Part> parts;
};

// The region of closed curves in one plane, by their nesting: the inside of an outline that an odd
// number of others surround is a hole. The plane is the first one's, about which it runs
// counter-clockwise. Errors name the outline by its index: kNotClosed, kNotPlanar (not planar, or
// not in the first one's plane), kDegenerate (it encloses nothing, or crosses or touches itself or
// an earlier one).
Result<Region> RegionOf(const std::vector<Curve>& outlines);

// Calls f(outline, is_hole) for each, part by part, holes after their outer outline.
template <class F>
void ForEachOutline(const Region& region, const F& f) {
  for (const Region::Part& part : region.parts) {
    f(part.outer, false);
    for (const Curve& hole : part.holes) f(hole, true);
  }
}

double Area(const Region&);       // m²
double Perimeter(const Region&);  // m; of holes, too
Vec3 Centroid(const Region&);
Box BoundingBox(const Region&);
// Whether the foot of the perpendicular from p lies inside; on an outline either may come out.
bool Contains(const Region&, const Vec3& p);
Nearest NearestPoint(const Region&, const Vec3& p);
Region Transformed(const Region&, const Affine& target_from_source);

// A region's facets: the outlines' vertices alone, loop after loop, each loop in its outline's
// direction, and triangles counter-clockwise seen from plane.z. Where the chords of the tolerance
// would cross one another, a finer one is taken. kTooLarge beyond ten million vertices;
// kDegenerate where even then they cross.
struct RegionFacets {
  struct Loop {
    std::uint32_t begin, end;  // of its vertices in `positions`
    bool is_hole;
  };
  std::vector<Vec3> positions;
  std::vector<Loop> loops;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};
Result<RegionFacets> Triangulate(const Region&, const Tolerance&);

// The union of the regions `of`; what all of them have in common; or their union less that of the
// regions `by` (which is empty for the others). Regions lie in one plane, round outlines are
// followed by polygons within the tolerance; these are combined exactly and rounded once, so that
// the result has straight sides. Corners and sides nearer than 1e-9 m count as one. A result
// without parts is empty. kNotPlanar names the first region, of `of` and then of `by`, in another
// plane.
Result<Region> Combine(const std::vector<Region>& of, const std::vector<Region>& by, SetOperation,
                       const Tolerance&);

}  // namespace tranos::geom
