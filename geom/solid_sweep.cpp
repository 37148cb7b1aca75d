// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/LU>
#include <cmath>

#include "geom/facet_count.h"
#include "geom/faceted_curve.h"
#include "geom/skin.h"
#include "geom/swept_solid.h"

namespace tranos::geom {
namespace {

// How the outline's x and y stand at each corner of the path; mitres stretch them.
struct Axes {
  Vec3 x, y;
};

tl::unexpected<Error> TooTight() {
  return tl::unexpected(
      Error{ErrorCode::kOutOfRange, "the path turns too tightly for the outline, or turns back"});
}

// The normal of the plane in which the outline stands at a corner: halfway between the path's
// directions before and after.
Vec3 MitreNormal(const FacetCorner& corner) { return (corner.in + corner.out).normalized(); }

class Sweeper {
 public:
  Sweeper(const FacetedCurve& path, const Outline& outline, std::vector<Vec2> points)
      : path_(path), outline_(outline), points_(std::move(points)) {}

  Result<TriangleMesh> Sweep(const Axes& start) {
    if (static_cast<double>(path_.corners.size()) * static_cast<double>(points_.size()) >
        static_cast<double>(kMostSkinPoints)) {
      return tl::unexpected(
          Error{ErrorCode::kTooLarge, "the tolerance asks for more than a million points"});
    }
    if (!Carry(start)) return TooTight();
    Stations stations;
    const SmoothRuns runs = SmoothRunsOf(path_);
    stations.runs = runs.of_facet;
    stations.run_count = runs.count;
    stations.closed = path_.closed;
    for (std::size_t k = 0; k < path_.corners.size(); ++k) stations.points.push_back(StationAt(k));
    if (!GoesForward(stations)) return TooTight();
    return MayCross(SkinOf(outline_, stations));
  }

 private:
  std::size_t After(std::size_t k) const { return (k + 1) % path_.corners.size(); }
  Vec3 Chord(std::size_t k) const {
    return (path_.corners[After(k)].point - path_.corners[k].point).normalized();
  }

  // `v`, a vector of corner k's plane, carried along the facet that follows into the next plane.
  static Vec3 Carried(const Vec3& v, const Vec3& along, const Vec3& normal) {
    return v - v.dot(normal) / along.dot(normal) * along;
  }

  bool Carry(Axes axes) {
    const FacetCorner& first = path_.corners[0];
    if (path_.closed) {
      const Vec3 normal = MitreNormal(first);
      if (!(first.out.dot(normal) > 1e-6)) return false;
      axes = {Carried(axes.x, first.out, normal), Carried(axes.y, first.out, normal)};
    }
    axes_ = {axes};
    for (std::size_t k = 0; k < path_.FacetCount(); ++k) {
      const Vec3 along = Chord(k), normal = MitreNormal(path_.corners[After(k)]);
      if (!normal.allFinite() || !(along.dot(normal) > 1e-6)) return false;
      axes = {Carried(axes.x, along, normal), Carried(axes.y, along, normal)};
      if (k + 1 < path_.corners.size()) axes_.push_back(axes);
    }
    if (path_.closed) FindTwist(axes);
    return true;
  }

  // The turn within the first plane by which the outline comes home askew.
  void FindTwist(const Axes& home) {
    const auto along = [&](const Vec3& v, const Axes& axes) {
      Eigen::Matrix<double, 3, 2> basis;
      basis << axes.x, axes.y;
      return Vec2((basis.transpose() * basis).inverse() * (basis.transpose() * v));
    };
    const Vec2 x = along(home.x, axes_[0]);
    const double twist_rad = std::atan2(x.y(), x.x());
    if (std::abs(twist_rad) < 1e-9) return;
    double whole_m = 0;
    for (std::size_t k = 0; k < path_.FacetCount(); ++k) {
      lengths_m_.push_back(whole_m);
      whole_m += (path_.corners[After(k)].point - path_.corners[k].point).norm();
    }
    twist_rad_per_m_ = -twist_rad / whole_m;
  }

