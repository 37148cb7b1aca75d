// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "geom/arc.h"
#include "geom/facet_count.h"
#include "geom/faceted_curve.h"
#include "geom/skin.h"
#include "geom/swept_solid.h"

namespace tranos::geom {
namespace {

// The outline's points about the axis: their feet on it and the way out from there.
struct AboutAxis {
  Vec3 axis;  // unit
  std::vector<Vec3> feet, out;
  double largest_radius_m = 0;
};

Result<AboutAxis> PlaceAboutAxis(const Outline& outline, const Vec3& axis_point, const Vec3& axis) {
  const Frame& plane = outline.plane;
  if (std::abs(plane.z().dot(axis)) > 1e-9 ||
      std::abs(plane.ToLocal(axis_point).z()) > kOffPlane_m) {
    return tl::unexpected(
        Error{ErrorCode::kNotPlanar, "the axis does not lie in the outline's plane"});
  }
  const Vec3 across = plane.z().cross(axis).normalized();
  AboutAxis about{axis, {}, {}, 0};
  double least = 0, most = 0;
  for (const Vec3& point : outline.points) {
    const Vec3 d = point - axis_point;
    const double radius_m = d.dot(across);
    least = std::min(least, radius_m), most = std::max(most, radius_m);
    const Vec3 foot = axis_point + d.dot(axis) * axis;
    // What lies on the axis but for rounding is one point all round.
    const bool on_axis = std::abs(radius_m) <= kCoincident_m;
    about.feet.push_back(foot);
    about.out.push_back(on_axis ? Vec3(Vec3::Zero()) : Vec3(point - foot));
  }
  if (std::min(-least, most) > kCoincident_m) {
    return tl::unexpected(Error{ErrorCode::kOutOfRange, "the outline crosses the axis"});
  }
  about.largest_radius_m = std::max(-least, most);
  return about;
}

std::vector<Vec3> Turned(const AboutAxis& about, double angle_rad) {
  const CosSin turn = ExactCosSin(angle_rad);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < about.feet.size(); ++i) {
    const Vec3& out = about.out[i];
    points.push_back(about.feet[i] + turn.cos * out + turn.sin * about.axis.cross(out));
  }
  return points;
}

}  // namespace

Result<TriangleMesh> RevolutionMesh(const std::vector<Curve>& outline, const Vec3& axis_point,
                                    const Vec3& axis_direction, double angle_rad,
                                    const Tolerance& given) {
  if (!(axis_direction.norm() > 0) || !axis_direction.allFinite()) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "the axis has no direction"});
  }
  if (!(angle_rad > 0 && angle_rad <= 2 * kPi * (1 + 1e-12))) {
    return tl::unexpected(
        Error{ErrorCode::kOutOfRange, "the angle is not between zero and a full turn"});
  }
  Result<Outline> face = OutlineOf(outline, given);
  const bool round = face && IsRound(*face);
  const Tolerance tolerance = round ? Halved(given) : given;
  if (round) face = OutlineOf(outline, tolerance);
  if (!face) return tl::unexpected(face.error());
  const auto about = PlaceAboutAxis(*face, axis_point, axis_direction.normalized());
  if (!about) return tl::unexpected(about.error());
  const bool full = angle_rad >= 2 * kPi * (1 - 1e-12);
  const double sweep_rad = full ? 2 * kPi : angle_rad;
  const double count = full ? FullTurnFacets(about->largest_radius_m, tolerance)
                            : ArcFacets(about->largest_radius_m, sweep_rad, tolerance);
  if (!(count * static_cast<double>(face->points.size()) < static_cast<double>(kMostSkinPoints))) {
    return tl::unexpected(
        Error{ErrorCode::kTooLarge, "the tolerance asks for more than a million points"});
  }
  Stations stations;
  stations.closed = full;
  for (double i = 0; i < (full ? count : count + 1); ++i) {
    stations.points.push_back(Turned(*about, sweep_rad * i / count));
  }
  stations.runs.assign(static_cast<std::size_t>(count), 0);
  return SkinOf(*face, stations);
}

}  // namespace tranos::geom
