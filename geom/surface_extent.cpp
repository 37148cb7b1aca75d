// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes of surfaces and the points of surfaces nearest to a point, by halving patches.
#include <algorithm>
#include <cmath>
#include <queue>

#include "geom/curve_pieces.h"
#include "geom/surface_patches.h"

namespace tranos::geom {
namespace {

constexpr int kMaxNodes = 4'000;
constexpr int kDeepest = 12;

template <class F>
void ForEachPole(const BezierPatch& patch, const F& f) {
  for (std::size_t i = 0; i < patch.rows.size(); ++i) {
    for (int j = 0; j < patch.rows[i].cols(); ++j) f(Projected(patch.rows[i].col(j)));
  }
}

// The axis's largest step between neighbouring poles, along u and along v: halving where it is
// greater brings the poles' hull to the surface sooner.
bool WiderAlongU(const BezierPatch& patch, const Vec3& weights) {
  double along_u = 0, along_v = 0;
  const int rows = static_cast<int>(patch.rows.size());
  const int columns = static_cast<int>(patch.rows[0].cols());
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const Vec3 at = Projected(patch.rows[i].col(j));
      auto step = [&](const Vec3& other) { return (other - at).cwiseAbs().dot(weights); };
      if (i + 1 < rows) along_u = std::max(along_u, step(Projected(patch.rows[i + 1].col(j))));
      if (j + 1 < columns) along_v = std::max(along_v, step(Projected(patch.rows[i].col(j + 1))));
    }
  }
  return along_u >= along_v;
}

double Highest(const BezierPatch& patch, int axis, double sign) {
  double highest = -std::numeric_limits<double>::infinity();
  ForEachPole(patch, [&](const Vec3& p) { highest = std::max(highest, sign * p[axis]); });
  return highest;
}

double HighestCorner(const BezierPatch& patch, int axis, double sign) {
  const auto last = patch.rows[0].cols() - 1;
  double highest = -std::numeric_limits<double>::infinity();
  for (const BezierPoles* row : {&patch.rows.front(), &patch.rows.back()}) {
    highest = std::max(
        {highest, sign * Projected(row->col(0))[axis], sign * Projected(row->col(last))[axis]});
  }
  return highest;
}

struct Bounded {
  double bound;
  BezierPatch patch;
  bool operator<(const Bounded& other) const { return bound < other.bound; }
};

// The largest of sign·coordinate over the patches, from `best` upwards: the patch whose poles
// reach highest is halved until none reaches above what a point of the surface has.
double LargestOver(const PatchGrid& grid, int axis, double sign, double slack) {
  double best = -std::numeric_limits<double>::infinity();
  for (const BezierPatch& patch : grid.patches) {
    best = std::max(best, HighestCorner(patch, axis, sign));
  }
  std::priority_queue<Bounded> open;
  for (const BezierPatch& patch : grid.patches) {
    const double bound = Highest(patch, axis, sign);
    if (bound > best + slack) open.push({bound, patch});
  }
  for (int nodes = 0; !open.empty(); ++nodes) {
    const Bounded top = open.top();
    open.pop();
    if (!(top.bound > best + slack)) break;
    if (nodes > kMaxNodes) return top.bound;
    const bool along_u = WiderAlongU(top.patch, Vec3::Unit(axis));
    for (const bool upper : {false, true}) {
      BezierPatch half = SplitOff(top.patch, along_u, upper);
      best = std::max(best, HighestCorner(half, axis, sign));
      const double bound = Highest(half, axis, sign);
      if (bound > best + slack) open.push({bound, std::move(half)});
    }
  }
  return best;
}

// A part of a patch, in natural parameters, and a distance that no point of it comes below.
struct Part {
  double at_least_m;
  double u0, u1, v0, v1;
  int depth;
  BezierPatch patch;
  bool operator<(const Part& other) const { return at_least_m > other.at_least_m; }
};

double LowerBound(const BezierPatch& patch, const Vec3& p) {
  Box box;
  ForEachPole(patch, [&](const Vec3& pole) { box.Add(pole); });
  return (p - p.cwiseMax(box.min).cwiseMin(box.max)).norm();
}

