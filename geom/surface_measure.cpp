// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "geom/curve_pieces.h"
#include "geom/quadrature.h"
#include "geom/surface_patches.h"

namespace tranos::geom {
namespace {

constexpr Cell kUnitCell = {0, 1, 0, 1};
constexpr long kMaxCells = 40'000;
// An area element more upright than this is a wall.
constexpr double kUpright = 1e-9;
// Interior parameters at which the plan is examined: Gauss nodes, which no symmetry favours.
constexpr std::array<double, 8> kProbes = {
    0.0198550717512319, 0.1016667612931866, 0.2372337950418355, 0.4082826787521751,
    0.5917173212478249, 0.7627662049581645, 0.8983332387068134, 0.9801449282487681};

// ∫∫ f(patch, s, t) over all patches; singularities of the integrand, which lie on corners and
// edges of patches, are closed in on by quartering.
template <class F>
double IntegrateOver(const PatchGrid& grid, const F& f) {
  std::vector<double> rough;
  double size = 0;
  for (const BezierPatch& patch : grid.patches) {
    rough.push_back(Gauss8Squared([&](double s, double t) { return f(patch, s, t); }, kUnitCell));
    size += std::abs(rough.back());
  }
  double sum = 0;
  long cells_left = kMaxCells;
  for (std::size_t k = 0; k < grid.patches.size(); ++k) {
    const BezierPatch& patch = grid.patches[k];
    sum += IntegrateAdaptively([&](double s, double t) { return f(patch, s, t); }, kUnitCell,
                               rough[k], 2e-12 * size, cells_left);
  }
  return sum;
}

Vec3 AreaElement(const BezierPatch& patch, double s, double t) {
  const SurfaceJet jet = JetOf(patch, s, t);
  return jet.du.cross(jet.dv);
}

tl::unexpected<Error> NotAGraph(const char* detail) {
  return tl::unexpected(Error{ErrorCode::kNotAGraph, detail});
}

struct PlanProbe {
  Vec2 at;
  double upward;  // the area element's z over its length
};

std::vector<PlanProbe> ProbePlan(const PatchGrid& grid) {
  std::vector<PlanProbe> probes;
  for (const BezierPatch& patch : grid.patches) {
    for (const double s : kProbes) {
      for (const double t : kProbes) {
        const SurfaceJet jet = JetOf(patch, s, t);
        const Vec3 element = jet.du.cross(jet.dv);
        const double length = element.norm();
        const double least = 1e-12 * (jet.du.squaredNorm() + jet.dv.squaredNorm());
        if (!(length > least)) continue;
        probes.push_back({jet.point.head<2>(), element.z() / length});
      }
    }
  }
  return probes;
}

// The border seen in plan, as a polygon. Seams are walked there and back, so they cancel.
std::vector<Vec2> PlanBorder(const PatchGrid& grid) {
  constexpr int kParts = 64;
  std::vector<Vec2> border;
  const int nu = grid.count_u(), nv = grid.count_v();
  auto add = [&](int i, int j, double s, double t) {
    border.push_back(PointOf(grid.at(i, j), s, t).head<2>());
  };
  for (int k = 0; k < nu * kParts; ++k) add(k / kParts, 0, k % kParts / double{kParts}, 0);
  for (int k = 0; k < nv * kParts; ++k) add(nu - 1, k / kParts, 1, k % kParts / double{kParts});
  for (int k = 0; k < nu * kParts; ++k) {
    add(nu - 1 - k / kParts, nv - 1, 1 - k % kParts / double{kParts}, 1);
  }
  for (int k = 0; k < nv * kParts; ++k)
    add(0, nv - 1 - k / kParts, 0, 1 - k % kParts / double{kParts});
  return border;
}

double Cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// How often the polygon runs round p, counted by its crossings of the ray to the right.
int Winding(const std::vector<Vec2>& polygon, const Vec2& p) {
  int winding = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if ((a.y() <= p.y()) == (b.y() <= p.y())) continue;
    const double side = Cross(b - a, p - a);
    if (a.y() <= p.y() && side > 0) ++winding;
    if (a.y() > p.y() && side < 0) --winding;
  }
  return winding;
}

// One height over each point: the area elements all look up, or all down, none is upright, and no
// place of the plan is run round twice by the border.
tl::expected<double, Error> PlanOrientation(const PatchGrid& grid) {
  const std::vector<PlanProbe> probes = ProbePlan(grid);
  bool up = false, down = false;
  for (const PlanProbe& probe : probes) {
    if (std::abs(probe.upward) <= kUpright) return NotAGraph("a part of the surface is upright");
    (probe.upward > 0 ? up : down) = true;
  }
  if (up == down) return NotAGraph("the surface folds over itself in plan");
  const std::vector<Vec2> border = PlanBorder(grid);
  const std::size_t stride = std::max<std::size_t>(1, probes.size() / 4096);
  for (std::size_t i = 0; i < probes.size(); i += stride) {
    if (std::abs(Winding(border, probes[i].at)) > 1) {
      return NotAGraph("the surface lies over itself in plan");
    }
  }
  return up ? 1.0 : -1.0;
}

bool Coincide(const Vec3& a, const Vec3& b) { return (a - b).norm() <= kCoincident_m; }

}  // namespace

