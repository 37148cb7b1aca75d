// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces that belong together: patches that nothing crosses, and regions of one plane. Internal to
// geom.
#pragma once

#include "geom/arrangement.h"

namespace tranos::geom {

// A piece of a solid's surface.
struct SurfacePiece {
  std::array<std::uint32_t, 3> corners;  // anticlockwise seen from outside
  std::uint32_t facet;
  std::uint32_t surface;
  bool turned;  // it looks against its facet
  bool up;      // it looks as the first facet of its plane does
};

// For every piece the first one of its patch: those that are reached from one another across edges
// where nothing else meets them.
std::vector<std::uint32_t> PatchesOf(const Arrangement& arrangement);

// The same surface in fewer pieces: those of one plane and one surface are merged, corners in the
// middle of straight edges left out.
std::vector<SurfacePiece> MergePlanes(const Arrangement& arrangement,
                                      std::vector<SurfacePiece> pieces);

}  // namespace tranos::geom