// Newton's method for the feet of perpendiculars, kept in the patch; falls back to a
// Gauss-Newton step where the distance is not convex.
Vec2 PolishedParameters(const BezierPatch& patch, const Vec3& p, Vec2 at) {
  for (int i = 0; i < 30; ++i) {
    const SurfaceJet jet = JetOf(patch, at.x(), at.y());
    const Vec3 off = jet.point - p;
    const Vec2 slope(off.dot(jet.du), off.dot(jet.dv));
    Eigen::Matrix2d gauss, hessian;
    gauss << jet.du.squaredNorm(), jet.du.dot(jet.dv), jet.du.dot(jet.dv), jet.dv.squaredNorm();
    hessian << off.dot(jet.duu), off.dot(jet.duv), off.dot(jet.duv), off.dot(jet.dvv);
    hessian += gauss;
    const bool convex = hessian(0, 0) > 0 && hessian.determinant() > 0;
    Eigen::Matrix2d used = convex ? hessian : gauss;
    used.diagonal().array() += 1e-14 * (used.trace() + 1e-300);
    // A parameter held at the border by the slope stays there.
    for (int k = 0; k < 2; ++k) {
      const bool held = (at[k] <= 0 && slope[k] > 0) || (at[k] >= 1 && slope[k] < 0);
      if (held) used.row(k).setZero(), used.col(k).setZero(), used(k, k) = 1;
    }
    Vec2 free_slope = slope;
    for (int k = 0; k < 2; ++k) {
      if ((at[k] <= 0 && slope[k] > 0) || (at[k] >= 1 && slope[k] < 0)) free_slope[k] = 0;
    }
    const double determinant = used.determinant();
    if (!(std::abs(determinant) > 0)) break;
    const Vec2 step((used(1, 1) * free_slope.x() - used(0, 1) * free_slope.y()) / determinant,
                    (used(0, 0) * free_slope.y() - used(1, 0) * free_slope.x()) / determinant);
    const Vec2 next = (at - step).cwiseMax(0.0).cwiseMin(1.0);
    if (!next.allFinite() || (next - at).norm() < 1e-16) break;
    at = next;
  }
  return at;
}

}  // namespace

Box BoundingBox(const Surface& surface) {
  Box box;
  const PatchGrid grid = PatchesOf(surface);
  if (grid.patches.empty()) return box;
  Box hull;
  for (const BezierPatch& patch : grid.patches) {
    ForEachPole(patch, [&](const Vec3& p) { hull.Add(p); });
  }
  const double size = (hull.max - hull.min).norm() + hull.centre().norm();
  const double slack = std::min(1e-10, 1e-13 * size) + 4e-16 * size;
  for (int axis = 0; axis < 3; ++axis) {
    box.max[axis] = LargestOver(grid, axis, 1, slack);
    box.min[axis] = -LargestOver(grid, axis, -1, slack);
  }
  return box;
}

Nearest NearestPoint(const Surface& surface, const Vec3& p) {
  Nearest best;
  const PatchGrid grid = PatchesOf(surface);
  if (grid.patches.empty() || !p.allFinite()) return best;
  best.distance_m = std::numeric_limits<double>::infinity();
  std::priority_queue<Part> open;
  for (int i = 0; i < grid.count_u(); ++i) {
    for (int j = 0; j < grid.count_v(); ++j) {
      open.push({LowerBound(grid.at(i, j), p), grid.breaks_u[i], grid.breaks_u[i + 1],
                 grid.breaks_v[j], grid.breaks_v[j + 1], 0, grid.at(i, j)});
    }
  }
  for (int nodes = 0; !open.empty() && nodes < kMaxNodes; ++nodes) {
    const Part part = open.top();
    open.pop();
    if (part.at_least_m >= best.distance_m * (1 - 1e-12)) break;
    const Vec2 at = PolishedParameters(part.patch, p, Vec2(0.5, 0.5));
    const Vec3 point = PointOf(part.patch, at.x(), at.y());
    if ((point - p).norm() < best.distance_m) {
      best.point = point;
      best.distance_m = (point - p).norm();
      best.t = part.u0 + at.x() * (part.u1 - part.u0);
    }
    if (part.depth >= kDeepest) continue;
    const bool along_u = WiderAlongU(part.patch, Vec3::Ones());
    for (const bool upper : {false, true}) {
      Part half{0,
                part.u0,
                part.u1,
                part.v0,
                part.v1,
                part.depth + 1,
                SplitOff(part.patch, along_u, upper)};
      const double u = 0.5 * (part.u0 + part.u1), v = 0.5 * (part.v0 + part.v1);
      (along_u ? (upper ? half.u0 : half.u1) : (upper ? half.v0 : half.v1)) = along_u ? u : v;
      half.at_least_m = LowerBound(half.patch, p);
      open.push(std::move(half));
    }
  }
  return best;
}

}  // namespace tranos::geom
