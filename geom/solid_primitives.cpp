// SPDX-License-Identifier: GPL-3.0-or-later
// The simple solids, each as an outline that is projected or turned.
#include "geom/solid_primitives.h"

#include <cmath>

#include "geom/swept_solid.h"

namespace tranos::geom {
namespace {

bool IsNothing(double size_m) { return !(std::abs(size_m) > kCoincident_m); }

tl::unexpected<Error> Degenerate(const char* detail) {
  return tl::unexpected(Error{ErrorCode::kDegenerate, detail});
}

Curve PolygonIn(const Frame& frame, const std::vector<Vec3>& corners) {
  Polyline polygon;
  polygon.closed = true;
  for (const Vec3& corner : corners) polygon.vertices.push_back(frame.ToWorld(corner));
  return polygon;
}

}  // namespace

Result<TriangleMesh> SlabMesh(const Frame& frame, const Vec3& size) {
  for (const double s : size) {
    if (IsNothing(s)) return Degenerate("one of its sizes is nothing");
  }
  const Curve base =
      PolygonIn(frame, {{0, 0, 0}, {size.x(), 0, 0}, {size.x(), size.y(), 0}, {0, size.y(), 0}});
  return ProjectionMesh({base}, size.z() * frame.z(), {});
}

Result<TriangleMesh> WedgeMesh(const Frame& frame, const Vec3& size) {
  for (const double s : size) {
    if (IsNothing(s)) return Degenerate("one of its sizes is nothing");
  }
  const Curve side = PolygonIn(frame, {{0, 0, 0}, {size.x(), 0, 0}, {size.x(), 0, size.z()}});
  return ProjectionMesh({side}, size.y() * frame.y, {});
}

Result<TriangleMesh> CylinderMesh(const Frame& frame, double radius_m, double height_m,
                                  const Tolerance& tolerance) {
  if (IsNothing(radius_m)) return Degenerate("the radius is nothing");
  if (IsNothing(height_m)) return Degenerate("the height is nothing");
  return ProjectionMesh({Circle{frame, radius_m}}, height_m * frame.z(), tolerance);
}

Result<TriangleMesh> ConeMesh(const Frame& frame, double radius_m, double top_radius_m,
                              double height_m, const Tolerance& tolerance) {
  if (IsNothing(radius_m) && IsNothing(top_radius_m)) return Degenerate("both radii are nothing");
  if (IsNothing(height_m)) return Degenerate("the height is nothing");
  std::vector<Vec3> corners = {{0, 0, 0}};
  if (!IsNothing(radius_m)) corners.emplace_back(radius_m, 0, 0);
  if (!IsNothing(top_radius_m)) corners.emplace_back(top_radius_m, 0, height_m);
  corners.emplace_back(0, 0, height_m);
  return RevolutionMesh({PolygonIn(frame, corners)}, frame.origin, frame.z(), 2 * kPi, tolerance);
}

Result<TriangleMesh> SphereMesh(const Frame& frame, double radius_m, const Tolerance& tolerance) {
  if (IsNothing(radius_m)) return Degenerate("the radius is nothing");
  const Arc meridian = {{frame.origin, -frame.z(), frame.x}, radius_m, kPi};
  const Line axis = {PointAt(Curve(meridian), 1), PointAt(Curve(meridian), 0)};
  return RevolutionMesh({Chain{{meridian, axis}, true}}, frame.origin, frame.z(), 2 * kPi,
                        tolerance);
}

Result<TriangleMesh> TorusMesh(const Frame& frame, double radius_m, double tube_radius_m,
                               double angle_rad, const Tolerance& tolerance) {
  if (IsNothing(radius_m)) return Degenerate("the radius is nothing");
  if (IsNothing(tube_radius_m)) return Degenerate("the tube's radius is nothing");
  if (!(tube_radius_m < radius_m - kCoincident_m)) {
    return tl::unexpected(Error{ErrorCode::kOutOfRange, "the tube reaches the axis"});
  }
  const Frame section = {frame.origin + radius_m * frame.x, frame.x, frame.z()};
  return RevolutionMesh({Circle{section, tube_radius_m}}, frame.origin, frame.z(), angle_rad,
                        tolerance);
}

}  // namespace tranos::geom
