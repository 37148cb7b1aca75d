// SPDX-License-Identifier: GPL-3.0-or-later
// The distance between two elements: in closed form between lines, else by the nearest points of
// one from samples of the other, refined along it.
#include <algorithm>
#include <cmath>

#include "interp/value_support.h"

namespace tranos::interp {

namespace {

using geom::Vec3;

constexpr int kSamples = 64;         // of a curve
constexpr int kSurfaceSamples = 12;  // of a surface, each way
constexpr int kCandidates = 4;       // samples that are refined

double ToPoint(const geom::Line& line, const Vec3& p) {
  const Vec3 along = line.end - line.start;
  const double square = along.squaredNorm();
  const double t = square > 0 ? std::clamp(along.dot(p - line.start) / square, 0.0, 1.0) : 0;
  return (line.start + t * along - p).norm();
}

// The nearest points are inside both, or one is an end.
double BetweenLines(const geom::Line& a, const geom::Line& b) {
  double best =
      std::min({ToPoint(a, b.start), ToPoint(a, b.end), ToPoint(b, a.start), ToPoint(b, a.end)});
  const Vec3 u = a.end - a.start, v = b.end - b.start, w = b.start - a.start;
  const Vec3 normal = u.cross(v);
  const double square = normal.squaredNorm();
  if (!(square > 1e-24 * u.squaredNorm() * v.squaredNorm())) return best;
  const double s = w.cross(v).dot(normal) / square, t = w.cross(u).dot(normal) / square;
  if (s < 0 || s > 1 || t < 0 || t > 1) return best;
  return std::min(best, std::abs(w.dot(normal)) / std::sqrt(square));
}

// The least of f over [a, b], where it has one valley.
template <class F>
double LeastOver(double a, double b, const F& f) {
  constexpr double kGolden = 0.6180339887498949;
  double c = b - kGolden * (b - a), d = a + kGolden * (b - a);
  double at_c = f(c), at_d = f(d);
  for (int i = 0; i < 60; ++i) {
    if (at_c < at_d) {
      b = d, d = c, at_d = at_c;
      c = b - kGolden * (b - a), at_c = f(c);
    } else {
      a = c, c = d, at_c = at_d;
      d = a + kGolden * (b - a), at_d = f(d);
    }
  }
  return std::min(at_c, at_d);
}

// The parameters of the samples from which the distance is least.
template <class F>
double LeastAlong(const F& distance_at) {
  std::vector<std::pair<double, int>> samples;
  for (int i = 0; i <= kSamples; ++i) samples.emplace_back(distance_at(i / double{kSamples}), i);
  double best = samples[0].first;
  std::sort(samples.begin(), samples.end());
  for (int k = 0; k < kCandidates; ++k) {
    const auto [distance, i] = samples[static_cast<std::size_t>(k)];
    const double from = std::max(0, i - 1) / double{kSamples};
    const double to = std::min(kSamples, i + 1) / double{kSamples};
    best = std::min({best, distance, LeastOver(from, to, distance_at)});
  }
  return best;
}

double FromCurve(const geom::Curve& curve, const model::Element& other) {
  return LeastAlong(
      [&](double t) { return model::NearestPoint(other, geom::PointAt(curve, t)).distance_m; });
}

// Projecting to and fro never moves the points apart.
template <class Shape>
double Alternate(const Shape& surface, const model::Element& other, Vec3 p) {
  double distance = model::NearestPoint(other, p).distance_m;
  for (int i = 0; i < 200; ++i) {
    p = geom::NearestPoint(surface, model::NearestPoint(other, p).point).point;
    const double next = model::NearestPoint(other, p).distance_m;
    if (!(next < distance * (1 - 1e-13))) break;
    distance = next;
  }
  return distance;
}

template <class Shape>
double LeastFrom(const Shape& surface, std::vector<std::pair<double, Vec3>> samples,
                 const model::Element& other) {
  std::sort(samples.begin(), samples.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  double best = samples[0].first;
  const std::size_t candidates = std::min<std::size_t>(kCandidates, samples.size());
  for (std::size_t k = 0; k < candidates; ++k) {
    best = std::min(best, Alternate(surface, other, samples[k].second));
  }
  return best;
}

double FromSolid(const geom::TriangleMesh& facets, const model::Element& other) {
  std::vector<std::pair<double, Vec3>> samples;
  for (const Vec3& p : facets.positions) {
    samples.emplace_back(model::NearestPoint(other, p).distance_m, p);
  }
  return LeastFrom(facets, std::move(samples), other);
}

double FromSurface(const geom::Surface& surface, const model::Element& other) {
  std::vector<std::pair<double, Vec3>> samples;
  for (int i = 0; i <= kSurfaceSamples; ++i) {
    for (int j = 0; j <= kSurfaceSamples; ++j) {
      const Vec3 p =
          geom::PointAt(surface, i / double{kSurfaceSamples}, j / double{kSurfaceSamples});
      samples.emplace_back(model::NearestPoint(other, p).distance_m, p);
    }
  }
  return LeastFrom(surface, std::move(samples), other);
}

// Of two plane faces one's border is nearest to the other, or passes through it.
double FromBorder(const geom::Region& region, const model::Element& other) {
  double best = std::numeric_limits<double>::infinity();
  geom::ForEachOutline(region, [&](const geom::Curve& outline, bool) {
    best = std::min(best, FromCurve(outline, other));
  });
  return best;
}

std::uint64_t CountLeaves(const model::Element& element, bool* has_face) {
  std::uint64_t leaves = 0;
  model::ForEachLeaf(
      element, [&](const model::Element& leaf, const geom::Affine&, const model::Attributes&) {
        ++leaves;
        if (SurfaceOf(leaf) || RegionOf(leaf) || SolidOf(leaf)) *has_face = true;
      });
  return leaves;
}

double FromEachLeaf(const model::Element& a, const model::Element& b) {
  double best = std::numeric_limits<double>::infinity();
  model::ForEachLeaf(a, [&](const model::Element& leaf, const geom::Affine& world_from_leaf,
                            const model::Attributes&) {
    const model::ElementPtr placed = model::Transformed(leaf, world_from_leaf);
    double distance = best;
    if (const auto* point = std::get_if<model::Point>(&placed->geometry)) {
      distance = model::NearestPoint(b, point->position).distance_m;
    } else if (const geom::Curve* curve = CurveOf(*placed)) {
      distance = FromCurve(*curve, b);
    } else if (const geom::Surface* surface = SurfaceOf(*placed)) {
      distance = FromSurface(*surface, b);
    } else if (const geom::Solid* solid = SolidOf(*placed)) {
      distance = FromSolid(**solid->Facets(), b);
    } else if (const geom::Region* region = RegionOf(*placed)) {
      distance = FromBorder(*region, b);
    } else if (const auto* text = std::get_if<model::TextPtr>(&placed->geometry)) {
      for (std::vector<Vec3>& stroke : geom::Strokes(**text)) {
        if (stroke.size() < 2) continue;
        distance = std::min(distance, FromCurve(geom::Polyline{std::move(stroke), false}, b));
      }
    }
    best = std::min(best, distance);
  });
  return best;
}

const geom::Frame* PlaneOf(const model::Element& element) {
  const auto* facade = std::get_if<model::FacadePtr>(&element.geometry);
  return facade ? &(*facade)->plane : nullptr;
}

// Planes that are not parallel meet.
double BetweenPlanes(const geom::Frame& a, const geom::Frame& b) {
  if (a.z().cross(b.z()).norm() > 1e-12) return 0;
  return std::abs(a.z().dot(b.origin - a.origin));
}

}  // namespace

double DistanceBetween(const CallContext& context, const model::Element& a,
                       const model::Element& b) {
  const geom::Curve* p = CurveOf(a);
  const geom::Curve* q = CurveOf(b);
  const auto* line = p ? std::get_if<geom::Line>(p) : nullptr;
  const auto* other = q ? std::get_if<geom::Line>(q) : nullptr;
  if (line && other) return BetweenLines(*line, *other);
  const geom::Frame *plane = PlaneOf(a), *other_plane = PlaneOf(b);
  if (plane && other_plane) return BetweenPlanes(*plane, *other_plane);
  if (plane) return DistanceBetween(context, b, a);
  bool face_a = false, face_b = false;
  const std::uint64_t leaves_a = CountLeaves(a, &face_a), leaves_b = CountLeaves(b, &face_b);
  if (leaves_a == 0 || leaves_b == 0) {
    throw OpFailure{Code::kWrongElement, "an empty element is at no distance", "", "",
                    leaves_a == 0 ? 0 : 1};
  }
  context.charge_items(leaves_a * leaves_b * 300);
  // Sampling along curves converges faster than across surfaces.
  double distance = face_a && !face_b ? FromEachLeaf(b, a) : FromEachLeaf(a, b);
  if (face_a && face_b) distance = std::min(distance, FromEachLeaf(b, a));
  if (!std::isfinite(distance))
    throw OpFailure{Code::kNotFinite, "the distance is not a finite number"};
  return distance;
}

}  // namespace tranos::interp