double Area(const Surface& surface) {
  return IntegrateOver(PatchesOf(surface), [](const BezierPatch& patch, double s, double t) {
    return AreaElement(patch, s, t).norm();
  });
}

Result<double> VolumeUnder(const Surface& surface, double z) {
  if (auto checked = Check(surface); !checked) return tl::unexpected(checked.error());
  if (!std::isfinite(z)) {
    return tl::unexpected(Error{ErrorCode::kOutOfRange, "the height is not a number"});
  }
  const PatchGrid grid = PatchesOf(surface);
  const auto orientation = PlanOrientation(grid);
  if (!orientation) return tl::unexpected(orientation.error());
  return *orientation * IntegrateOver(grid, [&](const BezierPatch& patch, double s, double t) {
    const SurfaceJet jet = JetOf(patch, s, t);
    return (jet.point.z() - z) * jet.du.cross(jet.dv).z();
  });
}

bool IsClosed(const Surface& surface) {
  const PatchGrid grid = PatchesOf(surface);
  if (grid.patches.empty()) return false;
  constexpr int kSamples = 5;
  bool u_meets = true, u0_point = true, u1_point = true;
  bool v_meets = true, v0_point = true, v1_point = true;
  const int nu = grid.count_u(), nv = grid.count_v();
  const Vec3 corner0 = PointOf(grid.at(0, 0), 0, 0),
             corner1 = PointOf(grid.at(nu - 1, nv - 1), 1, 1);
  for (int k = 0; k < nv * kSamples; ++k) {
    const double t = k % kSamples / (kSamples - 1.0);
    const Vec3 a = PointOf(grid.at(0, k / kSamples), 0, t);
    const Vec3 b = PointOf(grid.at(nu - 1, k / kSamples), 1, t);
    u_meets = u_meets && Coincide(a, b);
    u0_point = u0_point && Coincide(a, corner0);
    u1_point = u1_point && Coincide(b, corner1);
  }
  for (int k = 0; k < nu * kSamples; ++k) {
    const double s = k % kSamples / (kSamples - 1.0);
    const Vec3 a = PointOf(grid.at(k / kSamples, 0), s, 0);
    const Vec3 b = PointOf(grid.at(k / kSamples, nv - 1), s, 1);
    v_meets = v_meets && Coincide(a, b);
    v0_point = v0_point && Coincide(a, corner0);
    v1_point = v1_point && Coincide(b, corner1);
  }
  return (u_meets || (u0_point && u1_point)) && (v_meets || (v0_point && v1_point));
}

}  // namespace tranos::geom
