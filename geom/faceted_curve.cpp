// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/faceted_curve.h"

#include <cmath>

#include "geom/curve_pieces.h"
#include "geom/facet_count.h"

namespace tranos::geom {
namespace {

// Where a curve turns by less than this, somebody meant it to be smooth.
constexpr double kSmooth_rad = 1e-4;

class Faceter {
 public:
  explicit Faceter(const Tolerance& tolerance) : tolerance_(tolerance) {}

  template <class Piece>
  void Add(const Piece& piece) {
    if constexpr (std::is_same_v<Piece, Arc>) {
      const double count = FullTurnFacets(piece.radius, tolerance_);
      const bool by_count = piece.sweep_rad >= 2 * kPi && count <= double{kMaxFacetPoints};
      AddSmooth(piece,
                by_count ? Tolerance{tolerance_.chord_m, static_cast<int>(count)} : tolerance_);
    } else if constexpr (std::is_same_v<Piece, BsplineCurve>) {
      // Between spans even a smooth-looking B-spline may have a corner.
      for (const BezierSpan& span : BezierSpansOf(piece)) AddSmooth(JoinSpans({span}), tolerance_);
    } else {
      AddSmooth(piece, tolerance_);
    }
  }

  Result<FacetedCurve> Finish(bool closed) {
    if (error_) return tl::unexpected(*error_);
    std::vector<FacetCorner>& corners = facets_.corners;
    if (corners.size() < 2) return Nothing();
    if (closed) {
      corners.front().in = corners.back().in;
      corners.pop_back();
      if (corners.size() < 2) return Nothing();
    } else {
      corners.front().in = corners.front().out;
      corners.back().out = corners.back().in;
    }
    facets_.closed = closed;
    return std::move(facets_);
  }

 private:
  static tl::unexpected<Error> Nothing() {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "the curve has no length"});
  }

  template <class Piece>
  void AddSmooth(const Piece& piece, const Tolerance& tolerance) {
    if (error_) return;
    Result<std::vector<Vec3>> points = Tessellate(Curve(piece), tolerance);
    if (!points) {
      error_ = points.error();
      return;
    }
    if (IsClosed(Curve(piece))) points->push_back(points->front());
    if (points->size() < 2 || (points->size() == 2 && (*points)[0] == (*points)[1])) return;
    const Vec3 start = TangentAt(Curve(piece), 0), end = TangentAt(Curve(piece), 1);
    if (facets_.corners.empty()) {
      facets_.corners.push_back({points->front(), start, start});
    } else {
      facets_.corners.back().out = start;
    }
    for (std::size_t i = 1; i + 1 < points->size(); ++i) {
      const Vec3& p = (*points)[i];
      const Vec3 along =
          ((p - (*points)[i - 1]).normalized() + ((*points)[i + 1] - p).normalized()).normalized();
      facets_.corners.push_back({p, along, along});
    }
    facets_.corners.push_back({points->back(), end, end});
  }

  const Tolerance& tolerance_;
  FacetedCurve facets_;
  std::optional<Error> error_;
};

}  // namespace

double FullTurnFacets(double radius_m, const Tolerance& tolerance) {
  const double count = ArcFacets(radius_m, 2 * kPi, tolerance);
  return tolerance.facets_per_turn > 0 ? count : 4 * std::ceil(count / 4);
}

bool FacetCorner::IsSmooth() const { return in.dot(out) > 0 && in.cross(out).norm() < kSmooth_rad; }

Result<FacetedCurve> FacetsOf(const Curve& curve, const Tolerance& tolerance) {
  if (auto checked = Check(curve); !checked) return tl::unexpected(checked.error());
  Faceter faceter(tolerance);
  ForEachPiece(curve, [&](const auto& piece, double, double) { faceter.Add(piece); });
  return faceter.Finish(IsClosed(curve));
}

SmoothRuns SmoothRunsOf(const FacetedCurve& curve) {
  SmoothRuns runs;
  const std::size_t count = curve.FacetCount();
  std::uint32_t run = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0 && !curve.corners[i].IsSmooth()) ++run;
    runs.of_facet.push_back(run);
  }
  if (curve.closed && run > 0 &&
      curve.corners[0].IsSmooth()) {  // the last run goes on as the first
    for (std::size_t i = count; i-- > 0 && runs.of_facet[i] == run;) runs.of_facet[i] = 0;
    --run;
  }
  runs.count = run + 1;
  return runs;
}

}  // namespace tranos::geom
