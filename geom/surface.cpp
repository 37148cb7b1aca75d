// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/surface.h"

#include <cmath>

#include "geom/curve_pieces.h"
#include "geom/surface_patches.h"

namespace tranos::geom {
namespace {

tl::expected<void, Error> Refuse(const char* detail) {
  return tl::unexpected(Error{ErrorCode::kOutOfRange, detail});
}

bool InRange(const Vec3& p) { return (p.array().abs() <= kLargestCoordinate_m).all(); }

tl::expected<void, Error> CheckOne(const BsplineSurface& s) {
  const bool degrees =
      s.degree_u >= 1 && s.degree_u <= kMaxDegree && s.degree_v >= 1 && s.degree_v <= kMaxDegree;
  if (!degrees || s.count_u <= s.degree_u || s.count_v <= s.degree_v) {
    return Refuse("there are too few poles for the degree");
  }
  const std::size_t count_u = static_cast<std::size_t>(s.count_u);
  const std::size_t count_v = static_cast<std::size_t>(s.count_v);
  if (s.poles.size() != count_u * count_v || s.knots_u.size() != count_u + s.degree_u + 1 ||
      s.knots_v.size() != count_v + s.degree_v + 1 ||
      (!s.weights.empty() && s.weights.size() != s.poles.size())) {
    return Refuse("poles, knots, weights and degrees do not fit together");
  }
  if (!AreClampedKnots(s.knots_u, s.degree_u) || !AreClampedKnots(s.knots_v, s.degree_v)) {
    return Refuse("the knots do not ascend or are not clamped");
  }
  for (const Vec3& p : s.poles) {
    if (!InRange(p)) return Refuse("a coordinate is not a number");
  }
  for (const double w : s.weights) {
    if (!(w >= 1e-18 && w <= 1e18)) return Refuse("a weight is out of range");
  }
  return {};
}

tl::expected<void, Error> CheckOne(const CoonsPatch& c) {
  for (const BsplineCurve* edge : {&c.south, &c.north, &c.west, &c.east}) {
    if (auto checked = Check(Curve(*edge)); !checked) return checked;
  }
  if (c.south.degree + c.north.degree >= kMaxDegree ||
      c.west.degree + c.east.degree >= kMaxDegree) {
    return Refuse("the degrees of opposite edges are too high");
  }
  auto apart = [](const Vec3& a, const Vec3& b) { return !((a - b).norm() <= 1e-6); };
  if (apart(c.south.poles.front(), c.west.poles.front()) ||
      apart(c.south.poles.back(), c.east.poles.front()) ||
      apart(c.north.poles.front(), c.west.poles.back()) ||
      apart(c.north.poles.back(), c.east.poles.back())) {
    return tl::unexpected(Error{ErrorCode::kDoNotMeet, "the patch's corners lie apart"});
  }
  return {};
}

double Clamped(double t) { return t > 0 ? std::min(t, 1.0) : 0.0; }

// The bilinear blend of the four edges' jets; derivatives by the natural parameters.
SurfaceJet Blend(const CoonsPatch& c, double u, double v) {
  const CurveJet south = JetOf(c.south, u), north = JetOf(c.north, u);
  const CurveJet west = JetOf(c.west, v), east = JetOf(c.east, v);
  const Vec3 &p00 = c.south.poles.front(), &p10 = c.south.poles.back();
  const Vec3 &p01 = c.north.poles.front(), &p11 = c.north.poles.back();
  const Vec3 low = (1 - u) * p00 + u * p10, high = (1 - u) * p01 + u * p11;
  SurfaceJet jet;
  jet.point = (1 - v) * south.point + v * north.point + (1 - u) * west.point + u * east.point -
              (1 - v) * low - v * high;
  jet.du = (1 - v) * south.d1 + v * north.d1 + east.point - west.point - (1 - v) * (p10 - p00) -
           v * (p11 - p01);
  jet.dv = north.point - south.point + (1 - u) * west.d1 + u * east.d1 - (high - low);
  jet.duu = (1 - v) * south.d2 + v * north.d2;
  jet.dvv = (1 - u) * west.d2 + u * east.d2;
  jet.duv = north.d1 - south.d1 + east.d1 - west.d1 - (p11 - p01 - p10 + p00);
  return jet;
}

SurfaceJet JetAt(const Surface& surface, double u, double v) {
  if (const auto* c = std::get_if<CoonsPatch>(&surface)) return Blend(*c, Clamped(u), Clamped(v));
  const Located at = PatchAt(std::get<BsplineSurface>(surface), Clamped(u), Clamped(v));
  return JetOf(at.patch, at.s, at.t);
}

}  // namespace

tl::expected<void, Error> Check(const Surface& surface) {
  return std::visit([](const auto& s) { return CheckOne(s); }, surface);
}

Vec3 PointAt(const Surface& surface, double u, double v) {
  return Check(surface) ? JetAt(surface, u, v).point : Vec3::Zero();
}

Vec3 NormalAt(const Surface& surface, double u, double v) {
  if (!Check(surface)) return Vec3::Zero();
  const SurfaceJet jet = JetAt(surface, u, v);
  const Vec3 normal = jet.du.cross(jet.dv);
  const double length = normal.norm();
  const bool singular = !(length > 1e-12 * (jet.du.squaredNorm() + jet.dv.squaredNorm()));
  return singular || !std::isfinite(length) ? Vec3::Zero() : Vec3(normal / length);
}

Surface Transformed(const Surface& surface, const Affine& m) {
  Surface image = surface;
  auto move = [&](std::vector<Vec3>& poles) {
    for (Vec3& p : poles) p = m * p;
  };
  std::visit(Overloaded{[&](BsplineSurface& s) { move(s.poles); },
                        [&](CoonsPatch& c) {
                          for (BsplineCurve* edge : {&c.south, &c.north, &c.west, &c.east}) {
                            move(edge->poles);
                          }
                        }},
             image);
  return image;
}

bool HasExactBspline(const Surface& surface) {
  return std::holds_alternative<BsplineSurface>(surface);
}

}  // namespace tranos::geom
