// SPDX-License-Identifier: GPL-3.0-or-later
// The three orthogonal directions of a building, found among the lines of its photograph.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "camera/camera.h"
#include "camera/image_line.h"

namespace tranos::camera {

struct DirectionSearch {
  // How far edges of one direction are from parallel on a building, rad, one standard deviation.
  double parallel_rad = 0.3 * kPi / 180;
  std::uint64_t seed = 1;  // of the pairs of lines that are tried
};

// The line as one of its direction: less sure than it was seen, by how far a building's edges are
// from parallel.
ImageLine AsParallel(ImageLine line, double parallel_rad);

inline constexpr int kNoAxis = -1;

struct VanishingDirections {
  // A camera that has them: the lines' likeliest under the priors of `prior default`. Its focal
  // length may be as good as arbitrary, where the building is seen squarely.
  Camera camera;
  std::vector<int> axis;          // of each line: 0, 1, 2 for X, Y, Z, or kNoAxis
  std::array<int, 3> lines{};     // how many are of each axis
  std::array<bool, 3> is_seen{};  // more of them than by chance; the third follows from two

  int directions() const { return is_seen[0] + is_seen[1] + is_seen[2]; }
};

// The three orthogonal directions that most lines point along. Z is the one nearest to the upright
// of the picture, X the one of the others that is more across the line of sight, to the right, Y
// into the scene.
//
// Every line is of one of the three directions or of none. Its angle to the vanishing point, over
// the deviation that its own and `parallel_rad` make, is distributed as Student's t with three
// degrees of freedom; of a line of none all angles are alike. Vanishing points of pairs of lines,
// drawn by `seed`, that most lines point at are taken one after another for a first direction; for
// it and each of a range of focal lengths, nothing assumed about them, the lines vote for the turn
// about it that puts the other two. The best are refined by expectation and maximisation, all lines
// taking part by how probable their direction is, over the camera's parameters with the priors, and
// the likeliest is the answer. The same input and seed give the same bits.
//
// Error kDegenerate: fewer than two directions have more lines than chance would give them, of
// lines of all angles (a contrario).
geom::Result<VanishingDirections> FindVanishingDirections(std::span<const ImageLine> lines,
                                                          const Frame& frame,
                                                          const DirectionSearch& = {});

// The lines' axes, given the camera: that of the likeliest direction, or none.
std::vector<int> AxesOfLines(std::span<const ImageLine> lines, const Frame& frame,
                             const Camera& camera, double parallel_rad);

}  // namespace tranos::camera
