// SPDX-License-Identifier: GPL-3.0-or-later
// Closed curves of one plane as the facets of the face between them. Internal to geom.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/curve.h"

namespace tranos::geom {

// `triangles` fill the face, anticlockwise about the plane's normal; `sides` are its border, the
// face to their left. Sides of one smooth run have one surface number.
struct Outline {
  struct Side {
    std::uint32_t from, to, surface;
  };
  Frame plane;
  std::vector<Vec3> points;  // in the world
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Side> sides;
  std::uint32_t surface_count = 0;
};

// What is round in the outline and round in the way it is carried deviates twice: each by half the
// chord tolerance, then.
bool IsRound(const Outline&);
inline Tolerance Halved(const Tolerance& t) { return {0.5 * t.chord_m, t.facets_per_turn}; }

// More corners than these, of one outline and of a solid's whole skin, are refused (kTooLarge):
// they would take minutes.
inline constexpr std::size_t kMostOutlinePoints = 100'000;
inline constexpr std::size_t kMostSkinPoints = 1'000'000;

// A point of the outlines may lie this far off the plane of the first.
inline constexpr double kOffPlane_m = 1e-6;

// Curves inside others are holes, and islands in those. Errors name the curve by its index:
// kNotClosed, kNotPlanar, kDegenerate where they cross or touch along a side.
Result<Outline> OutlineOf(const std::vector<Curve>& loops, const Tolerance&);

}  // namespace tranos::geom
