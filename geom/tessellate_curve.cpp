// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "geom/curve_pieces.h"
#include "geom/facet_count.h"

namespace tranos::geom {
namespace {

constexpr int kDeepest = 40;

// The largest distance of a pole from the chord: the curve, which stays in its poles' hull, is no
// farther from the chord than this.
double HullThickness(const BezierPoles& poles) {
  const Vec3 a = Projected(poles.col(0)), b = Projected(poles.col(poles.cols() - 1));
  double thickness_m = 0;
  for (int i = 1; i + 1 < poles.cols(); ++i) {
    thickness_m = std::max(thickness_m, NearestOn(Line{a, b}, Projected(poles.col(i))).distance_m);
  }
  return thickness_m;
}

class Collector {
 public:
  Collector(const Tolerance& tolerance, std::vector<Vec3>& points)
      : tolerance_(tolerance), points_(points) {}

  bool too_large() const { return too_large_; }

  void Add(const Line& line) {
    Begin(line.start);
    Push(line.end);
  }

  void Add(const Arc& arc) {
    Begin(PointAtAngle(arc, 0));
    const double count = ArcFacets(arc.radius, arc.sweep_rad, tolerance_);
    if (!Reserve(count)) return;
    for (double i = 1; i <= count; ++i) Push(PointAtAngle(arc, arc.sweep_rad * i / count));
  }

  void Add(const BsplineCurve& curve) {
    for (const BezierSpan& span : BezierSpansOf(curve)) {
      if (too_large_) return;
      Begin(Projected(span.poles.col(0)));
      if (tolerance_.facets_per_turn > 0) {
        AddByTurning(span.poles);
      } else if (Reserve(0.25 * std::sqrt(HullThickness(span.poles) / tolerance_.chord_m))) {
        AddByChord(span.poles, kDeepest);
      }
    }
  }

 private:
  // The start of a piece is the end of the one before.
  void Begin(const Vec3& start) {
    if (points_.empty()) points_.push_back(start);
  }
  void Push(const Vec3& p) {
    if (!(p == points_.back())) points_.push_back(p);
    too_large_ = too_large_ || points_.size() > kMaxFacetPoints;
  }
  bool Reserve(double count) {
    const double total = count + static_cast<double>(points_.size());
    too_large_ = too_large_ || !(total <= static_cast<double>(kMaxFacetPoints));
    return !too_large_;
  }
  void AddByTurning(const BezierPoles& poles) {
    const double count = TurningFacets(TurningOf(poles), tolerance_);
    if (!Reserve(count)) return;
    for (double i = 1; i <= count; ++i) Push(JetOf(poles, i / count).point);
  }
  void AddByChord(const BezierPoles& poles, int depth) {
    if (too_large_) return;
    if (depth == 0 || HullThickness(poles) <= tolerance_.chord_m) {
      Push(Projected(poles.col(poles.cols() - 1)));
      return;
    }
    const auto [left, right] = Split(poles, 0.5);
    AddByChord(left, depth - 1);
    AddByChord(right, depth - 1);
  }

  const Tolerance& tolerance_;
  std::vector<Vec3>& points_;
  bool too_large_ = false;
};

}  // namespace

tl::expected<void, Error> Check(const Tolerance& tolerance) {
  if (tolerance.facets_per_turn > 0) return {};
  if (tolerance.facets_per_turn == 0 && tolerance.chord_m > 0 && std::isfinite(tolerance.chord_m)) {
    return {};
  }
  return tl::unexpected(Error{ErrorCode::kOutOfRange, "the tolerance is not a positive number"});
}

double ArcFacets(double radius_m, double sweep_rad, const Tolerance& tolerance) {
  if (tolerance.facets_per_turn > 0) return TurningFacets(sweep_rad, tolerance);
  // The sagitta over an angle δ is 2·r·sin²(δ/4). No facet spans more than a third of a turn.
  const double sine = std::sqrt(0.5 * tolerance.chord_m / radius_m);
  const double part = sine < 0.5 ? 4 * std::asin(sine) : 2 * kPi / 3;
  return PartsOf(sweep_rad, std::min(part, 2 * kPi / 3));
}

double TurningFacets(double turning_rad, const Tolerance& tolerance) {
  return PartsOf(turning_rad, 2 * kPi / std::max(tolerance.facets_per_turn, 3));
}

double TurningOf(const BezierPoles& poles) {
  double turning_rad = 0;
  Vec3 before = Vec3::Zero();
  for (int i = 0; i + 1 < poles.cols(); ++i) {
    const Vec3 leg = Projected(poles.col(i + 1)) - Projected(poles.col(i));
    if (!(leg.norm() > 0)) continue;
    if (!before.isZero()) turning_rad += std::atan2(before.cross(leg).norm(), before.dot(leg));
    before = leg;
  }
  return turning_rad;
}

Result<std::vector<Vec3>> Tessellate(const Curve& curve, const Tolerance& tolerance) {
  if (auto checked = Check(tolerance); !checked) return tl::unexpected(checked.error());
  if (auto checked = Check(curve); !checked) return tl::unexpected(checked.error());
  std::vector<Vec3> points;
  Collector collector(tolerance, points);
  ForEachPiece(curve, [&](const auto& piece, double, double) {
    if (!collector.too_large()) collector.Add(piece);
  });
  if (collector.too_large()) {
    return tl::unexpected(
        Error{ErrorCode::kTooLarge, "the tolerance asks for more than ten million points"});
  }
  const bool repeats =
      points.size() > 2 && (points.front() - points.back()).norm() <= kCoincident_m;
  const auto* chain = std::get_if<Chain>(&curve);
  if (points.size() > 2 && (repeats || (chain && chain->closed))) points.pop_back();
  return points;
}

}  // namespace tranos::geom
