// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces that a curve makes when it is moved: extruded, turned, or joined to another by lines.
#include <algorithm>
#include <cmath>

#include "geom/arc.h"
#include "geom/surface_patches.h"

namespace tranos::geom {
namespace {

tl::unexpected<Error> Degenerate(const char* detail) {
  return tl::unexpected(Error{ErrorCode::kDegenerate, detail});
}

double WeightOf(const BsplineCurve& c, std::size_t i) {
  return c.weights.empty() ? 1.0 : c.weights[i];
}

void DropUnitWeights(std::vector<double>& weights) {
  for (const double w : weights) {
    if (w != 1) return;
  }
  weights.clear();
}

// Straight rulings, along v, between curves with the same knots.
BsplineSurface Rulings(const BsplineCurve& from, const BsplineCurve& to) {
  BsplineSurface surface;
  surface.degree_u = from.degree;
  surface.knots_u = from.knots;
  surface.knots_v = {0, 0, 1, 1};
  surface.count_u = static_cast<int>(from.poles.size());
  surface.count_v = 2;
  for (std::size_t i = 0; i < from.poles.size(); ++i) {
    surface.poles.push_back(from.poles[i]);
    surface.poles.push_back(to.poles[i]);
    surface.weights.push_back(WeightOf(from, i));
    surface.weights.push_back(WeightOf(to, i));
  }
  DropUnitWeights(surface.weights);
  return surface;
}

// The curve with the given degree, and knots of full multiplicity at `breaks`.
BsplineCurve Refined(const BsplineCurve& curve, int degree, const std::vector<double>& breaks) {
  std::vector<BezierSpan> spans = SpansBetween(curve, breaks);
  for (BezierSpan& span : spans) span.poles = Elevated(span.poles, degree);
  BsplineCurve refined = JoinSpans(spans);
  // JoinSpans counts spans; the natural parameters of both curves must stay paired.
  for (double& knot : refined.knots) knot = breaks[static_cast<std::size_t>(knot)];
  return refined;
}

}  // namespace

std::vector<BsplineCurve> MadeAlike(const std::vector<Curve>& curves) {
  std::vector<BsplineCurve> alike;
  for (const Curve& curve : curves) alike.push_back(ToBspline(curve));
  const bool are_alike = std::all_of(alike.begin(), alike.end(), [&](const BsplineCurve& curve) {
    return curve.degree == alike[0].degree && curve.knots == alike[0].knots;
  });
  if (are_alike) return alike;
  std::vector<double> breaks = BreaksOf(alike[0]);
  int degree = 0;
  for (const BsplineCurve& curve : alike) {
    breaks = UnitedBreaks(breaks, BreaksOf(curve));
    degree = std::max(degree, curve.degree);
  }
  for (BsplineCurve& curve : alike) curve = Refined(curve, degree, breaks);
  return alike;
}

Result<Surface> Extrusion(const Curve& profile, const Vec3& direction) {
  if (auto checked = Check(profile); !checked) return tl::unexpected(checked.error());
  if (!direction.allFinite() || !(direction.norm() > 0)) {
    return Degenerate("the direction has no length");
  }
  if (!(Length(profile) > 0)) return Degenerate("the profile has no length");
  const BsplineCurve from = ToBspline(profile);
  BsplineCurve to = from;
  for (Vec3& p : to.poles) p += direction;
  Surface surface = Rulings(from, to);
  if (auto checked = Check(surface); !checked) return tl::unexpected(checked.error());
  return surface;
}

Result<Surface> Ruled(const Curve& from, const Curve& to) {
  for (const Curve* curve : {&from, &to}) {
    if (auto checked = Check(*curve); !checked) {
      checked.error().part = curve == &from ? 0 : 1;
      return tl::unexpected(checked.error());
    }
  }
  if (!(Length(from) > 0) && !(Length(to) > 0)) return Degenerate("neither curve has a length");
  const std::vector<BsplineCurve> alike = MadeAlike({from, to});
  return Surface(Rulings(alike[0], alike[1]));
}

Result<Surface> Revolution(const Curve& profile, const Vec3& axis_point, const Vec3& axis_direction,
                           double angle_rad) {
  if (auto checked = Check(profile); !checked) return tl::unexpected(checked.error());
  const double sweep_rad = std::abs(angle_rad);
  if (!(sweep_rad > 0 && sweep_rad <= 2 * kPi * (1 + 1e-12))) {
    return tl::unexpected(
        Error{ErrorCode::kOutOfRange, "the angle is not between zero and a full turn"});
  }
  const Vec3 axis = (angle_rad < 0 ? -1 : 1) * axis_direction.normalized();
  if (!axis.allFinite() || !axis_point.allFinite() || !(axis.norm() > 0.5)) {
    return Degenerate("the axis has no direction");
  }
  if (!(Length(profile) > 0)) return Degenerate("the profile has no length");
  const BsplineCurve meridian = ToBspline(profile);
  double reach = 0, widest = 0;
  for (const Vec3& p : meridian.poles) {
    reach = std::max(reach, (p - axis_point).norm() + p.norm());
    widest = std::max(widest, (p - axis_point).cross(axis).norm());
  }
  // A pole within rounding of the axis is on it, so that the parallel there is one point.
  const double on_axis_m = 1e-14 * reach;
  if (!(widest > on_axis_m)) return Degenerate("the profile lies on the axis");
  Frame unit;
  const BsplineCurve turn = JoinSpans(BezierSpansOf(Arc{unit, 1, std::min(sweep_rad, 2 * kPi)}));
  BsplineSurface surface;
  surface.degree_u = turn.degree;
  surface.degree_v = meridian.degree;
  surface.knots_u = turn.knots;
  surface.knots_v = meridian.knots;
  surface.count_u = static_cast<int>(turn.poles.size());
  surface.count_v = static_cast<int>(meridian.poles.size());
  for (std::size_t i = 0; i < turn.poles.size(); ++i) {
    for (std::size_t j = 0; j < meridian.poles.size(); ++j) {
      const Vec3& p = meridian.poles[j];
      const Vec3 foot = axis_point + (p - axis_point).dot(axis) * axis;
      const Vec3 out = p - foot;
      const Vec3& at = turn.poles[i];
      const bool touches = out.norm() <= on_axis_m;
      surface.poles.push_back(touches ? foot
                                      : Vec3(foot + at.x() * out + at.y() * axis.cross(out)));
      surface.weights.push_back(WeightOf(turn, i) * WeightOf(meridian, j));
    }
  }
  Surface result = surface;
  if (auto checked = Check(result); !checked) return tl::unexpected(checked.error());
  return result;
}

}  // namespace tranos::geom
