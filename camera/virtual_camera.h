// SPDX-License-Identifier: GPL-3.0-or-later
// The virtual camera (the paper's Fig. 4, Step F, and Fig. 5): a model's edges as any camera, skew
// included, sees them, and how far they miss what was traced.
#pragma once

#include <span>
#include <vector>

#include "camera/camera.h"
#include "camera/image_line.h"

namespace tranos::camera {

// A polyline of the world as dots: the parts of it that are at least `near_m` before the camera,
// each in its order. Straight edges stay straight, so no dots are added between.
std::vector<std::vector<Vec2>> ProjectPolyline(const Camera&, const Frame&,
                                               std::span<const Vec3> points_in_world_m,
                                               double near_m = 1e-3);

// An edge of the model with the line that was traced along it, its ends anywhere on it.
struct TracedEdge {
  ImageLine line;
  Vec3 from_in_world_m;
  Vec3 to_in_world_m;
};

// From the ends of the traced line, square across, to the line that the projected edge is on.
struct Discrepancy {
  Vec2 at_a_px;
  Vec2 at_b_px;
};
// Error kDegenerate: the edge is seen as a dot, or lies behind the camera.
geom::Result<Discrepancy> DiscrepancyOf(const Camera&, const Frame&, const TracedEdge&);

// The penalty of Step F: the sum, over the edges, of the squares of the discrepancy at the traced
// line's centre and of the difference of those at its ends, each over its deviation (see
// ImageLine). Where camera and edges are right it is about twice the number of edges. Errors of
// DiscrepancyOf, with `part` the edge.
geom::Result<double> Penalty(const Camera&, const Frame&, std::span<const TracedEdge>);

// A camera with one parameter moved by `step` (mm, rad or m, as the parameter is), and the penalty
// before and after (Fig. 5). Errors of Penalty; kOutOfRange: the step leaves no camera (f or aspect
// not above 0, the skew angle not between 0 and π).
struct Step {
  Camera camera;
  double penalty_before;
  double penalty_after;
};
geom::Result<Step> StepCamera(const Camera&, const Frame&, std::span<const TracedEdge>, Parameter,
                              double step);

}  // namespace tranos::camera
