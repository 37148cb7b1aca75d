// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <tuple>

#include "geom/faceted_curve.h"
#include "geom/skin.h"
#include "geom/swept_solid.h"
#include "geom/triangulate.h"

namespace tranos::geom {
namespace {

constexpr int kSamples = 64;         // at which it is seen how near two loops are
constexpr double kSameShare = 1e-9;  // shares of a length that are one

// A closed polygon by shares of its length.
class Loop {
 public:
  explicit Loop(const FacetedCurve& curve) {
    for (const FacetCorner& corner : curve.corners) {
      points_.push_back(corner.point);
      smooth_.push_back(corner.IsSmooth());
    }
    Measure();
  }

  std::size_t size() const { return points_.size(); }
  const std::vector<Vec3>& points() const { return points_; }
  const std::vector<double>& shares() const { return shares_; }
  bool IsSmoothAt(std::size_t i) const { return smooth_[i]; }
  Vec3 Middle() const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < kSamples; ++i) sum += At(i / double{kSamples});
    return sum / kSamples;
  }
  // Twice the vector area: along the normal about which the loop runs anticlockwise.
  Vec3 DoubledArea() const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < size(); ++i) {
      sum += (points_[i] - points_[0]).cross(points_[(i + 1) % size()] - points_[0]);
    }
    return sum;
  }
  Vec3 At(double share) const {
    const double wrapped = share - std::floor(share);
    const auto next = std::upper_bound(shares_.begin(), shares_.end(), wrapped);
    const auto i = static_cast<std::size_t>(next - shares_.begin()) - 1;
    const double end = next == shares_.end() ? 1 : *next;
    // A corner itself, where rounding alone tells them apart.
    if (wrapped - shares_[i] <= kSameShare) return points_[i];
    if (end - wrapped <= kSameShare) return points_[(i + 1) % size()];
    const double part = (wrapped - shares_[i]) / (end - shares_[i]);
    return points_[i] + part * (points_[(i + 1) % size()] - points_[i]);
  }
  void Reverse() {
    std::reverse(points_.begin() + 1, points_.end());
    std::reverse(smooth_.begin() + 1, smooth_.end());
    Measure();
  }
  // Begins at this share, where a corner is put if there is none.
  void StartAt(double share) {
    std::vector<double> shares = {0};
    for (const double own : shares_) {
      const double from_start = own - share - std::floor(own - share);
      if (from_start > kSameShare && from_start < 1 - kSameShare) shares.push_back(from_start);
    }
    std::sort(shares.begin(), shares.end());
    std::vector<double> own = shares;
    for (double& s : own) s = s + share - std::floor(s + share);
    Resample(own);
    shares_ = std::move(shares);
  }
  // Where to begin for lying nearest to `other`, each seen from its middle: at a corner, or on a
  // smooth curve, which has none, anywhere.
  double StartNearest(const Loop& other, bool at_points) const {
    const bool smooth = std::find(smooth_.begin(), smooth_.end(), false) == smooth_.end();
    std::vector<double> candidates = shares_;
    if (smooth && !at_points) {
      for (int i = 0; i < kSamples; ++i) candidates.push_back(i / double{kSamples});
    }
    const Vec3 shift = Middle() - other.Middle();
    double best = 0, least = std::numeric_limits<double>::infinity();
    for (const double start : candidates) {
      double sum = 0;
      for (int k = 0; k < kSamples; ++k) {
        const double share = k / double{kSamples};
        sum += (At(start + share) - shift - other.At(share)).squaredNorm();
      }
      // A start within rounding of an earlier one is no better.
      if (sum < least * (1 - 1e-9) - 1e-18) least = sum, best = start;
    }
    return best;
  }
  // The loop with corners at these shares.
  void Resample(const std::vector<double>& shares) {
    std::vector<Vec3> points;
    std::vector<bool> smooth;
    for (const double share : shares) {
      points.push_back(At(share));
      const auto same = std::find_if(shares_.begin(), shares_.end(), [&](double own) {
        const double apart = own - share;
        return std::abs(apart - std::round(apart)) <= kSameShare;
      });
      smooth.push_back(same == shares_.end() ||
                       smooth_[static_cast<std::size_t>(same - shares_.begin())]);
    }
    points_ = std::move(points), smooth_ = std::move(smooth), shares_ = shares;
  }

 private:
  void Measure() {
    shares_.assign(1, 0);
    for (std::size_t i = 1; i <= size(); ++i) {
      shares_.push_back(shares_.back() + (points_[i % size()] - points_[i - 1]).norm());
    }
    const double whole = shares_.back();
    shares_.pop_back();
    for (double& share : shares_) share /= whole;
  }

  std::vector<Vec3> points_;
  std::vector<bool> smooth_;
  std::vector<double> shares_;  // where each point is, from 0 up to 1
};

std::vector<double> UnitedShares(const std::vector<Loop>& loops) {
  std::vector<double> all;
  for (const Loop& loop : loops) all.insert(all.end(), loop.shares().begin(), loop.shares().end());
  std::sort(all.begin(), all.end());
  std::vector<double> shares;
  for (const double share : all) {
    const bool again = !shares.empty() && share - shares.back() <= kSameShare;
    if (!again && share < 1 - kSameShare) shares.push_back(share);
  }
  return shares;
}

using Triangles = std::vector<std::array<std::uint32_t, 3>>;
Result<Triangles> CapOf(const Loop& loop) {
  const Vec3 z = loop.DoubledArea().normalized();
  const Vec3 x = z.unitOrthogonal(), y = z.cross(x);
  std::vector<Vec2> flat;
  for (const Vec3& p : loop.points()) {
    const Vec3 d = p - loop.points()[0];
    flat.emplace_back(d.dot(x), d.dot(y));
  }
  return TriangulatePolygon({flat});
}

