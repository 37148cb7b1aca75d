// SPDX-License-Identifier: GPL-3.0-or-later
// The simulated cuboid of the paper's Section 6: its cameras, what is seen of it, its traces with
// noise, and the Cramér–Rao bounds. Figures: benchmarks/cuboid.json.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "camera/traces.h"

namespace tranos::camera::benchmark {

enum Picture : int { kHi, kLo };  // 1600 × 1067 and 484 × 319, square pixels
// Points of the frame in units of the pitch of `kHi` from the centre, vertices in order of their
// index.
using GoldenVertices = std::array<Vec2, 8>;

struct Cuboid {
  std::string_view name;
  Camera truth;
  Vec3 dimensions_m;
  Vec3 offset_m;  // of vertex 0
  GoldenVertices golden;
  // Smallest deviations for σ = 1 px, by `Picture`, of the visible edges; zero where these do not
  // determine the camera.
  std::array<ParameterVector, 2> bound;

  bool determined() const { return bound[kHi][kFocal] > 0; }
};

// B1 to B4, L1 to L3.
const std::vector<Cuboid>& Cuboids();
const Cuboid& CuboidOf(std::string_view name);
Frame FrameOf(Picture);

// Bits 2, 1, 0 of the index say whether a vertex is at the far end in X, Y, Z.
Vec3 Vertex(int index, const Vec3& dimensions_m, const Vec3& offset_m);

struct CuboidEdge {
  int from, to;  // vertices
  int axis;
};
// Edges of the faces whose outside the camera sees, whole, whether in the picture or not.
std::vector<CuboidEdge> VisibleEdges(const Cuboid&);

struct Segment {
  Vec2 a_px, b_px;
};
Segment ExactSegment(const Cuboid&, const CuboidEdge&, const Frame&);
// Pixels that an edge is observed by: ⌊length⌋, at least 2.
double SamplesOf(double length_px);

struct Tracing {
  Picture picture = kHi;
  double sigma_px = 0;  // with 0, traces are exact and declared with 0.5
  std::uint64_t seed = 1;
  bool edges = true;           // as EdgeTrace
  bool directions = false;     // as DirectionTrace
  double dimension_sigma = 0;  // relative; above 0, the dimensions are drawn and are unknowns
};
// The visible edges as traced, and the numbers: three for each vertex.
struct TracedCuboid {
  Photograph photograph;
  Numbers numbers;
  std::vector<Unknown> unknowns;  // the dimensions, or none
  Vec3 dimensions_m;              // as believed
};
TracedCuboid TraceCuboid(const Cuboid&, const Tracing&);
// Its vertices of these indices as control points, exact, in the frame `hi`.
TracedCuboid TracePoints(const Cuboid&, const std::vector<int>& vertices);
// The numbers for other dimensions, with derivatives by as many unknowns: 0 or 3.
Numbers NumbersOf(const Cuboid&, const Vec3& dimensions_m, int unknowns);

}  // namespace tranos::camera::benchmark
