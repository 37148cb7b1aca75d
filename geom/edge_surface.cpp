// SPDX-License-Identifier: GPL-3.0-or-later
// The patch through three or four edges: which edge is which side, and what surface it is.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "geom/surface_patches.h"

namespace tranos::geom {
namespace {

const Vec3& StartOf(const BsplineCurve& c) { return c.poles.front(); }
const Vec3& EndOf(const BsplineCurve& c) { return c.poles.back(); }

BsplineCurve ReversedEdge(const BsplineCurve& c) {
  return std::get<BsplineCurve>(Reversed(Curve(c)));
}

BsplineCurve PointEdge(const Vec3& p) { return {1, {0, 0, 1, 1}, {p, p}, {}}; }

// The edges in the order in which a walk from the first one's end comes to them, all running
// with the walk; nothing if there is no such walk.
std::optional<std::vector<BsplineCurve>> Loop(const std::vector<BsplineCurve>& edges,
                                              double tolerance_m) {
  std::vector<std::size_t> order(edges.size());
  std::iota(order.begin(), order.end(), 0);
  do {
    for (unsigned turned = 0; turned < (1u << edges.size()); turned += 2) {
      auto start = [&](std::size_t k) {
        return turned >> k & 1 ? EndOf(edges[k]) : StartOf(edges[k]);
      };
      auto end = [&](std::size_t k) {
        return turned >> k & 1 ? StartOf(edges[k]) : EndOf(edges[k]);
      };
      bool meets = true;
      for (std::size_t i = 0; i < order.size() && meets; ++i) {
        const std::size_t next = order[(i + 1) % order.size()];
        meets = (end(order[i]) - start(next)).norm() <= tolerance_m;
      }
      if (!meets) continue;
      std::vector<BsplineCurve> loop;
      for (const std::size_t k : order) {
        loop.push_back(turned >> k & 1 ? ReversedEdge(edges[k]) : edges[k]);
      }
      return loop;
    }
  } while (std::next_permutation(order.begin() + 1, order.end()));
  return std::nullopt;
}

// The first curve with an end that meets no other curve's end; the last curve if all ends meet
// some other, but not in one loop.
int FreeEdge(const std::vector<BsplineCurve>& edges, double tolerance_m) {
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (const Vec3& end : {StartOf(edges[i]), EndOf(edges[i])}) {
      bool met = false;
      for (std::size_t k = 0; k < edges.size(); ++k) {
        met = met || (k != i && ((StartOf(edges[k]) - end).norm() <= tolerance_m ||
                                 (EndOf(edges[k]) - end).norm() <= tolerance_m));
      }
      if (!met) return static_cast<int>(i);
    }
  }
  return static_cast<int>(edges.size()) - 1;
}

// Corners meet within the tolerance only; the patch needs them equal.
void CloseCorners(CoonsPatch& p) {
  p.west.poles.front() = p.south.poles.front();
  p.east.poles.front() = p.south.poles.back();
  p.west.poles.back() = p.north.poles.front();
  p.east.poles.back() = p.north.poles.back();
}

bool AreTranslates(const BsplineCurve& a, const BsplineCurve& b) {
  if (a.degree != b.degree || a.poles.size() != b.poles.size()) return false;
  const double size = (EndOf(a) - StartOf(a)).norm() + StartOf(a).norm() + StartOf(b).norm();
  const double tolerance_m = std::min(kCoincident_m, 1e-12 * size + 1e-15);
  for (std::size_t i = 0; i < a.knots.size(); ++i) {
    const double ta = (a.knots[i] - a.knots.front()) / (a.knots.back() - a.knots.front());
    const double tb = (b.knots[i] - b.knots.front()) / (b.knots.back() - b.knots.front());
    if (std::abs(ta - tb) > 1e-12) return false;
  }
  for (std::size_t i = 0; i < a.poles.size(); ++i) {
    const Vec3 difference = (a.poles[i] - StartOf(a)) - (b.poles[i] - StartOf(b));
    const double wa = a.weights.empty() ? 1 : a.weights[i],
                 wb = b.weights.empty() ? 1 : b.weights[i];
    if (!(difference.norm() <= tolerance_m) || std::abs(wa - wb) > 1e-12 * wa) return false;
  }
  return true;
}

BsplineSurface Translation(const BsplineCurve& south, const BsplineCurve& west) {
  BsplineSurface s;
  s.degree_u = south.degree;
  s.degree_v = west.degree;
  s.knots_u = south.knots;
  s.knots_v = west.knots;
  s.count_u = static_cast<int>(south.poles.size());
  s.count_v = static_cast<int>(west.poles.size());
  const bool rational = !south.weights.empty() || !west.weights.empty();
  for (std::size_t i = 0; i < south.poles.size(); ++i) {
    for (std::size_t j = 0; j < west.poles.size(); ++j) {
      s.poles.push_back(south.poles[i] + (west.poles[j] - west.poles[0]));
      if (!rational) continue;
      s.weights.push_back((south.weights.empty() ? 1 : south.weights[i]) *
                          (west.weights.empty() ? 1 : west.weights[j]));
    }
  }
  return s;
}

// South is the first edge as given. With three, the shared end of the first two is a side.
CoonsPatch SidesOf(const std::vector<BsplineCurve>& loop, bool second_follows) {
  if (loop.size() == 4) return {loop[0], ReversedEdge(loop[2]), ReversedEdge(loop[3]), loop[1]};
  const BsplineCurve &south = loop[0], &after = loop[1], &before = loop[2];
  if (second_follows) {
    return {south, ReversedEdge(after), ReversedEdge(before), PointEdge(EndOf(south))};
  }
  return {south, ReversedEdge(before), PointEdge(StartOf(south)), after};
}

}  // namespace

Result<Surface> EdgeSurface(const std::vector<Curve>& boundary, double tolerance_m) {
  if (boundary.size() != 3 && boundary.size() != 4) {
    return tl::unexpected(Error{ErrorCode::kOutOfRange, "a patch has three or four edges"});
  }
  std::vector<BsplineCurve> edges;
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    auto checked = Check(boundary[i]);
    if (checked && !(Length(boundary[i]) > tolerance_m)) {
      checked = tl::unexpected(Error{ErrorCode::kDegenerate, "an edge has no length"});
    }
    if (!checked) {
      checked.error().part = static_cast<int>(i);
      return tl::unexpected(checked.error());
    }
    edges.push_back(ToBspline(boundary[i]));
  }
  const auto loop = Loop(edges, tolerance_m);
  if (!loop) {
    return tl::unexpected(Error{ErrorCode::kDoNotMeet, "the edges do not form one closed ring",
                                FreeEdge(edges, tolerance_m)});
  }
  auto at_end_of_first = [&](const Vec3& p) { return (p - EndOf(edges[0])).norm() <= tolerance_m; };
  CoonsPatch patch =
      SidesOf(*loop, at_end_of_first(StartOf(edges[1])) || at_end_of_first(EndOf(edges[1])));
  CloseCorners(patch);
  Surface surface = patch;
  if (auto checked = Check(surface); !checked) return tl::unexpected(checked.error());
  if (AreTranslates(patch.south, patch.north) && AreTranslates(patch.west, patch.east)) {
    return Surface(Translation(patch.south, patch.west));
  }
  return surface;
}

}  // namespace tranos::geom