Result<std::vector<Loop>> LoopsOf(const std::vector<Curve>& outlines, const Tolerance& tolerance) {
  std::vector<Loop> loops;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const Result<Outline> face = OutlineOf({outlines[i]}, tolerance);
    if (!face) {
      return tl::unexpected(Error{face.error().code, face.error().detail, static_cast<int>(i)});
    }
    loops.emplace_back(*FacetsOf(outlines[i], tolerance));
  }
  return loops;
}

// The sides of the row of loops, those of one surface numbered alike: a corner of any of the loops
// is an edge all along.
Outline FirstOutline(const std::vector<Loop>& loops, Triangles cap) {
  Outline outline;
  const auto count = static_cast<std::uint32_t>(loops[0].size());
  const auto smooth_at = [&](std::size_t i) {
    return std::all_of(loops.begin(), loops.end(), [&](const Loop& l) { return l.IsSmoothAt(i); });
  };
  std::uint32_t surface = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (i > 0 && !smooth_at(i)) ++surface;
    outline.sides.push_back({i, (i + 1) % count, surface});
  }
  if (surface > 0 && smooth_at(0)) {  // the last surface goes on as the first
    for (Outline::Side& side : outline.sides) side.surface %= surface;
    --surface;
  }
  outline.surface_count = surface + 1;
  outline.points = loops[0].points();
  outline.triangles = std::move(cap);
  return outline;
}

}  // namespace

Result<TriangleMesh> LoftMesh(const std::vector<Curve>& outlines, const Tolerance& tolerance) {
  Result<std::vector<Loop>> loops = LoopsOf(outlines, tolerance);
  if (!loops) return tl::unexpected(loops.error());
  const bool same_counts = std::all_of(loops->begin(), loops->end(), [&](const Loop& loop) {
    return loop.size() == loops->front().size();
  });
  for (std::size_t i = 1; i < loops->size(); ++i) {
    Loop &loop = (*loops)[i], &before = (*loops)[i - 1];
    if (loop.DoubledArea().dot(before.DoubledArea()) < 0) loop.Reverse();
    loop.StartAt(loop.StartNearest(before, same_counts));
  }
  if (!same_counts) {
    const std::vector<double> shares = UnitedShares(*loops);
    for (Loop& loop : *loops) loop.Resample(shares);
  }
  Result<Triangles> first = CapOf(loops->front()), last = CapOf(loops->back());
  if (!first) return tl::unexpected(first.error());
  if (!last) return tl::unexpected(last.error());
  Stations stations;
  for (const Loop& loop : *loops) stations.points.push_back(loop.points());
  for (std::uint32_t i = 0; i + 1 < loops->size(); ++i) stations.runs.push_back(i);
  stations.run_count = static_cast<std::uint32_t>(loops->size()) - 1;
  stations.last_triangles = *std::move(last);
  return MayCross(SkinOf(FirstOutline(*loops, *std::move(first)), stations));
}

namespace {

Result<Solid> LoftOf(const std::vector<Curve>& outlines, const Tolerance& tolerance) {
  Result<TriangleMesh> mesh = LoftMesh(outlines, tolerance);
  if (!mesh) return tl::unexpected(mesh.error());
  return Solid::FromMesh(*std::move(mesh));
}

// Where each curve of a face has its middle, seen from that of the first.
Result<std::vector<Vec3>> MiddlesOf(const std::vector<Curve>& face, std::size_t index) {
  std::vector<Vec3> middles;
  for (const Curve& curve : face) {
    const Result<Vec3> middle = Centroid(curve);
    if (!middle) {
      return tl::unexpected(
          Error{middle.error().code, middle.error().detail, static_cast<int>(index)});
    }
    middles.push_back(*middle);
  }
  for (std::size_t i = middles.size(); i-- > 0;) middles[i] -= middles[0];
  return middles;
}

// The face's curves in the order in which they follow those with the middles `before`: of all
// pairs the nearest first.
std::vector<std::size_t> OrderAfter(const std::vector<Vec3>& before,
                                    const std::vector<Vec3>& middles) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t i = 1; i < before.size(); ++i) {
    for (std::size_t k = 1; k < middles.size(); ++k) {
      pairs.emplace_back((before[i] - middles[k]).norm(), i, k);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::size_t> order(before.size(), 0);
  std::vector<bool> taken(middles.size(), false);
  for (const auto& [distance, i, k] : pairs) {
    if (order[i] != 0 || taken[k]) continue;
    order[i] = k;
    taken[k] = true;
  }
  return order;
}

}  // namespace

Result<Solid> LoftSolid(const std::vector<std::vector<Curve>>& faces, const Tolerance& tolerance) {
  std::vector<std::vector<Curve>> rows(faces.front().size());  // of the outlines, and of each hole
  std::vector<Vec3> before;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Result<std::vector<Vec3>> middles = MiddlesOf(faces[f], f);
    if (!middles) return tl::unexpected(middles.error());
    const std::vector<std::size_t> order = OrderAfter(f == 0 ? *middles : before, *middles);
    before.clear();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i].push_back(faces[f][order[i]]);
      before.push_back((*middles)[order[i]]);
    }
  }
  std::vector<Solid> solids;
  for (const std::vector<Curve>& row : rows) {
    Result<Solid> solid = LoftOf(row, tolerance);
    if (!solid) return solid;
    solids.push_back(*std::move(solid));
  }
  Solid outer = std::move(solids.front());
  solids.erase(solids.begin());
  return Solid::Difference(std::move(outer), std::move(solids));
}

}  // namespace tranos::geom
