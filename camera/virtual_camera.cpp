// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/virtual_camera.h"

#include <cmath>

namespace tranos::camera {
namespace {

using geom::Error;
using geom::ErrorCode;

// The dot's homogeneous coordinates; the third is the depth in metres.
Vec3 Seen(const ProjectionMatrix& dot_from_world, const Vec3& point_in_world_m) {
  return dot_from_world * point_in_world_m.homogeneous();
}

// Depth is linear along an edge, and so are homogeneous coordinates.
Vec3 AtDepth(const Vec3& a, const Vec3& b, double depth_m) {
  return a + (depth_m - a.z()) / (b.z() - a.z()) * (b - a);
}

// The line with a unit normal through two seen points.
geom::Result<Vec3> LineThrough(const Vec3& a, const Vec3& b) {
  const Vec3 line = a.cross(b);
  const double normal = line.head<2>().norm();
  // Of the size of the rounding of the product: both points lie on one ray.
  if (!(normal > 1e-12 * a.norm() * b.norm())) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "the camera sees the edge as a dot"});
  }
  return Vec3(line / normal);
}

// Signed distances of a traced line's ends from the line of the projected edge.
struct Miss {
  Vec2 normal;
  double a_px;
  double b_px;
};

geom::Result<Miss> MissOf(const ProjectionMatrix& dot_from_world, const TracedEdge& edge) {
  const Vec3 from = Seen(dot_from_world, edge.from_in_world_m);
  const Vec3 to = Seen(dot_from_world, edge.to_in_world_m);
  if (from.z() <= 0 && to.z() <= 0) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "the edge lies behind the camera"});
  }
  return LineThrough(from, to).map([&](const Vec3& line) {
    return Miss{line.head<2>(), line.dot(edge.line.a_px.homogeneous()),
                line.dot(edge.line.b_px.homogeneous())};
  });
}

bool IsCamera(const Camera& camera) {
  return camera.parameters.allFinite() && camera[kFocal] > 0 && camera[kAspect] > 0 &&
         camera[kSkew] > 0 && camera[kSkew] < kPi;
}

}  // namespace

std::vector<std::vector<Vec2>> ProjectPolyline(const Camera& camera, const Frame& frame,
                                               std::span<const Vec3> points_in_world_m,
                                               double near_m) {
  const ProjectionMatrix dot_from_world = DotFromWorld(camera, frame);
  std::vector<std::vector<Vec2>> parts;
  bool is_open = false;
  const auto add = [&](const Vec3& seen) {
    if (!is_open) parts.emplace_back();
    is_open = true;
    parts.back().push_back(seen.hnormalized());
  };
  Vec3 last = Vec3::Zero();
  for (std::size_t i = 0; i < points_in_world_m.size(); ++i) {
    const Vec3 seen = Seen(dot_from_world, points_in_world_m[i]);
    const bool is_before = seen.z() >= near_m;
    if (i > 0 && is_before != (last.z() >= near_m)) add(AtDepth(last, seen, near_m));
    if (is_before) add(seen);
    if (!is_before) is_open = false;
    last = seen;
  }
  return parts;
}

geom::Result<Discrepancy> DiscrepancyOf(const Camera& camera, const Frame& frame,
                                        const TracedEdge& edge) {
  return MissOf(DotFromWorld(camera, frame), edge).map([](const Miss& miss) {
    return Discrepancy{-miss.a_px * miss.normal, -miss.b_px * miss.normal};
  });
}

geom::Result<double> Penalty(const Camera& camera, const Frame& frame,
                             std::span<const TracedEdge> edges) {
  const ProjectionMatrix dot_from_world = DotFromWorld(camera, frame);
  double penalty = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto miss = MissOf(dot_from_world, edges[i]);
    if (!miss) {
      return tl::unexpected(Error{miss.error().code, miss.error().detail, static_cast<int>(i)});
    }
    const double centre = (miss->a_px + miss->b_px) / 2 / edges[i].line.centre_sigma_px;
    const double tilt = (miss->b_px - miss->a_px) / edges[i].line.tilt_sigma_px;
    penalty += centre * centre + tilt * tilt;
  }
  return penalty;
}

geom::Result<Step> StepCamera(const Camera& camera, const Frame& frame,
                              std::span<const TracedEdge> edges, Parameter parameter, double step) {
  Camera moved = camera;
  moved[parameter] += step;
  if (!IsCamera(moved)) {
    return tl::unexpected(Error{ErrorCode::kOutOfRange, "the step leaves no camera"});
  }
  const auto before = Penalty(camera, frame, edges);
  if (!before) return tl::unexpected(before.error());
  return Penalty(moved, frame, edges).map([&](double after) {
    return Step{moved, *before, after};
  });
}

}  // namespace tranos::camera