  std::vector<Vec3> StationAt(std::size_t k) const {
    const double twist_rad = lengths_m_.empty() ? 0 : twist_rad_per_m_ * lengths_m_[k];
    const double c = std::cos(twist_rad), s = std::sin(twist_rad);
    const Axes& axes = axes_[k];
    std::vector<Vec3> station;
    for (const Vec2& p : points_) {
      station.push_back(path_.corners[k].point + (c * p.x() - s * p.y()) * axes.x +
                        (s * p.x() + c * p.y()) * axes.y);
    }
    return station;
  }

  // Whether every point of the outline moves on along every facet.
  bool GoesForward(const Stations& stations) const {
    for (std::size_t k = 0; k < path_.FacetCount(); ++k) {
      const Vec3 along = Chord(k);
      const auto &from = stations.points[k], &to = stations.points[After(k)];
      for (std::size_t i = 0; i < points_.size(); ++i) {
        if (!((to[i] - from[i]).dot(along) > kCoincident_m)) return false;
      }
    }
    return true;
  }

  const FacetedCurve& path_;
  const Outline& outline_;
  std::vector<Vec2> points_;
  std::vector<Axes> axes_;
  std::vector<double> lengths_m_;  // along the path to each corner, where there is a twist
  double twist_rad_per_m_ = 0;
};

struct Faceted {
  FacetedCurve path;
  Outline outline;
};
Result<Faceted> FacetedOf(const std::vector<Curve>& outline, const Curve& path,
                          const Tolerance& tolerance) {
  Result<FacetedCurve> along = FacetsOf(path, tolerance);
  if (!along) {
    return tl::unexpected(Error{along.error().code, "of the path, " + along.error().detail});
  }
  Result<Outline> face = OutlineOf(outline, tolerance);
  if (!face) return tl::unexpected(face.error());
  return Faceted{*std::move(along), *std::move(face)};
}
Result<Faceted> PrepareSweep(const std::vector<Curve>& outline, const Curve& path,
                             const Tolerance& tolerance) {
  Result<Faceted> faceted = FacetedOf(outline, path, tolerance);
  if (!faceted || !IsRound(faceted->outline)) return faceted;
  return FacetedOf(outline, path, Halved(tolerance));
}

}  // namespace

Result<TriangleMesh> SweepMesh(const std::vector<Curve>& outline_at_origin, const Curve& path,
                               const Vec3& up, const Tolerance& tolerance) {
  const Result<Faceted> faceted = PrepareSweep(outline_at_origin, path, tolerance);
  if (!faceted) return tl::unexpected(faceted.error());
  const Vec3 along = faceted->path.corners[0].out;
  const Vec3 right = along.cross(up).normalized();
  if (!right.allFinite() || !(along.cross(up).norm() > 1e-9)) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "the path starts straight upward"});
  }
  std::vector<Vec2> points;
  for (const Vec3& p : faceted->outline.points) points.emplace_back(p.head<2>());
  return Sweeper(faceted->path, faceted->outline, std::move(points))
      .Sweep({right, right.cross(along)});
}

Result<TriangleMesh> SweepMeshInPlace(const std::vector<Curve>& outline, const Curve& path,
                                      const Tolerance& tolerance) {
  const Result<Faceted> faceted = PrepareSweep(outline, path, tolerance);
  if (!faceted) return tl::unexpected(faceted.error());
  const Frame& plane = faceted->outline.plane;
  std::vector<Vec2> points;
  for (const Vec3& p : faceted->outline.points) {
    const Vec3 d = p - faceted->path.corners[0].point;
    points.emplace_back(d.dot(plane.x), d.dot(plane.y));
  }
  return Sweeper(faceted->path, faceted->outline, std::move(points)).Sweep({plane.x, plane.y});
}

bool StandsAtStart(const Curve& outline, const Curve& path) {
  const std::optional<Frame> plane = PlaneOf(outline);
  if (!plane) return false;
  return std::abs(plane->ToLocal(PointAt(path, 0)).z()) <= kOffPlane_m &&
         TangentAt(path, 0).cross(plane->z()).norm() <= 1e-6;
}

}  // namespace tranos::geom
